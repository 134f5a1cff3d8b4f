// Outlines as GeoJSON, for d3-geo.
import { type LonLat, toLonLat, type Vector } from '../../shared/sphere';

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
