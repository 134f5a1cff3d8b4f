// Shares over periods: small lines with their names at their ends.
import type { JSX } from 'preact';

const kBox = { left: 26, right: 58, top: 8, bottom: 20 };
const kApart = 11; // px between names

export interface Line {
  name: string; // in full
  label: string; // at its end
  kind: 'own' | 'common' | 'joint' | 'other' | 'mean';
  points: { period: number; share: number }[];
  isMarked?: boolean;
}

interface Props {
  what: string; // "p(BEC) over periods"
  lines: Line[];
  width: number;
  height: number;
  last?: number; // the axis reaches at least so far
}

const order = ({ isMarked, kind }: Line): number => (isMarked ? 2 : kind === 'own' ? 0 : 1);

export function Lines({ what, lines, width, height, last = 1 }: Props): JSX.Element {
  const { left, right, top, bottom } = kBox;
  const drawn = lines.filter(({ points }) => points.length > 0).sort((a, b) => order(a) - order(b));
  const periods = drawn.flatMap(({ points }) => points.map(({ period }) => period));
  const [from, to] = [Math.min(...periods, 1), Math.max(...periods, last)];
  const x = (period: number): number => left + ((period - from) / Math.max(1, to - from)) * (width - left - right);
  const y = (share: number): number => top + (1 - share) * (height - top - bottom);
  const every = Math.ceil((to - from + 1) / 10);
  const ticks = Array.from({ length: to - from + 1 }, (_, i) => from + i).filter((period) => (period - from) % every === 0);
  const ends = drawn.map(({ points, name, label }) => ({ name, label, share: points.at(-1)?.share ?? 0, x: x(points.at(-1)?.period ?? from) }));
  let lowest = -kApart;
  const placed = [...ends].sort((a, b) => b.share - a.share).map((end) => ({ ...end, y: (lowest = Math.max(y(end.share), lowest + kApart)) }));
  return (
    <svg class="lines" viewBox={`0 0 ${width} ${height}`} height={height} role="img" aria-label={`${what}. Last: ${ends.map(({ name, share }) => `${name} ${share.toFixed(2)}`).join(', ') || 'nothing yet'}.`}>
      {[0, 0.5, 1].map((share) => (
        <g>
          <path class="rule" d={`M${left} ${y(share)}H${width - right}`} />
          <text class="tick" x={left - 5} y={y(share) + 4} text-anchor="end">
            {share}
          </text>
        </g>
      ))}
      {ticks.map((period) => (
        <text class="tick" x={x(period)} y={height - 6} text-anchor="middle">
          {period}
        </text>
      ))}
      {drawn.map(({ name, kind, points, isMarked }) => (
        <g class={`curve ${kind}${isMarked ? ' marked' : ''}`}>
          <path class="line" d={`M${points.map(({ period, share }) => `${x(period).toFixed(1)} ${y(share).toFixed(1)}`).join('L')}`} />
          {points.map(({ period, share }) => (
            <circle cx={x(period)} cy={y(share)} r={2.2} data-tip={`${name}, period ${period}: ${share.toFixed(2)}`} />
          ))}
        </g>
      ))}
      {placed.map((end) => (
        <text class="tick" x={end.x + 6} y={end.y + 4}>
          {end.label}
        </text>
      ))}
    </svg>
  );
}
