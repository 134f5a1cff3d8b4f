// A map with what is on it, the paths, and the robot at one step.
import type { JSX } from 'preact';
import type { Board, Domain, Frame, Place } from './document';
import { centre, kUnit, lineOf } from './geometry';
import { At, PartGlyph, Robot, Station, Thing } from './glyphs';
import type { Legend } from './legend';

export const kFew = 12; // columns of a map whose every row and column is numbered
const kRobotLane = 0.08;
const kOtherLane = 0.2;

export interface BoardProps {
  domain: Domain;
  legend: Legend;
  board: Board;
  step: number;
  label: string;
  path?: boolean; // whether the way is drawn
  other?: Frame[]; // the way that somebody would expect
  decisive?: { frame: number; cell?: Place } | null;
}

export function BoardView(props: BoardProps): JSX.Element {
  const { domain, board, step, label, path, other, decisive } = props;
  const columns = domain.width ?? 0;
  const rows = domain.height ?? 0;
  const isLarge = columns > kFew || rows > kFew;
  const margin = isLarge ? 34 : 20;
  const [width, height] = [margin + columns * kUnit + 2, margin + rows * kUnit + 2];
  const frame = board.frames[step] ?? board.start;
  return (
    <div class={isLarge ? 'board large' : 'board'} style={{ maxWidth: `${isLarge ? width : width * 1.45}px` }}>
      <svg viewBox={`${-margin} ${-margin} ${width} ${height}`} role="img" aria-label={label}>
        <Numbers columns={columns} rows={rows} every={isLarge ? 5 : 1} margin={margin} />
        <Ground {...props} />
        {decisive?.cell && <Decisive cell={decisive.cell} />}
        {other && <Way frames={other} first={decisive?.frame ?? 0} lane={kOtherLane} kind="other" />}
        {path && <Way frames={board.frames} first={0} lane={kRobotLane} kind="own" />}
        <Things {...props} frame={frame} />
        {other && decisive && step > decisive.frame && <Ghost frame={other[Math.min(step, other.length - 1)]} />}
        <Mover frame={frame} legend={props.legend} />
      </svg>
    </div>
  );
}

function Numbers({ columns, rows, every, margin }: { columns: number; rows: number; every: number; margin: number }) {
  const shown = (n: number): number[] =>
    Array.from({ length: n }, (_, i) => i + 1).filter((i) => every === 1 || i === 1 || i % every === 0);
  return (
    <g class="numbers" aria-hidden="true">
      {shown(columns).map((column) => (
        <text x={(column - 0.5) * kUnit} y={-margin * 0.32} text-anchor="middle">
          {column}
        </text>
      ))}
      {shown(rows).map((row) => (
        <text x={-margin * 0.28} y={(row - 0.5) * kUnit} text-anchor="end" dominant-baseline="central">
          {row}
        </text>
      ))}
    </g>
  );
}

// What covers cells: walls and terrain.
function Ground({ domain, legend, board }: BoardProps): JSX.Element {
  const [width, height] = [(domain.width ?? 0) * kUnit, (domain.height ?? 0) * kUnit];
  const lines = [
    ...Array.from({ length: (domain.width ?? 0) - 1 }, (_, i) => `M${(i + 1) * kUnit} 0v${height}`),
    ...Array.from({ length: (domain.height ?? 0) - 1 }, (_, i) => `M0 ${(i + 1) * kUnit}h${width}`),
  ];
  return (
    <g>
      <rect class="floor" width={width} height={height} />
      <Parts board={board} legend={legend} kinds={['terrain']} />
      <path class="grid" d={lines.join('')} />
      <Parts board={board} legend={legend} kinds={['wall']} />
      <rect class="frame" width={width} height={height} />
    </g>
  );
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

// What stands on cells, may vanish, or be carried away. What lies where the robot stands is beside its feet.
function Things({ legend, board, frame }: BoardProps & { frame: Frame }): JSX.Element {
  const isBelow = (cell: Place): boolean => cell[0] === frame.robot?.[0] && cell[1] === frame.robot?.[1];
  return (
    <g>
      <Parts board={board} legend={legend} kinds={['goal', 'destination']} />
      {(frame.stations ?? []).map((cell) => (
        <At at={centre(cell)}>
          <Station letter={legend.letter(legend.stationAt(board.map ?? [], cell))} />
        </At>
      ))}
      {(frame.items ?? [])
        .filter(({ carried }) => !carried)
        .map(({ name, cell }) => (
          <At at={centre(cell)}>
            <g transform={isBelow(cell) ? 'translate(-13 13)' : undefined}>
              <Thing letter={legend.letter(name)} small={isBelow(cell)} />
            </g>
          </At>
        ))}
    </g>
  );
}

function Decisive({ cell }: { cell: Place }): JSX.Element {
  const { x, y } = centre(cell);
  const half = kUnit / 2 - 2;
  return <rect class="decisive" x={x - half} y={y - half} width={2 * half} height={2 * half} rx={4} />;
}

function Way({ frames, first, lane, kind }: { frames: Frame[]; first: number; lane: number; kind: string }) {
  const { points, arrows, stops } = lineOf(frames, first, lane);
  const line = points.map(({ x, y }) => `${x.toFixed(1)},${y.toFixed(1)}`).join(' ');
  return (
    <g class={`way ${kind}`}>
      {points.length > 1 && <polyline class="casing" points={line} />}
      {points.length > 1 && <polyline class="line" points={line} />}
      {arrows.map(({ x, y, angle }) => (
        <path class="arrow" d="M5 0-4 -4.6V4.6Z" transform={`translate(${x.toFixed(1)} ${y.toFixed(1)}) rotate(${angle})`} />
      ))}
      {stops.map(({ x, y }) => (
        <circle class="stop" cx={x} cy={y} r={17} />
      ))}
    </g>
  );
}

const moved = (cell: Place): { transform: string } => {
  const { x, y } = centre(cell);
  return { transform: `translate(${x}px, ${y}px)` };
};

function Mover({ frame, legend }: { frame: Frame; legend: Legend }): JSX.Element | null {
  if (!frame.robot) return null;
  const carried = (frame.items ?? []).filter((item) => item.carried);
  return (
    <g class="mover" style={moved(frame.robot)}>
      <Robot />
      {carried.map(({ name }) => (
        <g transform="translate(11 9)">
          <Thing letter={legend.letter(name)} small />
        </g>
      ))}
    </g>
  );
}

function Ghost({ frame }: { frame: Frame | undefined }): JSX.Element | null {
  if (!frame?.robot) return null;
  return (
    <g class="mover ghost" style={moved(frame.robot)}>
      <Robot />
    </g>
  );
}
