// A map with what is on it, the paths, and the robot at one step.
import type { JSX } from 'preact';
import { useMemo } from 'preact/hooks';
import { Chips, counting, type Chip } from './chips';
import { Fan, type Arm } from './fan';
import { centre, kMargin, kMoves, kUnit, lineOf, type Attempt, type Point } from './geometry';
import { At, Destination, fillOf, PartGlyph, Robot, Station, Thing } from './glyphs';
import { isRidden } from './icons';
import type { Legend } from './legend';
import { OverviewMap } from './overview';
import type { Board, Frame, Item, MapDomain, PathKind, Place } from './types';
import { BoardWindow, type WindowTexts } from './window';

export const kFew = 12; // columns of a map that is drawn in full size
const kRobotLane = 0.08;
const kOtherLane = 0.2;

// Where the robot means to go from a cell.
export interface Intent {
  cell: Place;
  action: string; // a move
  kind?: 'own' | 'other';
}

export interface BoardProps {
  domain: MapDomain;
  legend: Legend;
  board: Board;
  step: number;
  label: string;
  path?: boolean; // whether the path is drawn, as far as it has been walked
  kind?: PathKind; // how it is drawn, 'own' unless said otherwise
  fill?: boolean; // as large as its place allows
  whole?: boolean; // both paths are drawn to their ends, wherever the robots are
  chips?: Chip[];
  fan?: Arm[];
  intents?: Intent[];
  tail?: number; // only so many of the last steps are drawn
  walked?: number; // steps of the longer path that have been walked; the robot's step if absent
  closedAt?: number | undefined; // the step with which the path closes a cycle; it is drawn as far as that
  other?: Frame[]; // the path that it is compared with
  otherKind?: PathKind; // how that is drawn, 'other' unless said otherwise
  otherClosedAt?: number | undefined;
  decisive?: { frame: number; cell?: Place } | null;
  beginsWhole?: boolean; // all of a large map is shown at first
  texts?: WindowTexts; // if present, small cells are enlarged, and a window shows a part of the map
  hasArrows?: boolean; // the arrow keys do something else, and move the window only together with Shift
}

export function BoardView(props: BoardProps): JSX.Element {
  const { domain, board, step, label, path, other, decisive } = props;
  const walked = props.walked ?? step;
  const columns = domain.width ?? 0;
  const rows = domain.height ?? 0;
  const isLarge = columns > kFew || rows > kFew;
  const [width, height] = [2 * kMargin + columns * kUnit, 2 * kMargin + rows * kUnit];
  const frame = board.frames[step] ?? board.start;
  const size = props.fill ? {} : { style: { maxWidth: `${isLarge ? width : width * 1.45}px` } };
  const kind = props.kind ?? 'own';
  const last = Math.max(board.frames.length, other?.length ?? 0) - 1;
  const otherKind = props.otherKind ?? 'other';
  const drawn = props.whole ? last : walked;
  const ownDrawn = props.whole ? board.frames.length - 1 : step;
  const own = path && ownDrawn > 0 ? board.frames.slice(0, Math.min(ownDrawn, props.closedAt ?? ownDrawn) + 1) : [];
  const first = decisive?.frame ?? 0;
  const ground = useMemo(() => <Ground domain={domain} legend={props.legend} board={board} />, [domain, props.legend, board.map, board.fences]);
  const others = other && drawn > first ? other.slice(0, Math.min(drawn, props.otherClosedAt ?? drawn) + 1) : [];
  const thingsAt = ([x, y]: Place): string[] => props.legend.parts(board.map?.[y - 1]?.charAt(x - 1) ?? '').map(({ name }) => name);
  // Of two paths that have been gone, it is the place where they separate that tells why, and what counts behind it.
  const fork = props.whole && walked >= last ? decisive?.cell : undefined;
  const reason = (props.chips ?? []).map((chip) => counting(chip, board.frames, other ?? [], first, thingsAt)).find((cell) => cell !== null);
  const centred = [fork ?? frame.robot, fork && reason].filter((place) => place !== undefined && place !== null);
  const drawing = (
    <svg viewBox={`${-kMargin} ${-kMargin} ${width} ${height}`} {...(label === '' ? { 'aria-hidden': true } : { role: 'img', 'aria-label': label })}>
      {ground}
      <Intents intents={props.intents ?? []} />
      {decisive?.cell && drawn > decisive.frame && <Decisive cell={decisive.cell} />}
      {others.length > 0 && <Way frames={others} first={first} lane={kOtherLane} kind={otherKind} closedAt={props.otherClosedAt} />}
      {own.length > 0 && <Way frames={own} first={props.tail === undefined ? 0 : Math.max(0, own.length - 1 - props.tail)} lane={kRobotLane} kind={kind} closedAt={props.closedAt} />}
      <Things {...props} frame={frame} />
      {other && decisive && walked > decisive.frame && <Ghost frame={other[Math.min(walked, other.length - 1)]} legend={props.legend} kind={otherKind} />}
      <Mover frame={frame} legend={props.legend} />
      {props.fan && <Fan arms={props.fan} />}
      {props.chips && <Chips chips={props.chips} frames={board.frames} other={other ?? []} first={first} thingsAt={thingsAt} width={width} height={height} />}
    </svg>
  );
  const overview = { domain, legend: props.legend, board, frame, own, other: others.slice(first), kind, otherKind };
  return (
    <div class={`board${isLarge ? ' large' : ''}${props.fill ? ' fill' : ''}`} {...size}>
      {isLarge && props.texts ? (
        <BoardWindow
          domain={domain}
          centred={centred}
          beginsWhole={props.beginsWhole ?? false}
          texts={props.texts}
          isHeightLimited={props.fill ?? false}
          hasArrows={props.hasArrows ?? false}
          overview={(seen) => <OverviewMap {...overview} seen={seen} />}
        >
          {drawing}
        </BoardWindow>
      ) : (
        drawing
      )}
    </div>
  );
}

