// What a globe is drawn with, from the ground up.
import type { Spec } from '../chart';
import { color } from '../../shared/theme';
import { kStar } from './sphere_legend';

const geoshape = (from: string, encode: Spec, pointRadius?: number): Spec => ({
  type: 'shape',
  from: { data: from },
  encode: { update: encode },
  transform: [{ type: 'geoshape', projection: 'globe', ...(pointRadius ? { pointRadius } : {}) }],
});

export function globeMarks(): Spec[] {
  const kindColor = { scale: 'kind', field: 'kind' };
  const label = (extra: Spec): Spec => ({
    type: 'text',
    from: { data: 'axes' },
    encode: {
      update: {
        x: { field: 'px' },
        y: { field: 'py' },
        dy: { value: -6 },
        text: { field: 'label' },
        align: { value: 'center' },
        fontSize: { value: 11 },
        opacity: { signal: 'datum.front > 0.05 ? 1 : 0' },
        ...extra,
      },
    },
  });
  return [
    geoshape('sphere', {
      fill: { value: color('sphere') },
      stroke: { value: color('line') },
      strokeWidth: { value: 1 },
    }),
    geoshape('graticule', { stroke: { value: color('grid') }, strokeWidth: { value: 0.7 } }),
    geoshape('region', {
      fill: { value: color('bec') },
      fillOpacity: { value: 0.28 },
      stroke: { value: color('bec') },
      strokeWidth: { value: 1.6 },
    }),
    geoshape('outlines', {
      stroke: { value: color('muted') },
      strokeWidth: { value: 1.1 },
      strokeDash: { field: 'dash' },
    }),
    geoshape('cloud', { fill: kindColor, fillOpacity: { value: 0.42 } }, 1.8),
    {
      type: 'symbol',
      from: { data: 'axes' },
      encode: {
        update: {
          x: { field: 'px' },
          y: { field: 'py' },
          size: { value: 7 },
          fill: { value: color('muted') },
          opacity: { signal: 'datum.front > 0.05 ? 1 : 0' },
        },
      },
    },
    label({
      stroke: { value: color('sphere') },
      strokeWidth: { value: 3 },
      strokeOpacity: { value: 0.85 },
      fill: { value: color('sphere') },
    }),
    label({ fill: { value: color('muted') } }),
    {
      type: 'symbol',
      from: { data: 'truth' },
      encode: {
        update: {
          x: { field: 'px' },
          y: { field: 'py' },
          shape: { value: kStar },
          size: { value: 80 },
          fill: { value: color('truth') },
          stroke: { value: color('ground') },
          strokeWidth: { value: 0.8 },
          opacity: { signal: 'datum.front > 0 ? 1 : 0' },
        },
      },
    },
  ];
}
