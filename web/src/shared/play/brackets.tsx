// What is known so far: between which bounds each cost lies, on one scale per feature, in units of the reference.
import type { JSX } from 'preact';
import type { Counted } from '../board/types';
import { capitalised, isEnglish, sentence, t } from '../texts';
import { labelOf } from './ledger';

type Ratio = [number, number];

export interface Bracket {
  feature: number;
  reference: number;
  low: Ratio | null; // of the weight, in units of what the reference weighs: costs are negative
  high: Ratio | null;
  ends: [string, string]; // of the cost or gain, rounded outwards; empty: none
  text: string; // in English
}

const valueOf = (ratio: Ratio | null): number | null => (ratio ? ratio[0] / ratio[1] : null);

// Whether it is known that something costs, or that it is worth something: else there is nothing to say.
const isSigned = ({ low, high }: Bracket): boolean => (valueOf(high) ?? 1) <= 0 || (valueOf(low) ?? -1) >= 0;

// `counted` names the unit, and features where the sentence, which is English, cannot be said.
export function Brackets({ brackets, counted = [], title = t('brackets.title') }: { brackets: Bracket[]; counted: Counted[] | undefined; title?: string }): JSX.Element | null {
  const all = brackets.filter(isSigned);
  if (all.length === 0) return null;
  return (
    <div class="brackets">
      <p class="brackets-title">{title}</p>
      {all.map((bracket) => (
        <Scale bracket={bracket} counted={counted} most={Math.max(...all.filter(({ reference }) => reference === bracket.reference).map(mostOf))} />
      ))}
    </div>
  );
}

const kWidth = 320;
const kSide = 14;
const kRight = 56; // with room for the unit

// "Crossing rubble, measured in steps: 2 to 4"
function inNumbers({ feature, reference, ends: [from, to] }: Bracket, counted: Counted[]): string {
  const [what, unit] = [counted[feature], counted[reference]];
  if (!what || !unit) return '';
  const ends = from && to ? 'between' : from ? 'above' : 'below';
  return capitalised(t(`brackets.${ends}`, { what: labelOf(what), unit: labelOf(unit), from, to }));
}

// How far a scale goes that shows a bracket.
const mostOf = ({ ends: [least, largest] }: Bracket): number => Math.max(2, Math.ceil(Number(largest || least) * 1.5));

// Costs and gains alike grow to the right. What is in the same unit stands on one scale, which goes to `most`.
function Scale({ bracket, counted, most }: { bracket: Bracket; counted: Counted[]; most: number }): JSX.Element {
  const [least, largest] = bracket.ends; // as the sentence has them
  const [from, to] = [Number(least), largest === '' ? null : Number(largest)];
  const place = (x: number): number => kSide + (x / most) * (kWidth - kSide - kRight);
  const [left, right] = [place(from), to === null ? kWidth - kRight : place(to)];
  const step = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000].find((one) => most / one <= 8) ?? 2000;
  const ticks: number[] = [];
  for (let x = 0; x <= most; x += step) ticks.push(x);
  return (
    <div class="bracket">
      <p>{isEnglish() ? sentence(bracket.text) : inNumbers(bracket, counted)}</p>
      {(from > 0 || to !== null) && ( // a scale tells nothing where only the sign is known
        <svg viewBox={`0 0 ${kWidth} 40`} aria-hidden="true" focusable="false">
          <path class="axis" d={`M${kSide} 13H${kWidth - kRight}`} />
          <rect class="known" x={left} y={7} width={Math.max(4, right - left)} height={12} rx={6} />
          {from > 0 && <path class="end" d={`M${left} 3V23`} />}
          {to !== null && <path class="end" d={`M${right} 3V23`} />}
          {to === null && <path class="on" d={`M${right - 3} 7l6 6-6 6`} />}
          {ticks.map((x, i) => (
            <text x={place(x) - (i + 1 < ticks.length ? 0 : 4)} y={36} text-anchor={i + 1 < ticks.length ? 'middle' : 'start'} font-size={12}>
              {x} {i + 1 < ticks.length ? '' : (counted[bracket.reference]?.many ?? '')}
            </text>
          ))}
        </svg>
      )}
    </div>
  );
}
