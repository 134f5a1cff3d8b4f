// Two small drawings of a team: how its brackets close, and how its members' knowledge rises.
import type { JSX } from 'preact';
import { plural } from '../words';
import type { Bracket } from './lessons';

const kWidth = 250;
const kRow = 15;
const kLeft = 24;

export function amountText({ low, high }: Bracket['ends'][number], unit: string): string {
  if (low === null && high === null) return 'not shown yet';
  if (low === null) return `at most ${plural(high ?? 0, unit)}`;
  if (high === null) return low <= 0 ? 'something' : `more than ${plural(low, unit)}`;
  return `${Math.max(0, low)} to ${plural(high, unit)}`;
}

export function BracketChart({ bracket, periods }: { bracket: Bracket; periods: number[] }): JSX.Element {
  const { feature, unit, isCost, ends } = bracket;
  const known = ends.flatMap(({ low, high }) => [low ?? 0, high ?? 0]);
  const most = Math.max(1, ...known) * 1.25;
  const at = (value: number): number => kLeft + (Math.min(Math.max(value, 0), most) / most) * (kWidth - kLeft - 10);
  const last = ends[ends.length - 1];
  const text = `${feature} ${isCost ? 'costs' : 'is worth'} ${last ? amountText(last, unit) : ''}`;
  const ticks = [...new Set(known.map((value) => Math.max(0, value)))].sort((a, b) => a - b);
  const height = ends.length * kRow + 22;
  return (
    <figure class="small">
      <svg viewBox={`0 0 ${kWidth} ${height}`} role="img" aria-label={`${text}. The bracket closes over ${ends.length} periods.`}>
        {ends.map(({ low, high }, i) => {
          const y = i * kRow + 8;
          const [from, to] = [at(low ?? 0), at(high ?? most)];
          return (
            <g>
              <text class="tick" x={kLeft - 8} y={y + 4} text-anchor="end">
                {periods[i]}
              </text>
              {(low !== null || high !== null) && (
                <path
                  class="bracket"
                  d={`M${from} ${y}H${to}${low === null ? '' : `M${from} ${y - 4}v8`}${high === null ? '' : `M${to} ${y - 4}v8`}`}
                  stroke-dasharray={low === null || high === null ? '3 2' : undefined}
                />
              )}
            </g>
          );
        })}
        <path class="axis" d={`M${kLeft} ${height - 16}H${kWidth - 4}`} />
        {ticks.map((value) => (
          <text class="tick" x={at(value)} y={height - 3} text-anchor="middle">
            {value}
          </text>
        ))}
      </svg>
      <figcaption>
        {text} <span class="muted">(a row per period)</span>
      </figcaption>
    </figure>
  );
}

export function KnowledgeChart({ rows, names, periods }: { rows: (number | null)[][]; names: string[]; periods: number[] }): JSX.Element {
  const height = 120;
  const x = (i: number): number => kLeft + (periods.length < 2 ? 0.5 : i / (periods.length - 1)) * (kWidth - kLeft - 14);
  const y = (share: number): number => 6 + (1 - share / 100) * (height - 26);
  const shapes = ['M-3.5-3.5h7v7h-7z', 'M-4 0a4 4 0 1 0 8 0a4 4 0 1 0-8 0', 'M0-4.5L4.5 4H-4.5z', 'M0-5L5 0L0 5L-5 0z'];
  const last = names.map((name, m) => `${name} ${((rows[rows.length - 1]?.[m] ?? 0) / 100).toFixed(2)}`);
  return (
    <figure class="small">
      <svg viewBox={`0 0 ${kWidth} ${height}`} role="img" aria-label={`Knowledge after the last period: ${last.join(', ')}`}>
        {[0, 50, 100].map((share) => (
          <g>
            <path class="grid-line" d={`M${kLeft} ${y(share)}H${kWidth - 8}`} />
            <text class="tick" x={kLeft - 4} y={y(share) + 4} text-anchor="end">
              {share === 50 ? '.5' : share / 100}
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
            <g class="member" style={{ color: `var(--t${1 + (m % 4)})` }}>
              <polyline points={points.map((point) => point.join(',')).join(' ')} stroke-dasharray={m === 0 ? undefined : `${2 + 2 * m} 2`} />
              {points.map(([px, py]) => (
                <path transform={`translate(${px} ${py}) scale(0.8)`} d={shapes[m % shapes.length]} />
              ))}
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
