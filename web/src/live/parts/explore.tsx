// A world that can be changed: things and the robot are moved or put by pointer or keys, and the robot plans again.
import type { JSX } from 'preact';
import { useLayoutEffect, useRef, useState } from 'preact/hooks';
import { kUnit } from '../../shared/board/geometry';
import { PartGlyph } from '../../shared/board/glyphs';
import type { Legend } from '../../shared/board/legend';
import { closedAt, played } from '../../shared/board/repeats';
import type { Frame, Path, Place, PlayBoard } from '../../shared/board/types';
import { BoardPane, Things, useLegend } from '../../shared/play/board_pane';
import { Brackets } from '../../shared/play/brackets';
import { countsOf, Ledger } from '../../shared/play/ledger';
import { actionLabel, capitalised, isEnglish, listed, named, sentence, t } from '../../shared/texts';
import { cellTexts, isSame } from '../../shared/play/words';
import type { Explored, ParticipantView } from '../protocol';
import { Button } from './ui';

type Shown = NonNullable<ParticipantView['explore']>;

// Where the robot would go from there, in a world or on a map.
export type Asking = { start: Frame } & ({ world: number } | { map: string[] });

interface ExploringProps {
  explore: Shown;
  onAsk: (asked: Asking | null) => void; // nothing: all is as it was
}

// What is asked: a world, or the map in its place where that was changed.
interface Asked {
  board: PlayBoard;
  isChanged: boolean;
}

const symbolAt = (map: string[], [x, y]: Place): string => map[y - 1]?.charAt(x - 1) ?? '';

function withSymbols(map: string[], changes: [Place, string][]): string[] {
  return map.map((row, y) => [...row].map((symbol, x) => changes.find(([cell]) => isSame(cell, [x + 1, y + 1]))?.[1] ?? symbol).join(''));
}

function stationsOf(map: string[], legend: Legend): Place[] {
  return map.flatMap((row, y) =>
    [...row].flatMap((symbol, x): Place[] => (legend.parts(symbol).some(({ kind }) => kind === 'station') ? [[x + 1, y + 1]] : [])),
  );
}

function changed({ board }: Asked, legend: Legend, map: string[], start: Frame): Asked {
  return { board: { ...board, map, start: { ...start, stations: stationsOf(map, legend) } }, isChanged: true };
}

// The robot if it is there, else what the map has there, goes to another cell; what was there comes back in exchange.
function moved(asked: Asked, legend: Legend, from: Place, to: Place): Asked {
  const { board, isChanged } = asked;
  const { map = [], start } = board;
  if (isSame(start.robot, from)) {
    const items = start.items?.map((item) => (item.carried ? { ...item, cell: to } : item)) ?? [];
    return { board: { ...board, start: { ...start, robot: to, items } }, isChanged };
  }
  const swapped = (cell: Place): Place => (isSame(cell, from) ? to : isSame(cell, to) ? from : cell);
  const items = start.items?.map((item) => (item.carried ? item : { ...item, cell: swapped(item.cell) })) ?? [];
  return changed(asked, legend, withSymbols(map, [[from, symbolAt(map, to)], [to, symbolAt(map, from)]]), { ...start, items });
}

function canPickUp({ board }: Asked, legend: Legend, put: string[], cell: Place): boolean {
  if (isSame(board.start.robot, cell)) return true;
  return put.length > 0 && legend.parts(symbolAt(board.map ?? [], cell)).some(({ kind }) => kind !== 'start');
}

const nameOf = (legend: Legend, symbol: string): string =>
  listed(legend.parts(symbol).map(({ kind, name }) => (kind === 'wall' ? t('legend.wall') : named(name))));

// How many places are not as they were.
function changesOf({ map = [], start }: PlayBoard, now: PlayBoard): number {
  const cells = map.flatMap((row, y) => [...row].filter((symbol, x) => now.map?.[y]?.charAt(x) !== symbol));
  return cells.length + (start.robot && isSame(now.start.robot, start.robot) ? 0 : 1);
}

function Tool({ legend, symbol, isOn, onChoose }: { legend: Legend; symbol: string; isOn: boolean; onChoose: () => void }): JSX.Element {
  const parts = legend.parts(symbol);
  return (
    <label class="tile">
      <input type="radio" name="explore-tool" checked={isOn} onChange={onChoose} />
      <svg viewBox="-22 -22 44 44" aria-hidden="true" focusable="false">
        <rect class="floor" x={-20} y={-20} width={40} height={40} />
        {symbol === '' && <path class="icon-line" d="M-12 0H12M0-12V12M-8-4-12 0-8 4M8-4 12 0 8 4M-4-8 0-12 4-8M-4 8 0 12 4 8" />}
        {parts.map((part) => (
          <PartGlyph part={part} legend={legend} />
        ))}
        <rect class="frame" x={-20} y={-20} width={40} height={40} />
      </svg>
      {symbol === '' ? t('explore.move') : parts.length === 0 ? t('explore.clear') : capitalised(nameOf(legend, symbol))}
    </label>
  );
}