// What covers cells, walls and terrain, and stays the same whatever the robot does.
function Ground({ domain, legend, board }: { domain: MapDomain; legend: Legend; board: Board }): JSX.Element {
  const [width, height] = [(domain.width ?? 0) * kUnit, (domain.height ?? 0) * kUnit];
  const lines = [
    ...Array.from({ length: (domain.width ?? 0) - 1 }, (_, i) => `M${(i + 1) * kUnit} 0v${height}`),
    ...Array.from({ length: (domain.height ?? 0) - 1 }, (_, i) => `M0 ${(i + 1) * kUnit}h${width}`),
  ];
  return (
    <g>
      <rect class="floor" width={width} height={height} />
      <Covered board={board} legend={legend} kind="terrain" />
      <path class="grid" d={lines.join('')} />
      <Covered board={board} legend={legend} kind="wall" />
      <path class="fence" d={(board.fences ?? []).map(fenceLine).join('')} />
      <rect class="frame" width={width} height={height} />
    </g>
  );
}

// One shape for each kind of ground: neighbouring cells of a row are one bar.
function Covered({ board, legend, kind }: { board: Board; legend: Legend; kind: 'terrain' | 'wall' }): JSX.Element {
  const shapes = new Map<string, { d: string; flat: string }>();
  (board.map ?? []).forEach((row, y) => {
    let x = 0;
    while (x < row.length) {
      const symbol = row.charAt(x);
      let end = x + 1;
      while (row.charAt(end) === symbol) end += 1;
      const bar = `M${x * kUnit} ${y * kUnit}h${(end - x) * kUnit}v${kUnit}h${(x - end) * kUnit}z`;
      for (const part of legend.parts(symbol)) {
        if (part.kind !== kind) continue;
        const wall = [{ fill: 'var(--board-wall)', flat: 'var(--board-wall)' }];
        const layers = legend.layers(part.name).map((layer, i) => ({ fill: fillOf(layer, i > 0), flat: `var(--tint-${layer.tint})` }));
        for (const { fill, flat } of kind === 'wall' ? wall : layers) shapes.set(fill, { d: (shapes.get(fill)?.d ?? '') + bar, flat });
      }
      x = end;
    }
  });
  // what is drawn over other ground comes last
  const all = [...shapes].sort(([a], [b]) => Number(a.includes('-over')) - Number(b.includes('-over')));
  return (
    <g class={kind === 'wall' ? 'walls' : 'terrains'}>
      {all.map(([fill, { d, flat }]) => (
        <path d={d} fill={fill} class={fill.includes('-over') ? 'over' : undefined} style={{ '--flat': flat }} />
      ))}
    </g>
  );
}

