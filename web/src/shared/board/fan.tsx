// What can follow from an action where chance has a part: an arrow for each outcome, with how often it happens.
import type { JSX } from 'preact';
import { centre, kUnit } from './geometry';
import type { Place } from './types';

export interface Arm {
  from: Place;
  to: Place;
  kind: 'own' | 'other';
  text: string; // "1 of 3"
}

const kSize = 9; // of letters

export function Fan({ arms }: { arms: Arm[] }): JSX.Element {
  return (
    <g class="arms">
      {arms.map(({ from, to, kind, text }) => {
        const at = centre(from);
        const [dx, dy] = [Math.sign(to[0] - from[0]), Math.sign(to[1] - from[1])];
        const isStaying = dx === 0 && dy === 0;
        const end = { x: at.x + 0.62 * kUnit * dx, y: at.y + 0.62 * kUnit * dy };
        const label = isStaying ? { x: at.x - 12, y: at.y + 15 } : { x: at.x + 1.02 * kUnit * dx, y: at.y + 0.98 * kUnit * dy };
        const width = text.length * kSize * 0.5 + 7;
        return (
          <g class={`way ${kind}`}>
            {!isStaying && <path class="line" d={`M${at.x} ${at.y}L${end.x} ${end.y}`} />}
            {!isStaying && (
              <path class="arrow" d="M6 0-4 -5V5Z" transform={`translate(${end.x} ${end.y}) rotate(${(Math.atan2(dy, dx) * 180) / Math.PI})`} />
            )}
            <g class={`chip ${kind}`} transform={`translate(${label.x} ${label.y})`}>
              <rect x={-width / 2} y={-6.5} width={width} height={13} rx={6} />
              <text text-anchor="middle" dominant-baseline="central" font-size={kSize}>
                {text}
              </text>
            </g>
          </g>
        );
      })}
    </g>
  );
}
