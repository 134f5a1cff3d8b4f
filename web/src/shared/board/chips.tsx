// What one path has more of than the other, written on it: "+1 rubble".
import type { JSX } from 'preact';
import { centre, kMargin, kUnit, type Point } from './geometry';
import type { Frame, PathKind, Place } from './types';

export interface Chip {
  kind: PathKind;
  text: string;
  feature: number; // what is counted, and
  thing: string; // what a cell has on which it counts, unless every step does
}

const kSeen = 520; // pixels that a board is wide where there is room, and
const kText = 15; // pixels of the letters on it

interface Props {
  chips: Chip[];
  frames: Frame[];
  other: Frame[];
  first: number; // the frame at which the paths separate
  thingsAt: (cell: Place) => string[];
  width: number;
  height: number;
}

export function Chips({ chips, frames, other, first, thingsAt, width, height }: Props): JSX.Element {
  const size = Math.max(5.5, Math.min(21, (kText * width) / Math.min(kSeen, window.innerWidth)));
  const taken: Point[] = [];
  return (
    <g class="chips" aria-hidden="true">
      {chips.map(({ kind, text: whole, feature, thing }) => {
        const [way, away] = kind === 'own' ? [frames, other] : [other, frames];
        const halfOf = (text: string): number => (text.length * size * 0.62 + size * 1.2) / 2;
        const text = halfOf(whole) > 0.2 * width ? (whole.split(' ')[0] ?? '') : whole; // the table beside the board names it
        const half = { x: halfOf(text), y: size * 0.85 };
        const cell = counting({ kind, text, feature, thing }, frames, other, first, thingsAt);
        const at = freeOf(cell ? below(cell) : middle(way.slice(first), away.slice(first)), taken, 2.1 * half.y);
        const x = Math.max(half.x - kMargin, Math.min(width - 2 * kMargin - half.x + kMargin, at.x));
        const y = Math.max(half.y - kMargin, Math.min(height - 2 * kMargin - half.y + kMargin, at.y));
        taken.push({ x, y });
        return (
          <g class={`chip ${kind}`} transform={`translate(${x.toFixed(1)} ${y.toFixed(1)})`}>
            <rect x={-half.x} y={-half.y} width={2 * half.x} height={2 * half.y} rx={half.y} />
            <text text-anchor="middle" dominant-baseline="central" font-size={size.toFixed(1)}>
              {text}
            </text>
          </g>
        );
      })}
    </g>
  );
}

// Of the cells on which it counts the one in the middle. Nothing where every step counts.
export function counting({ kind, feature, thing }: Chip, frames: Frame[], other: Frame[], first: number, thingsAt: (cell: Place) => string[]): Place | null {
  const [way = [], away = []] = (kind === 'own' ? [frames, other] : [other, frames]).map((all) => all.slice(first));
  const cellsOf = (frames: Frame[]): Place[] =>
    frames.flatMap(({ robot, counts }, t): Place[] => {
      if (!robot || !counts?.[feature]) return [];
      const cells = [frames[t + 1]?.robot ?? robot, robot]; // entered, or left
      return [cells.find((cell) => thingsAt(cell).includes(thing)) ?? cells.find((cell) => thingsAt(cell).length > 0) ?? cells[0] ?? robot];
    });
  const [all, others] = [cellsOf(way), new Set(cellsOf(away).map(String))];
  const own = all.filter((cell) => !others.has(String(cell)));
  if (all.length === way.length - 1) return null;
  return (own.length > 0 ? own : all)[Math.floor((own.length || all.length) / 2)] ?? null;
}

// So that what is on the cell is seen.
function below(cell: Place): Point {
  const { x, y } = centre(cell);
  return { x, y: y + 0.3 * kUnit };
}

// The place in the middle of what a way has to itself: far from the other one, and not where a robot ends.
function middle(way: Frame[], away: Frame[]): Point {
  const points = (frames: Frame[]): Point[] => frames.flatMap(({ robot }) => (robot ? [centre(robot)] : []));
  const [own, others] = [points(way), points(away)];
  while (own.length > 2 && others.length > 2 && String(Object.values(own.at(-2) ?? {})) === String(Object.values(others.at(-2) ?? {}))) {
    own.pop(); // the end that they have in common
    others.pop();
  }
  const far = own.map((point) => Math.min(...others.map(({ x, y }) => Math.hypot(x - point.x, y - point.y)), 1e6));
  const most = Math.max(0, ...far.slice(1, -1));
  const apart = own.filter((_, i) => i > 0 && i + 1 < own.length && (far[i] ?? 0) >= 0.7 * most);
  const [first, second] = own;
  return apart[Math.floor(apart.length / 2)] ?? (first && second ? { x: (first.x + second.x) / 2, y: (first.y + second.y) / 2 } : { x: 0, y: 0 });
}

// Below what is there already.
function freeOf(at: Point, taken: Point[], step: number): Point {
  let free = at;
  while (taken.some(({ x, y }) => Math.abs(x - free.x) < 60 && Math.abs(y - free.y) < step * 0.98)) free = { x: free.x, y: free.y + step };
  return free;
}
