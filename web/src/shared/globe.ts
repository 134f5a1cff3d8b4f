// Orthographic drawing of the unit sphere: lines, regions and points as SVG paths.
import { geoArea, geoGraticule, geoOrthographic, geoPath, type GeoPermissibleObjects } from 'd3-geo';
import { middle, normalise, toLonLat, type LonLat, type Vector } from './sphere';

// Longitude and latitude that face the viewer, degrees, and how much larger than its frame a globe is drawn.
export interface Turn {
  lambda: number;
  phi: number;
  zoom: number;
}

export interface Placed {
  x: number; // to the right
  y: number; // downwards
  z: number; // towards the viewer: >= 0 is in front
}

// Draws what faces the viewer. Lengths are those of the radius.
export interface Globe {
  path: (shape: GeoPermissibleObjects) => string;
  place: (v: Vector) => Placed;
}

const kRadians = Math.PI / 180;
const kFromPrior = 0.6;

export const asVector = ([x = 0, y = 0, z = 0]: number[]): Vector => normalise([x, y, z]);

// Between the prior's middle and the true reward: most of the prior faces the viewer, and the region that matters is
// not at the edge. The larger the zoom, the nearer to the true reward, or it would leave the frame.
export function firstTurn(truth: number[], prior: number[][], zoom = 1): Turn {
  const [a, b, c] = asVector(truth);
  const [x, y, z] = prior.length < 3 ? [a, b, c] : middle(prior.map(asVector));
  const far = kFromPrior * Math.max(0, 2 - zoom);
  const [lambda, phi] = toLonLat([far * x + a, far * y + b, far * z + c]);
  return { lambda, phi, zoom };
}

export function makeGlobe({ lambda, phi, zoom }: Turn, radius: number): Globe {
  const scale = radius * zoom;
  const path = geoPath(geoOrthographic().rotate([-lambda, -phi]).scale(scale).translate([0, 0])).digits(1);
  const [cl, sl] = [Math.cos(lambda * kRadians), Math.sin(lambda * kRadians)];
  const [cp, sp] = [Math.cos(phi * kRadians), Math.sin(phi * kRadians)];
  return {
    path: (shape) => path(shape) ?? '',
    place: ([x, y, z]) => {
      const ahead = cl * x + sl * y;
      return { x: scale * (cl * y - sl * x), y: -scale * (cp * z - sp * ahead), z: scale * (cp * ahead + sp * z) };
    },
  };
}

const closed = (corners: number[][]): LonLat[] => [...corners, ...corners.slice(0, 1)].map((corner) => toLonLat(asVector(corner)));

// The closed line through the corners.
export function outlineOf(corners: number[][]): GeoPermissibleObjects {
  const line = { type: 'LineString' as const, coordinates: closed(corners) };
  return line;
}

// What the corners enclose: the smaller of the two parts of the sphere.
export function regionOf(corners: number[][]): GeoPermissibleObjects {
  const region = { type: 'Polygon' as const, coordinates: [closed(corners)] };
  if (geoArea(region) > 2 * Math.PI) region.coordinates[0]?.reverse();
  return region;
}

// Every 30 degrees: meridians and parallels, for the shape of the ball.
export const kGraticule: GeoPermissibleObjects = geoGraticule().step([30, 30])();

// Dots of the front or the back as lines without length; the stroke's round caps make them visible.
export function dotsPath(points: Vector[], { place }: Globe, front: boolean): string {
  let path = '';
  for (const point of points) {
    const { x, y, z } = place(point);
    if (z >= 0 === front) path += `M${x.toFixed(1)} ${y.toFixed(1)}h0`;
  }
  return path;
}

// Unpacks base64 of int16, little endian, x, y, z times 32767.
export function unpack(text: string): Vector[] {
  const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  const view = new DataView(bytes.buffer);
  const read = (place: number): number => view.getInt16(place, true) / 32767;
  return Array.from({ length: Math.floor(bytes.byteLength / 6) }, (_, i) => [read(6 * i), read(6 * i + 2), read(6 * i + 4)]);
}

export function turned({ lambda, phi, zoom }: Turn, dx: number, dy: number): Turn {
  return { lambda: ((((lambda - dx + 180) % 360) + 360) % 360) - 180, phi: Math.max(-90, Math.min(90, phi + dy)), zoom };
}