// The border between two neighbouring cells.
function fenceLine([a, b]: [Place, Place]): string {
  const [x, y] = [Math.min(a[0], b[0]) * kUnit, Math.min(a[1], b[1]) * kUnit];
  return a[0] === b[0] ? `M${x - kUnit} ${y}h${kUnit}` : `M${x} ${y - kUnit}v${kUnit}`;
}

function Parts({ board, legend, kinds }: { board: Board; legend: Legend; kinds: string[] }): JSX.Element {
  const all = (board.map ?? []).flatMap((row, y) =>
    [...row].flatMap((symbol, x) =>
      legend
        .parts(symbol)
        .filter(({ kind }) => kinds.includes(kind))
        .map((part) => (
          <At at={centre([x + 1, y + 1])}>
            <PartGlyph part={part} legend={legend} />
          </At>
        )),
    ),
  );
  return <g>{all}</g>;
}

// What stands on cells, may be used up, or be carried away. A station that is used up stays visible, so that the path
// to it can be understood. An item on the robot's cell is drawn at its feet; where it belongs, the place is filled.
function Things({ legend, board, frame }: BoardProps & { frame: Frame }): JSX.Element {
  const isSame = (a: Place, b: Place | undefined): boolean => a[0] === b?.[0] && a[1] === b[1];
  const isBelow = (cell: Place): boolean => isSame(cell, frame.robot);
  const isUsedUp = (station: Place): boolean => !(frame.stations ?? []).some((cell) => isSame(cell, station));
  const lying = (frame.items ?? []).filter(({ carried }) => !carried);
  const isDestination = ({ name }: Item): boolean => legend.placed(name).kind === 'destination';
  const places = [
    ...destinationsOn(board.map ?? [], legend),
    ...lying.filter(isDestination).map(({ name, cell }) => ({ name: name.replace(/^destination of /, ''), cell })),
  ];
  const isDelivered = (name: string, cell: Place): boolean =>
    lying.some((item) => item.name === name && isSame(item.cell, cell)) &&
    places.some((place) => place.name === name && isSame(place.cell, cell));
  return (
    <g>
      <Parts board={board} legend={legend} kinds={['goal']} />
      {places.map(({ name, cell }) => (
        <At at={centre(cell)}>
          <Destination name={name} letter={legend.letter(name)} isFilled={isDelivered(name, cell)} />
        </At>
      ))}
      {(board.start.stations ?? []).map((cell) => (
        <At at={centre(cell)} class={isUsedUp(cell) ? 'used-up' : ''}>
          <StationAt legend={legend} map={board.map ?? []} cell={cell} />
        </At>
      ))}
      {lying
        .filter((item) => !isDestination(item) && !isDelivered(item.name, item.cell))
        .map(({ name, cell }) => (
          <At at={centre(cell)}>
            <g transform={isBelow(cell) ? 'translate(12.5 12)' : undefined}>
              <Thing name={name} letter={legend.letter(name)} small={isBelow(cell)} />
            </g>
          </At>
        ))}
    </g>
  );
}

function StationAt({ legend, map, cell }: { legend: Legend; map: string[]; cell: Place }): JSX.Element {
  const name = legend.stationAt(map, cell);
  return <Station name={name} letter={legend.letter(name)} />;
}

// Where things belong, as far as the map says so.
function destinationsOn(map: string[], legend: Legend): { name: string; cell: Place }[] {
  return map.flatMap((row, y) =>
    [...row].flatMap((symbol, x) =>
      legend
        .parts(symbol)
        .filter(({ kind }) => kind === 'destination')
        .map(({ name }) => ({ name: name.replace(/^destination of /, ''), cell: [x + 1, y + 1] as Place })),
    ),
  );
}

function Intents({ intents }: { intents: Intent[] }): JSX.Element {
  return (
    <g>
      {intents.map(({ cell, action, kind }) => (
        <At at={kind === 'other' ? edge(cell, action) : centre(cell)}>
          <IntentGlyph action={action} kind={kind ?? 'own'} />
        </At>
      ))}
    </g>
  );
}

// Where a robot that stands on the cell does not cover an arrow.
function edge(cell: Place, action: string): Point {
  const { x, y } = centre(cell);
  const [dx, dy] = kMoves[action] ?? [0, 0];
  return { x: x + (dx * kUnit) / 2, y: y + (dy * kUnit) / 2 };
}

