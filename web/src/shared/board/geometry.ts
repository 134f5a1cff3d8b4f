// Paths as lines: every move keeps to the right of its lane, so that ways there and back lie beside each other.
import type { Frame, Place } from './types';

export const kUnit = 40; // of a cell's side in the drawing
export const kMargin = 4; // around the map

export interface Point {
  x: number;
  y: number;
}

export const centre = ([column, row]: Place): Point => ({ x: (column - 0.5) * kUnit, y: (row - 0.5) * kUnit });

export interface Arrow extends Point {
  angle: number; // degrees, 0 to the right
}

// Where the robot tried to go from its cell, if it ended up elsewhere.
export interface Attempt extends Arrow {
  from: Point;
}

export interface Line {
  points: Point[];
  arrows: Arrow[]; // one in the middle of every move
  attempts: Attempt[];
  stops: Point[]; // where something is done without moving
}

// The way from frame `first` on. `lane` is how far from the middle it runs, as a part of a cell.
export function lineOf(frames: Frame[], first: number, lane: number): Line {
  const line: Line = { points: [], arrows: [], attempts: attemptsOf(frames.slice(first)), stops: [] };
  const places = frames.slice(first).flatMap((frame) => (frame.robot ? [frame.robot] : []));
  const moves: { from: Point; to: Point; side: Point }[] = [];
  places.forEach((place, i) => {
    const next = places[i + 1];
    if (!next) return;
    const from = centre(place);
    const to = centre(next);
    const length = Math.hypot(to.x - from.x, to.y - from.y);
    if (length === 0) {
      if (!hasSlipped(frames[first + i], next)) line.stops.push(from);
      return;
    }
    const shift = (lane * kUnit) / length;
    moves.push({ from, to, side: { x: -(to.y - from.y) * shift, y: (to.x - from.x) * shift } });
  });
  moves.forEach(({ from, to, side }, i) => {
    const before = moves[i - 1]?.side;
    if (!before) line.points.push({ x: from.x + side.x, y: from.y + side.y });
    else line.points.push(...corner(from, before, side));
    line.arrows.push({
      x: (from.x + to.x) / 2 + side.x,
      y: (from.y + to.y) / 2 + side.y,
      angle: (Math.atan2(to.y - from.y, to.x - from.x) * 180) / Math.PI,
    });
    if (i === moves.length - 1) line.points.push({ x: to.x + side.x, y: to.y + side.y });
  });
  return line;
}

export const kMoves: Record<string, Place> = { up: [0, -1], down: [0, 1], left: [-1, 0], right: [1, 0] };

// Whether a robot that tried to move ended up elsewhere than in that direction, or where it was.
export function hasSlipped(frame: Frame | undefined, to: Place | undefined): boolean {
  const wanted = kMoves[frame?.action ?? ''];
  if (!wanted || !frame?.robot || !to) return false;
  const [dx, dy] = [Math.sign(to[0] - frame.robot[0]), Math.sign(to[1] - frame.robot[1])];
  return dx !== wanted[0] || dy !== wanted[1];
}

function attemptsOf(frames: Frame[]): Attempt[] {
  const reach = 0.4 * kUnit;
  return frames.flatMap((frame, i) => {
    const [dx, dy] = kMoves[frame.action ?? ''] ?? [0, 0];
    if (!frame.robot || !hasSlipped(frame, frames[i + 1]?.robot)) return [];
    const from = centre(frame.robot);
    return [{ from, x: from.x + reach * dx, y: from.y + reach * dy, angle: (Math.atan2(dy, dx) * 180) / Math.PI }];
  });
}

// Where two lanes meet: one point straight on and in right angles, two otherwise.
function corner(at: Point, before: Point, after: Point): Point[] {
  const isAlong = before.x * after.y - before.y * after.x === 0;
  const isBack = isAlong && before.x * after.x + before.y * after.y < 0;
  if (isAlong && !isBack) return [{ x: at.x + after.x, y: at.y + after.y }];
  const isRight = Math.abs(before.x * after.x + before.y * after.y) < 1e-9;
  if (isRight) return [{ x: at.x + before.x + after.x, y: at.y + before.y + after.y }];
  return [
    { x: at.x + before.x, y: at.y + before.y },
    { x: at.x + after.x, y: at.y + after.y },
  ];
}
