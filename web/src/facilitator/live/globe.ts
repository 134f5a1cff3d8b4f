// Orthographic drawing of the unit sphere: points, great-circle outlines and regions as SVG paths.
import { middle, normalise, toLonLat, type Vector } from '../../shared/sphere';

// Longitude and latitude that face the viewer, degrees.
export interface Turn {
  lambda: number;
  phi: number;
}

export interface Placed {
  x: number; // to the right, in radii
  y: number; // downwards, in radii
  z: number; // towards the viewer: >= 0 is in front
}

const kRadians = Math.PI / 180;

export const asVector = ([x = 0, y = 0, z = 0]: number[]): Vector => normalise([x, y, z]);

function turnTo(v: Vector): Turn {
  const [lambda, phi] = toLonLat(v);
  return { lambda, phi };
}

const kFromPrior = 0.6;

// Between the prior's middle and the true reward: most of the prior faces the viewer, and the region that
// matters is not at the edge.
export function firstTurn(truth: number[], prior: number[][]): Turn {
  const [a, b, c] = asVector(truth);
  if (prior.length < 3) return turnTo([a, b, c]);
  const [x, y, z] = middle(prior.map(asVector));
  return turnTo(asVector([kFromPrior * x + a, kFromPrior * y + b, kFromPrior * z + c]));
}

export function placer({ lambda, phi }: Turn): (v: Vector) => Placed {
  const [cl, sl] = [Math.cos(lambda * kRadians), Math.sin(lambda * kRadians)];
  const [cp, sp] = [Math.cos(phi * kRadians), Math.sin(phi * kRadians)];
  return ([x, y, z]) => {
    const ahead = cl * x + sl * y;
    return { x: cl * y - sl * x, y: -(cp * z - sp * ahead), z: cp * ahead + sp * z };
  };
}

const kStep = 4 * kRadians; // longest piece of a great circle that is drawn as a straight line

// An outline with points between its corners, along great circles.
export function refined(outline: number[][], closed = true): Vector[] {
  const corners = outline.map(asVector);
  const all: Vector[] = [];
  corners.forEach((from, i) => {
    const to = corners[i + 1] ?? (closed ? corners[0] : undefined);
    all.push(from);
    if (!to) return;
    const angle = Math.acos(Math.max(-1, Math.min(1, from[0] * to[0] + from[1] * to[1] + from[2] * to[2])));
    const pieces = Math.ceil(angle / kStep);
    for (let k = 1; k < pieces; ++k) {
      const [a, b] = [Math.sin(angle * (1 - k / pieces)), Math.sin(angle * (k / pieces))];
      all.push(asVector([a * from[0] + b * to[0], a * from[1] + b * to[1], a * from[2] + b * to[2]]));
    }
  });
  return all;
}

const at = ({ x, y }: { x: number; y: number }, radius: number): string =>
  `${(x * radius).toFixed(1)} ${(y * radius).toFixed(1)}`;

// The visible parts of a closed line.
export function linePath(points: Vector[], place: (v: Vector) => Placed, radius: number): string {
  const placed = points.map(place);
  let path = '';
  placed.forEach((from, i) => {
    const to = placed[(i + 1) % placed.length];
    if (!to || from.z < 0 || to.z < 0) return;
    const before = placed[(i + placed.length - 1) % placed.length];
    const goesOn = path !== '' && i > 0 && before !== undefined && before.z >= 0;
    path += goesOn ? `L${at(to, radius)}` : `M${at(from, radius)}L${at(to, radius)}`;
  });
  return path;
}

// The visible part of a region. What is behind is moved to the rim, so that the shape closes along it.
export function regionPath(points: Vector[], place: (v: Vector) => Placed, radius: number): string {
  const placed = points.map(place);
  if (!placed.some(({ z }) => z >= 0)) return '';
  const shown = placed.map((p) => {
    if (p.z >= 0) return p;
    const length = Math.hypot(p.x, p.y) || 1;
    return { x: p.x / length, y: p.y / length };
  });
  return `M${shown.map((p) => at(p, radius)).join('L')}Z`;
}

// Dots of the front or the back as lines without length; the stroke's round caps make them visible.
export function dotsPath(points: Vector[], place: (v: Vector) => Placed, radius: number, front: boolean): string {
  let path = '';
  for (const point of points) {
    const placed = place(point);
    if (placed.z >= 0 === front) path += `M${at(placed, radius)}h0`;
  }
  return path;
}

// Unpacks base64 of int16, little endian, x, y, z times 32767.
export function unpack(text: string): Vector[] {
  const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  const view = new DataView(bytes.buffer);
  const count = Math.floor(bytes.byteLength / 6);
  const read = (place: number): number => view.getInt16(place, true) / 32767;
  return Array.from({ length: count }, (_, i) => [read(6 * i), read(6 * i + 2), read(6 * i + 4)]);
}

// Every 30 degrees: meridians and parallels, for the shape of the ball.
export const kGraticule: Vector[][] = [
  ...[-60, -30, 0, 30, 60].map((lat) =>
    Array.from({ length: 72 }, (_, i): Vector => onBall(i * 5, lat)),
  ),
  ...[0, 30, 60, 90, 120, 150].map((lon) =>
    Array.from({ length: 72 }, (_, i): Vector => {
      const around = i * 5;
      const [c, s] = [Math.cos(around * kRadians), Math.sin(around * kRadians)];
      const [cl, sl] = [Math.cos(lon * kRadians), Math.sin(lon * kRadians)];
      return [c * cl, c * sl, s];
    }),
  ),
];

function onBall(lon: number, lat: number): Vector {
  const [cl, sl] = [Math.cos(lon * kRadians), Math.sin(lon * kRadians)];
  const [cp, sp] = [Math.cos(lat * kRadians), Math.sin(lat * kRadians)];
  return [cp * cl, cp * sl, sp];
}

export function turned(turn: Turn, dx: number, dy: number): Turn {
  const lambda = ((((turn.lambda - dx + 180) % 360) + 360) % 360) - 180;
  return { lambda, phi: Math.max(-90, Math.min(90, turn.phi + dy)) };
}
