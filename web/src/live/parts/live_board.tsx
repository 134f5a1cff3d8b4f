// A board as large as the window allows, which says where somebody clicks.
import type { JSX } from 'preact';
import { useMemo } from 'preact/hooks';
import { BoardView, Tried } from '../../shared/board/board';
import { hasSlipped, kUnit } from '../../shared/board/geometry';
import { PartGlyph, Patterns, Robot } from '../../shared/board/glyphs';
import { Legend } from '../../shared/board/legend';
import type { Frame, MapDomain, Part, Place } from '../../shared/board/types';
import type { LiveBoard } from '../protocol';
import { capitalised, named, t } from '../texts';
import { boardText, cellTexts } from '../words';

// Views are new objects each time, and a legend is the same for a whole session.
export function useLegend(domain: MapDomain): Legend {
  const text = JSON.stringify(domain);
  return useMemo(() => new Legend(JSON.parse(text) as MapDomain), [text]);
}

const kLargestCell = 150; // pixels

interface Props {
  board: LiveBoard;
  legend: Legend;
  frames: Frame[]; // the path
  step: number;
  trail: 'own' | 'other'; // the robot's path or a prediction
  walked?: number;
  closedAt?: number | undefined;
  other?: Frame[];
  otherClosedAt?: number | undefined;
  decisive?: { frame: number; cell?: Place } | null;
  onCell?: (cell: Place) => void;
}

export function LiveBoardView({ board, legend, frames, step, trail, onCell, ...rest }: Props): JSX.Element {
  const clicked = (event: MouseEvent): void => {
    if (event.target instanceof Element && event.target.closest('.pan-bar')) return; // what is below the board
    const cell = cellUnder(event);
    if (cell) onCell?.(cell);
  };
  const most = { maxWidth: `${(board.domain.width ?? 1) * kLargestCell}px` };
  return (
    <div class={`live-board ${onCell ? 'clickable' : ''}`} style={most} onClick={onCell && clicked}>
      <Patterns surfaces={legend.surfaces} />
      <BoardView
        domain={board.domain}
        legend={legend}
        board={{ ...board, frames }}
        step={step}
        label={boardText(board, legend, frames[step] ?? board.start)}
        path
        kind={trail}
        fill
        hasArrows
        texts={{
          part: (
            <>
              {t('board.part')} <span class="for-keys">{t('board.part_keys')}</span>
            </>
          ),
          label: t('board.part_label'),
          whole: t('board.whole'),
          enlarge: t('board.enlarge'),
        }}
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
  if (kind === 'wall') return t('legend.wall');
  if (kind === 'destination') return t('legend.destination', { name: named(name.replace(/^destination of /, '')) });
  return capitalised(named(name));
}

// What the world is called, where a picture does not tell all of it.
export function WorldName({ board }: { board: LiveBoard }): JSX.Element | null {
  return board.world_name ? <p>{t('board.world', { name: named(board.world_name) })}</p> : null;
}

interface ThingsProps {
  board: LiveBoard;
  legend: Legend;
  lines: ('own' | 'other')[];
  walked: Frame[]; // the path as far as it is drawn
}

// What is on this board, and nothing else.
export function Things({ board, legend, lines, walked }: ThingsProps): JSX.Element {
  const symbols = new Set((board.map ?? []).flatMap((row) => [...row]));
  const onMap = new Set([...symbols].flatMap((symbol) => legend.parts(symbol)).map(({ kind, name }) => `${kind} ${name}`));
  for (const { name } of board.start.items ?? []) onMap.add(`${legend.placed(name).kind} ${name}`);
  const parts = legend.things().filter(({ kind, name }) => onMap.has(`${kind} ${name}`));
  return (
    <ul class="legend" aria-label={t('legend.title')}>
      <Entry name={t('legend.robot')}>
        <Robot />
      </Entry>
      {parts.map((part) => (
        <Entry name={legendName(part)} isSurface={part.kind === 'terrain' || part.kind === 'wall'}>
          <PartGlyph part={part} legend={legend} />
        </Entry>
      ))}
      {lines.map((kind) => (
        <Entry name={t(kind === 'own' ? 'legend.path' : 'legend.trail')}>
          <g class={`way ${kind}`}>
            <path class="line" d="M-20 0H20" />
            <path class="arrow" d="M5 0-4 -4.6V4.6Z" />
          </g>
        </Entry>
      ))}
      {walked.some((frame, i) => hasSlipped(frame, walked[i + 1]?.robot)) && (
        <Entry name={t('legend.tried')}>
          <g class={`way ${lines[0] ?? 'own'}`}>
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
export function BoardInWords({ board, legend, frame }: { board: LiveBoard; legend: Legend; frame: Frame }): JSX.Element | null {
  if (!board.map) return null;
  return (
    <details class="in-words">
      <summary>{t('common.words')}</summary>
      <div class="scroll" tabIndex={0} role="region" aria-label={t('board.rows')}>
        <table>
          <caption class="visually-hidden">{t('board.rows')}</caption>
          <tbody>
            {cellTexts(board, legend, frame).map((row) => (
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
