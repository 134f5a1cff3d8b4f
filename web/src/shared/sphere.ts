// Unit vectors, and where they lie on a globe.
export type Vector = [number, number, number];
export type LonLat = [number, number]; // degrees

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

// The middle of a spherical polygon: the direction of its vector area. A hemisphere has one, although the mean of its
// corners is 0.
export function middle(outline: Vector[]): Vector {
  let sum: Vector = [0, 0, 0];
  outline.forEach((corner, i) => {
    const part = cross(corner, outline[(i + 1) % outline.length] ?? corner);
    sum = [sum[0] + part[0], sum[1] + part[1], sum[2] + part[2]];
  });
  return normalise(sum);
}
