// What decides, counted: "Steps 7, Crossing rubble 1, Stopping at the charger 0". Counts, never what they are worth.
import type { JSX } from 'preact';
import type { Chip } from '../board/chips';
import type { Counted, Frame, MapDomain, PathKind, PlayBoard } from '../board/types';
import { capitalised, hasText, isEnglish, t } from '../texts';

const kMost = 4; // so many are all shown from the beginning

// What has been counted up to a frame.
export function countsOf(frames: Frame[], upTo = frames.length - 1): number[] {
  const sums: number[] = [];
  for (const { counts } of frames.slice(0, upTo)) counts?.forEach((n, k) => (sums[k] = (sums[k] ?? 0) + n));
  return sums;
}

export function labelOf({ name, label }: Counted): string {
  const key = `count.${name}`;
  return hasText(key) ? t(key) : label;
}

export const rounded = (n: number): string => String(Math.round(100 * n) / 100);

export interface Column {
  name: string; // "Robot"
  kind: PathKind;
  counts: number[];
  endless?: boolean[]; // what the path goes on counting for ever
}

// Whether what is counted is called after something that this map has nowhere: "orange tile" after "orange".
function isAbsent({ domain: { legend = [] }, map = [] }: PlayBoard, { one }: Counted): boolean {
  const symbols = legend.filter(({ name, parts = [] }) => [name, ...parts.map((part) => part.name)].some((all) => `${one} `.startsWith(`${all} `))).map(({ symbol }) => symbol);
  return symbols.length > 0 && !map.some((row) => symbols.some((symbol) => row.includes(symbol)));
}

// While somebody moves there is one column, afterwards the robot's beside the prediction.
export function Ledger({ board, columns }: { board: PlayBoard; columns: Column[] }): JSX.Element | null {
  const counted = board.domain.counted ?? [];
  const rows = counted
    .map((one, k) => ({ one, values: columns.map(({ counts, endless }) => (endless?.[k] ? t('ledger.endless') : rounded(counts[k] ?? 0))) }))
    .filter(({ one, values }, k) => (counted.length <= kMost && !isAbsent(board, one)) || k === counted.length - 1 || values.some((n) => n !== '0'));
  if (rows.length === 0) return null;
  return (
    <table class={columns.length > 1 ? 'ledger' : 'ledger single'}>
      <caption class="visually-hidden">{t('ledger.title')}</caption>
      {columns.length > 1 && (
        <thead>
          <tr>
            <td />
            {columns.map(({ name, kind }) => (
              <th scope="col" class={kind}>
                {name}
              </th>
            ))}
          </tr>
        </thead>
      )}
      <tbody>
        {rows.map(({ one, values }) => (
          <tr class={new Set(values).size > 1 ? 'differs' : undefined}>
            <th scope="row">{capitalised(labelOf(one))}</th>
            {values.map((n) => (
              <td class="number">{n}</td>
            ))}
          </tr>
        ))}
      </tbody>
    </table>
  );
}

// What fits on a board: "+3 steps in view of a camera" is "+3 in view of a camera".
const shortened = (text: string): string => (text.length > 18 ? text.replace(/ steps? /, ' ') : text);

// What each of two paths has more of: "+1 rubble" on one, "+2 steps" on the other.
export function chipsOf(domain: MapDomain, robot: number[], other: number[], kind: PathKind): Chip[] {
  return (domain.counted ?? []).flatMap((one, k): Chip[] => {
    const more = (robot[k] ?? 0) - (other[k] ?? 0);
    const n = Math.abs(more);
    if (n < 0.005) return [];
    const text = `+${rounded(n)}`; // English alone has words for it
    return [{ kind: more > 0 ? 'own' : kind, text: isEnglish() ? shortened(`${text} ${n === 1 ? one.one : one.many}`) : text, feature: k, thing: one.one }];
  });
}