export const exploreTitle = ({ put }: Shown): string => t(put.length > 0 ? 'explore.title' : 'explore.title_robot');

// The task, and the world.
export function Exploring({ explore, onAsk }: ExploringProps): JSX.Element {
  return (
    <>
      <p class="lead">{t(explore.put.length > 0 ? 'explore.lead' : 'explore.lead_robot')}</p>
      <Explore explore={explore} onAsk={onAsk} />
    </>
  );
}

function Explore({ explore, onAsk }: ExploringProps): JSX.Element {
  const { first, last, put } = explore;
  const legend = useLegend(first.board?.domain ?? { id: '' });
  const beginning: Asked | null = first.board ? { board: first.board, isChanged: false } : null;
  const recalled = last?.board ? { board: last.board, isChanged: last.board.world !== first.board?.world || last.board.map?.join() !== first.board.map?.join() } : null;
  const [asked, setAsked] = useState<Asked | null>(recalled);
  const [tool, setTool] = useState('');
  const before = useRef(first);
  if (!beginning) return <></>;
  const current = asked ?? beginning;
  const ask = (next: Asked): void => {
    before.current = asked && last ? last : first;
    setAsked(next);
    const { map, start, world } = next.board;
    onAsk(next.isChanged && map ? { map, start } : { world, start });
  };
  const result = asked ? (last ?? first) : first;
  return (
    <div class="board-screen explore">
      <div class="board-column">
        <Grid asked={current} result={result} legend={legend} put={put} tool={tool} onAsk={ask} />
        <Things board={current.board} legend={legend} lines={result.other ? ['own', 'plain'] : ['own']} walked={result.path?.frames ?? []} decisive={result.other !== null && !result.impossible} otherLine={t('explore.other_line')} />
      </div>
      <div class="side">
        {put.length > 0 && (
          <fieldset class="tools">
            <legend class="visually-hidden">{t('explore.tools')}</legend>
            {['', ...put].map((symbol) => (
              <Tool legend={legend} symbol={symbol} isOn={tool === symbol} onChoose={() => setTool(symbol)} />
            ))}
          </fieldset>
        )}
        <p class="muted hint">{t('explore.keys')}</p>
        <Answer result={result} before={before.current} changes={asked ? changesOf(beginning.board, asked.board) : null} />
        <Button
          off={asked === null}
          onClick={() => {
            setAsked(null);
            onAsk(null);
          }}
        >
          {t('explore.reset')}
        </Button>
        <Brackets brackets={explore.brackets} counted={current.board.domain.counted} />
      </div>
    </div>
  );
}

const pathText = ({ path }: Explored): string => listed((path?.frames ?? []).flatMap(({ action }) => (action ? [actionLabel(action)] : [])));

function Answer({ result, before, changes }: { result: Explored; before: Explored; changes: number | null }): JSX.Element {
  if (result.impossible || !result.board || !result.path) return <p class="reasons" role="status">{t('explore.impossible')}</p>;
  const key = pathText(result) === pathText(before) ? 'explore.same' : 'explore.changed';
  const columns = [{ name: t('ledger.robot'), kind: 'own' as const, counts: countsOf(played(result.path)) }];
  const other = result.other ? [{ name: t('explore.other'), kind: 'plain' as const, counts: countsOf(played(result.other)) }] : [];
  return (
    <>
      <div class="reasons" role="status">
        {changes !== null && <p>{t(key)} {t('explore.changes', { n: changes })} <span class="visually-hidden">{capitalised(pathText(result))}</span></p>}
        {result.tie && <p>{t('explore.tie')}</p>}
        {isEnglish() && result.reason && <p class="cost">{sentence(result.reason)}</p>}
      </div>
      <Ledger board={result.board} columns={[...columns, ...other]} />
    </>
  );
}

interface GridProps {
  asked: Asked;
  result: Explored;
  legend: Legend;
  put: string[];
  tool: string; // a symbol to put; empty: things are moved
  onAsk: (next: Asked) => void;
}

interface Box {
  left: number;
  top: number;
  width: number;
  height: number;
}

