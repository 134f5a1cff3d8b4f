// A board as large as the window allows, which says where somebody clicks.
import type { JSX } from 'preact';
import { useMemo, useState } from 'preact/hooks';
import { BoardView, IntentGlyph, Tried, type Intent } from '../board/board';
import type { Chip } from '../board/chips';
import type { Arm } from '../board/fan';
import { hasSlipped, kUnit } from '../board/geometry';
import { PartGlyph } from '../board/glyphs';
import { Legend } from '../board/legend';
import type { WindowTexts } from '../board/window';
import type { Frame, MapDomain, Part, PathKind, Place, PlayBoard } from '../board/types';
import { capitalised, isEnglish, named, t } from '../texts';
import { boardText, cellTexts } from './words';

// Views are new objects each time, and a legend is the same for a whole session.
export function useLegend(domain: MapDomain): Legend {
  const text = JSON.stringify(domain);
  return useMemo(() => new Legend(JSON.parse(text) as MapDomain), [text]);
}

const kLargestCell = 150; // pixels
const kFewCells = 200;

const windowTexts = (): WindowTexts => ({
  part: (
    <>
      {t('board.part')} <span class="for-keys">{t('board.part_keys')}</span>
    </>
  ),
  label: t('board.part_label'),
  whole: t('board.whole'),
  enlarge: t('board.enlarge'),
});

interface Props {
  board: PlayBoard;
  legend: Legend;
  frames: Frame[]; // the path
  step: number;
  trail: PathKind;
  walked?: number;
  closedAt?: number | undefined;
  other?: Frame[];
  otherKind?: PathKind;
  otherClosedAt?: number | undefined;
  decisive?: { frame: number; cell?: Place } | null;
  whole?: boolean;
  chips?: Chip[];
  fan?: Arm[];
  intents?: Intent[];
  tail?: number; // only so many of the last steps are drawn
  beginsWhole?: boolean;
  isSmall?: boolean; // a picture of the whole board beside others
  isBare?: boolean; // part of something that says what it is
  onCell?: (cell: Place) => void;
}

export function BoardPane({ board, legend, frames, step, trail, onCell, isSmall, isBare, ...rest }: Props): JSX.Element {
  const clicked = (event: MouseEvent): void => {
    if (event.target instanceof Element && event.target.closest('.pan-bar')) return; // what is below the board
    const cell = cellUnder(event);
    if (cell) onCell?.(cell);
  };
  const most = { maxWidth: `${(board.domain.width ?? 1) * kLargestCell}px` };
  return (
    <div class={`live-board ${isSmall ? 'small ' : ''}${onCell ? 'clickable' : ''}`} style={most} onClick={onCell && clicked}>
      <BoardView
        domain={board.domain}
        legend={legend}
        board={{ ...board, frames }}
        step={step}
        label={isBare ? '' : boardText(board, legend, frames[step] ?? board.start)}
        path
        kind={trail}
        fill
        hasArrows
        {...(isSmall ? {} : { texts: windowTexts() })}
        {...rest}
      />
    </div>
  );
}

function cellUnder(event: MouseEvent): Place | null {
  const svg = (event.currentTarget as HTMLElement).querySelector<SVGSVGElement>('.board svg');
  const matrix = svg?.getScreenCTM();
  if (!svg || !matrix) return null;
  const { x, y } = new DOMPoint(event.clientX, event.clientY).matrixTransform(matrix.inverse());
  return [Math.floor(x / kUnit) + 1, Math.floor(y / kUnit) + 1];
}

function legendName({ kind, name }: Part): string {
  if (kind === 'destination') return t('legend.destination', { name: named(name.replace(/^destination of /, '')) });
  return capitalised(named(name));
}

// What the robot has to do; kith's own words are English.
export function Job({ board }: { board: PlayBoard }): JSX.Element | null {
  const { job } = board.domain;
  return job !== undefined && isEnglish() ? <p class="job">{job}</p> : null;
}

// What the world is called, where a picture does not tell all of it.
export function WorldName({ board }: { board: PlayBoard }): JSX.Element | null {
  return board.world_name ? <p>{t('board.world', { name: named(board.world_name) })}</p> : null;
}

