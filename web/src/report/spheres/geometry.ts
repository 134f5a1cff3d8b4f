// Unit vectors on a globe: longitude and latitude in degrees, as GeoJSON wants them.
import type { Vector } from '../document';

export type LonLat = [number, number];

const kDegrees = 180 / Math.PI;

export function normalise([x, y, z]: Vector): Vector {
  const length = Math.hypot(x, y, z) || 1;
  return [x / length, y / length, z / length];
}

export function toLonLat(v: Vector): LonLat {
  const [x, y, z] = normalise(v);
  return [Math.atan2(y, x) * kDegrees, Math.asin(Math.max(-1, Math.min(1, z))) * kDegrees];
}

const cross = (a: Vector, b: Vector): Vector => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];

// Middle of a spherical polygon: the direction of its vector area, which also a hemisphere has
// (whose corners have mean 0).
export function middle(outline: Vector[]): Vector {
  let sum: Vector = [0, 0, 0];
  outline.forEach((corner, i) => {
    const next = outline[(i + 1) % outline.length] ?? corner;
    const part = cross(corner, next);
    sum = [sum[0] + part[0], sum[1] + part[1], sum[2] + part[2]];
  });
  return normalise(sum);
}

// d3-geo wants the inside to the right of the ring, the document has it to the left.
export function polygon(outline: Vector[]): { type: 'Polygon'; coordinates: LonLat[][] } {
  const ring = [...outline].reverse().map(toLonLat);
  const first = ring[0];
  return { type: 'Polygon', coordinates: [first ? [...ring, first] : ring] };
}

export function closedLine(outline: Vector[]): { type: 'LineString'; coordinates: LonLat[] } {
  const ring = outline.map(toLonLat);
  const first = ring[0];
  return { type: 'LineString', coordinates: first ? [...ring, first] : ring };
}
