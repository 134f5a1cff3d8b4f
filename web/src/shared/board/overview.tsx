// All of a map in small: what covers its cells, where things and robots are, and the part that a window shows.
import type { JSX } from 'preact';
import { useMemo } from 'preact/hooks';
import { centre, kMargin, kUnit } from './geometry';
import type { Legend } from './legend';
import type { Board, Frame, MapDomain, PathKind, Place } from './types';
import type { Seen } from './window';

interface Props {
  domain: MapDomain;
  legend: Legend;
  board: Board;
  frame: Frame;
  own: Frame[]; // paths as far as they are drawn
  other: Frame[];
  kind: PathKind; // how the first is drawn
  otherKind?: PathKind;
  seen?: Seen; // nothing: all of it is seen
  label?: string; // for those who do not see it
}

export function OverviewMap({ domain, legend, board, frame, own, other, kind, otherKind = 'other', seen, label }: Props): JSX.Element {
  const [width, height] = [(domain.width ?? 0) * kUnit, (domain.height ?? 0) * kUnit];
  const ground = useMemo(() => <Ground map={board.map ?? []} legend={legend} />, [board.map, legend]);
  const lying = (frame.items ?? []).filter(({ carried }) => !carried).map(({ cell }) => cell);
  return (
    <svg viewBox={`${-kMargin} ${-kMargin} ${width + 2 * kMargin} ${height + 2 * kMargin}`} focusable="false" {...(label ? { role: 'img', 'aria-label': label } : {})}>
      <rect class="floor" width={width} height={height} />
      {ground}
      <rect class="frame" width={width} height={height} />
      {other.length > 1 && <polyline class={`trace ${otherKind}`} points={trace(other)} />}
      {own.length > 1 && <polyline class={`trace ${kind}`} points={trace(own)} />}
      {[...cellsOf(board.map ?? [], legend, ['goal', 'destination']), ...(frame.stations ?? []), ...lying].map((cell) => (
        <Dot name="spot" cell={cell} />
      ))}
      {frame.robot && <Dot name="here" cell={frame.robot} />}
      {seen && <rect class="seen" x={seen.x} y={seen.y} width={seen.width} height={seen.height} />}
    </svg>
  );
}

function Dot({ name, cell }: { name: string; cell: Place }): JSX.Element {
  const { x, y } = centre(cell);
  return <circle class={name} cx={x} cy={y} r={1.1 * kUnit} />;
}

const trace = (frames: Frame[]): string =>
  frames.flatMap(({ robot }) => (robot ? [centre(robot)] : [])).map(({ x, y }) => `${x},${y}`).join(' ');

function cellsOf(map: string[], legend: Legend, kinds: string[]): Place[] {
  return map.flatMap((row, y) =>
    [...row].flatMap((symbol, x): Place[] => (legend.parts(symbol).some(({ kind }) => kinds.includes(kind)) ? [[x + 1, y + 1]] : [])),
  );
}

// One shape for each kind of ground: neighbouring cells of a row are one bar.
function Ground({ map, legend }: { map: string[]; legend: Legend }): JSX.Element {
  const shapes = new Map<string, string>();
  map.forEach((row, y) => {
    let x = 0;
    while (x < row.length) {
      const symbol = row.charAt(x);
      let end = x + 1;
      while (row.charAt(end) === symbol) end += 1;
      for (const { kind, name } of legend.parts(symbol)) {
        const surface = kind === 'terrain' ? legend.layers(name)[0] : undefined;
        const fill = kind === 'wall' ? 'var(--board-wall)' : surface && `var(--tint-${surface.tint})`;
        const bar = `M${x * kUnit} ${y * kUnit}h${(end - x) * kUnit}v${kUnit}h${(x - end) * kUnit}z`;
        if (fill) shapes.set(fill, (shapes.get(fill) ?? '') + bar);
      }
      x = end;
    }
  });
  return (
    <g>
      {[...shapes].map(([fill, d]) => (
        <path d={d} fill={fill} />
      ))}
    </g>
  );
}