interface ThingsProps {
  board: PlayBoard;
  legend: Legend;
  lines: PathKind[];
  walked: Frame[]; // the path as far as it is drawn
  decisive?: boolean; // whether the place where paths separate is marked
  otherLine?: string; // what a line of the other kind is
  hasIntents?: boolean; // whether it is drawn where the robot means to go
}

const kObvious = new Set(['wall', 'item']); // drawn so that nobody has to be told

// What is on this board, and nothing else.
export function Things({ board, legend, lines, walked, decisive, otherLine, hasIntents }: ThingsProps): JSX.Element {
  const symbols = new Set((board.map ?? []).flatMap((row) => [...row]));
  const onMap = new Set<string>();
  for (const { kind, name } of [...symbols].flatMap((symbol) => legend.parts(symbol))) {
    const names = kind === 'terrain' ? legend.layers(name).map((layer) => layer.name) : [name];
    if (kind !== 'station') for (const one of names) onMap.add(`${kind} ${one}`);
  }
  for (const cell of board.start.stations ?? []) onMap.add(`station ${legend.stationAt(board.map ?? [], cell)}`);
  for (const { name } of board.start.items ?? []) onMap.add(`${legend.placed(name).kind} ${name}`);
  const parts = legend.things().filter(({ kind, name }) => !kObvious.has(kind) && onMap.has(`${kind} ${name}`));
  const kind = lines[0] ?? 'own';
  return (
    <ul class="legend" aria-label={t('legend.title')}>
      {parts.map((part) => (
        <Entry name={legendName(part)} isSurface={part.kind === 'terrain'}>
          <PartGlyph part={part} legend={legend} />
        </Entry>
      ))}
      {walked.length > 1 &&
        lines.length > 1 &&
        lines.map((line) => (
          <Entry name={line === 'own' ? t('legend.path') : (otherLine ?? t('legend.trail'))}>
            <g class={`way ${line}`}>
              <path class="line" d="M-20 0H20" />
              <path class="arrow" d="M5 0-4 -4.6V4.6Z" />
            </g>
          </Entry>
        ))}
      {hasIntents && (
        <Entry name={t('legend.intent')}>
          <IntentGlyph action="right" kind="own" />
        </Entry>
      )}
      {decisive && (
        <Entry name={t('legend.decisive')}>
          <rect class="decisive" x={-17} y={-17} width={34} height={34} rx={4} />
        </Entry>
      )}
      {walked.some((frame, i) => hasSlipped(frame, walked[i + 1]?.robot)) && (
        <Entry name={t('legend.tried')}>
          <g class={`way ${kind}`}>
            <Tried from={{ x: -14, y: 0 }} x={14} y={0} angle={0} />
          </g>
        </Entry>
      )}
    </ul>
  );
}

function Entry({ name, isSurface, children }: { name: string; isSurface?: boolean; children: preact.ComponentChildren }): JSX.Element {
  return (
    <li>
      <svg viewBox="-22 -22 44 44" aria-hidden="true" focusable="false">
        {children}
        {isSurface && <rect class="frame" x={-20} y={-20} width={40} height={40} />}
      </svg>
      {name}
    </li>
  );
}

// The board as a table of words: it can be read cell by cell.
export function BoardInWords({ board, legend, frame }: { board: PlayBoard; legend: Legend; frame: Frame }): JSX.Element | null {
  const [open, setOpen] = useState(false);
  const isFew = (board.domain.width ?? 0) * (board.domain.height ?? 0) <= kFewCells; // a large board has thousands
  if (!board.map) return null;
  return (
    <details class="in-words" open={open} onToggle={(event) => setOpen(event.currentTarget.open)}>
      <summary>{t('common.words')}</summary>
      <div class="scroll" tabIndex={0} role="region" aria-label={t('board.rows')}>
        <table>
          <caption class="visually-hidden">{t('board.rows')}</caption>
          <tbody>
            {(open || isFew ? cellTexts(board, legend, frame) : []).map((row) => (
              <tr>
                {row.map((text) => (
                  <td>{text}</td>
                ))}
              </tr>
            ))}
          </tbody>
        </table>
      </div>
    </details>
  );
}