export function IntentGlyph({ action, kind }: { action: string; kind: 'own' | 'other' }): JSX.Element {
  const [dx, dy] = kMoves[action] ?? [0, 0];
  return <path class={`intent ${kind}`} d="M-11 0H10M4 -6L11 0L4 6" transform={`rotate(${(Math.atan2(dy, dx) * 180) / Math.PI})`} />;
}

function Decisive({ cell }: { cell: Place }): JSX.Element {
  const { x, y } = centre(cell);
  const half = kUnit / 2 - 2;
  return <rect class="decisive" x={x - half} y={y - half} width={2 * half} height={2 * half} rx={4} />;
}

interface WayProps {
  frames: Frame[];
  first: number;
  lane: number;
  kind: string;
  closedAt: number | undefined;
}

function Way({ frames, first, lane, kind, closedAt }: WayProps): JSX.Element {
  const closed = closedAt === frames.length - 1 ? frames[closedAt]?.robot : undefined;
  const { points, arrows, attempts, stops } = lineOf(frames, first, lane);
  const line = points.map(({ x, y }) => `${x.toFixed(1)},${y.toFixed(1)}`).join(' ');
  return (
    <g class={`way ${kind}`}>
      {attempts.map((attempt) => (
        <Tried {...attempt} />
      ))}
      {points.length > 1 && <polyline class="casing" points={line} />}
      {points.length > 1 && <polyline class="line" points={line} />}
      {arrows.map(({ x, y, angle }) => (
        <path class="arrow" d="M5 0-4 -4.6V4.6Z" transform={`translate(${x.toFixed(1)} ${y.toFixed(1)}) rotate(${angle})`} />
      ))}
      {stops.map(({ x, y }) => (
        <circle class="stop" cx={x} cy={y} r={17} />
      ))}
      {closed && <Round at={centre(closed)} />}
    </g>
  );
}

// An arrow that bends back to where it begins: from here on again and again.
function Round({ at: { x, y } }: { at: Point }): JSX.Element {
  return (
    <g class="round" transform={`translate(${x + 12} ${y - 12})`}>
      <circle class="ground" r={8} />
      <path class="line" d="M5 0A5 5 0 1 1 2.5 -4.3" />
      <path class="head" d="M2 -8L7 -2.5L-0.5 -1.5Z" />
    </g>
  );
}

// A thin arrow to where the robot tried to go.
export function Tried({ from, x, y, angle }: Attempt): JSX.Element {
  return (
    <g class="tried">
      <path d={`M${from.x} ${from.y}L${x} ${y}`} />
      <path class="head" d="M0 0-6 -4M0 0-6 4" transform={`translate(${x} ${y}) rotate(${angle})`} />
    </g>
  );
}

const moved = (cell: Place): { transform: string } => {
  const { x, y } = centre(cell);
  return { transform: `translate(${x}px, ${y}px)` };
};

function Mover({ frame, legend }: { frame: Frame; legend: Legend }): JSX.Element | null {
  if (!frame.robot) return null;
  return (
    <g class="mover" style={moved(frame.robot)}>
      <Loaded frame={frame} legend={legend} />
    </g>
  );
}

// What it carries is on its head; what it rides, below it.
function Loaded({ frame, legend }: { frame: Frame; legend: Legend }): JSX.Element {
  const carried = (frame.items ?? []).filter((item) => item.carried);
  const onHead = carried.filter(({ name }) => !isRidden(name));
  return (
    <>
      <Robot isLoaded={onHead.length > 0} />
      {onHead.map(({ name }, i) => (
        <g transform={`translate(0 ${-16.5 - 13 * i}) scale(.9)`}>
          <Thing name={name} letter={legend.letter(name)} small />
        </g>
      ))}
      {carried
        .filter(({ name }) => isRidden(name))
        .map(({ name }) => (
          <g transform="translate(0 14)">
            <Thing name={name} letter={legend.letter(name)} small />
          </g>
        ))}
    </>
  );
}

function Ghost({ frame, legend, kind }: { frame: Frame | undefined; legend: Legend; kind: PathKind }): JSX.Element | null {
  if (!frame?.robot) return null;
  return (
    <g class={`mover ghost ${kind}`} style={moved(frame.robot)}>
      <Loaded frame={frame} legend={legend} />
    </g>
  );
}
