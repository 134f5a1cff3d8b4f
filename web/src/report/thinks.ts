// What somebody would think whose belief is one point of a sphere.
import type { Vector } from '../shared/sphere';
import { plural } from './words';

const dot = (a: Vector, b: Vector): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = ([a, b, c]: Vector, [x, y, z]: Vector): Vector => [b * z - c * y, c * x - a * z, a * y - b * x];
function sum(vectors: Vector[]): Vector {
  return vectors.reduce<Vector>((all, one) => [all[0] + one[0], all[1] + one[1], all[2] + one[2]], [0, 0, 0]);
}

// Within a convex region, whichever way its outline goes round.
export function isInside(point: Vector, outline: Vector[]): boolean {
  const middle = sum(outline);
  return outline.every((corner, i) => {
    const next = outline[(i + 1) % outline.length] ?? corner;
    const normal = cross(corner, next);
    return dot(normal, point) * Math.sign(dot(normal, middle)) >= -1e-6;
  });
}

// Of the points outside the region the one nearest to their mean; null if all are inside.
export function typicalOutside(points: Vector[], outline: Vector[]): Vector | null {
  const outside = outline.length < 3 ? [] : points.filter((point) => !isInside(point, outline));
  const middle = sum(outside);
  return outside.reduce<Vector | null>(
    (best, point) => (best === null || dot(point, middle) > dot(best, middle) ? point : best),
    null,
  );
}

// In units of the last feature, such as steps: what differs most from the robot's weights, in two lines: "thinks
// rubble", "is free".
export function thinks(point: Vector, truth: Vector, features: string[]): [string, string] {
  const unit = features[2] ?? 'unit';
  if (point[2] >= 0 !== truth[2] >= 0 || Math.abs(point[2]) < 0.01) return [`thinks a ${unit}`, 'costs nothing'];
  const amount = (weights: Vector, k: number): number => (weights[k] ?? 0) / Math.abs(weights[2]);
  const far = ([0, 1] as const).map((k) => {
    const [thought, real] = [amount(point, k), amount(truth, k)];
    return thought * real <= 0 ? Infinity : Math.abs(Math.log(thought / real));
  });
  const k = (far[1] ?? 0) > (far[0] ?? 0) ? 1 : 0;
  const [thought, real, name] = [amount(point, k), amount(truth, k), `thinks ${features[k] ?? ''}`];
  if (thought * real < 0 && Math.abs(thought) >= 0.5) return [name, thought > 0 ? 'is good' : 'is bad'];
  if (Math.abs(thought) < 0.5) return [name, real < 0 ? 'is free' : 'is worth nothing'];
  const size = Math.abs(thought) < 10 ? Math.round(Math.abs(thought)) : 5 * Math.round(Math.abs(thought) / 5);
  return [name, `${real < 0 ? 'costs' : 'is worth'} about ${plural(size, unit)}`];
}
