// A small drawing of a team: how its members' knowledge rises. What brackets of a team say, in words.
import type { JSX } from 'preact';
import { plural } from '../words';
import type { Bracket } from './lessons';

const kWidth = 250;
const kLeft = 24;

export function amountText({ low, high }: Bracket['ends'][number], unit: string): string {
  if (low === null && high === null) return 'not shown yet';
  if (low === null) return `at most ${plural(high ?? 0, unit)}`;
  if (high === null) return low <= 0 ? 'something' : `more than ${plural(low, unit)}`;
  return `${Math.max(0, low)} to ${plural(high, unit)}`;
}

export function KnowledgeChart({ rows, names, periods }: { rows: (number | null)[][]; names: string[]; periods: number[] }): JSX.Element {
  const height = 120;
  const x = (i: number): number => kLeft + (periods.length < 2 ? 0.5 : i / (periods.length - 1)) * (kWidth - kLeft - 14);
  const y = (share: number): number => 6 + (1 - share / 100) * (height - 26);
  const last = names.map((name, m) => `${name} ${((rows[rows.length - 1]?.[m] ?? 0) / 100).toFixed(2)}`);
  return (
    <figure class="small">
      <svg viewBox={`0 0 ${kWidth} ${height}`} role="img" aria-label={`Knowledge after the last period: ${last.join(', ')}`}>
        {[0, 50, 100].map((share) => (
          <g>
            <path class="grid-line" d={`M${kLeft} ${y(share)}H${kWidth - 8}`} />
            <text class="tick" x={kLeft - 4} y={y(share) + 4} text-anchor="end">
              {share / 100}
            </text>
          </g>
        ))}
        {periods.map((period, i) => (
          <text class="tick" x={x(i)} y={height - 3} text-anchor="middle">
            {periods.length > 12 && i % 2 === 1 ? '' : period}
          </text>
        ))}
        {names.map((_, m) => {
          const points = rows.flatMap((row, i) => (row[m] === null || row[m] === undefined ? [] : [[x(i), y(row[m])] as const]));
          return (
            <g class="member">
              <polyline points={points.map((point) => point.join(',')).join(' ')} stroke-dasharray={m === 0 ? undefined : `${2 + 2 * m} 2`} />
              <text class="tick" x={(points.at(-1)?.[0] ?? 0) + 5} y={(points.at(-1)?.[1] ?? 0) + 4}>
                {names[m]?.match(/\d+/)?.[0]}
              </text>
            </g>
          );
        })}
      </svg>
      <figcaption>
        their own knowledge <span class="muted">at the end: {last.join(', ')}</span>
      </figcaption>
    </figure>
  );
}