// A button over every cell of the board: one of them is reached by Tab, the others by arrow keys.
function Grid({ asked, result, legend, put, tool, onAsk }: GridProps): JSX.Element {
  const { board } = asked;
  const [columns, rows] = [board.domain.width ?? 0, board.domain.height ?? 0];
  const place = useRef<HTMLDivElement>(null);
  const [box, setBox] = useState<Box | null>(null);
  const [at, setAt] = useState<Place>(board.start.robot ?? [1, 1]);
  const [held, setHeld] = useState<{ origin: Asked; from: Place; to: Place; isDragged: boolean } | null>(null);
  useLayoutEffect(() => {
    const measure = (): void => {
      const own = place.current?.getBoundingClientRect();
      const matrix = place.current?.querySelector<SVGSVGElement>('.board svg')?.getScreenCTM();
      if (own && matrix) setBox({ left: matrix.e - own.left, top: matrix.f - own.top, width: matrix.a * kUnit * columns, height: matrix.d * kUnit * rows });
    };
    const observer = new ResizeObserver(measure);
    if (place.current) observer.observe(place.current);
    measure();
    return () => observer.disconnect();
  }, [columns, rows]);

  const use = (cell: Place): void => {
    if (tool !== '') {
      const there = symbolAt(board.map ?? [], cell);
      if (there !== tool && put.includes(there)) onAsk(changed(asked, legend, withSymbols(board.map ?? [], [[cell, tool]]), board.start));
    } else if (held) {
      setHeld(null);
      if (!isSame(held.to, cell)) onAsk(moved(held.origin, legend, held.from, cell));
    } else if (canPickUp(asked, legend, put, cell)) {
      setHeld({ origin: asked, from: cell, to: cell, isDragged: false });
    }
  };
  const cellOf = ({ clientX, clientY }: PointerEvent): Place | null => {
    const button = document.elementFromPoint(clientX, clientY)?.closest<HTMLElement>('[data-cell]');
    const [x, y] = (button?.dataset.cell ?? '').split(',').map(Number);
    return button && place.current?.contains(button) && x && y ? [x, y] : null;
  };
  const pressed = (event: PointerEvent): void => {
    const cell = cellOf(event);
    if (tool === '' && !held && cell && canPickUp(asked, legend, put, cell)) setHeld({ origin: asked, from: cell, to: cell, isDragged: true });
  };
  const dragged = (event: PointerEvent): void => {
    if (!held?.isDragged) return;
    const cell = cellOf(event);
    if (!cell || isSame(held.to, cell)) return;
    setHeld({ ...held, to: cell });
    onAsk(moved(held.origin, legend, held.from, cell));
  };
  // A press without a drag picks up: the next one puts down.
  const released = (): void => {
    if (held?.isDragged) setHeld(isSame(held.from, held.to) ? { ...held, isDragged: false } : null);
  };
  const wasHeld = useRef(false);
  const keyed = (event: KeyboardEvent): void => {
    const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
    if (event.key === 'Escape') setHeld(null);
    if (!step) return;
    event.preventDefault();
    event.stopPropagation(); // the arrow keys play demonstrations elsewhere on the page
    const next: Place = [Math.min(columns, Math.max(1, at[0] + (step[0] ?? 0))), Math.min(rows, Math.max(1, at[1] + (step[1] ?? 0)))];
    setAt(next);
    place.current?.querySelector<HTMLElement>(`[data-cell="${next.join()}"]`)?.focus();
  };
  const { path, other } = result;
  const isDrawn = path && !result.impossible && isSame(path.frames[0]?.robot, board.start.robot ?? [0, 0]);
  const texts = cellTexts(board, legend, board.start);
  return (
    <div class="explore-board" ref={place}>
      <BoardPane
        board={board}
        legend={legend}
        frames={isDrawn ? played(path) : [board.start]}
        step={0}
        walked={0}
        trail="own"
        whole
        isSmall
        isBare
        {...(isDrawn ? { closedAt: closedAt(path) } : {})}
        {...(isDrawn && other ? { other: played(other), otherKind: 'plain', decisive: decisiveAt(path, result.differs_at ?? 0) } : {})}
      />
      {box && (
        <div
          class="explore-cells"
          role="grid"
          aria-label={t('explore.board')}
          style={{ ...pixels(box), gridTemplateColumns: `repeat(${columns}, 1fr)` }}
          onKeyDown={keyed}
          onPointerDown={(event) => {
            wasHeld.current = held !== null;
            (event.target as HTMLElement).releasePointerCapture?.(event.pointerId); // of touch, so that moves are of the cell below
            pressed(event);
          }}
          onPointerMove={dragged}
          onPointerUp={released}
        >
          {texts.map((row, y) => (
            <div role="row">
              {row.map((text, x) => {
                const cell: Place = [x + 1, y + 1];
                const isHeld = held !== null && isSame(held.from, cell);
                return (
                  <div role="gridcell">
                    <button
                      type="button"
                      data-cell={cell.join()}
                      class={isHeld ? 'held' : undefined}
                      aria-pressed={isHeld}
                      tabIndex={isSame(at, cell) ? 0 : -1}
                      onFocus={() => setAt(cell)}
                      onClick={(event) => {
                        // a pointer has picked up already when it was pressed
                        if (event.detail === 0 || tool !== '' || wasHeld.current) use(cell);
                      }}
                    >
                      <span class="visually-hidden">{text}</span>
                    </button>
                  </div>
                );
              })}
            </div>
          ))}
        </div>
      )}
    </div>
  );
}

function decisiveAt({ frames }: Path, frame: number): { frame: number; cell?: Place } {
  const cell = frames[frame]?.robot;
  return { frame, ...(cell ? { cell } : {}) };
}

const pixels = ({ left, top, width, height }: Box): Record<string, string> => ({
  left: `${left}px`,
  top: `${top}px`,
  width: `${width}px`,
  height: `${height}px`,
});
