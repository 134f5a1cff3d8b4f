// One Vega specification with a globe per belief (orthographic projection). All globes share one
// rotation, the signals `lambda` and `phi`: longitude and latitude that face the viewer, degrees; above a
// `zoom` of 1 a round window shows a part of them.
import type { Json, Spec } from '../chart';
import { toLonLat, type Vector } from '../../shared/sphere';
import type { Beliefs, BeliefTeam } from '../document';
import { color } from '../../shared/theme';
import { formatFixed } from '../words';
import { closedLine, polygon } from './geometry';
import { globeMarks } from './globe_marks';
import type { Particles } from './particles';
import { kRegionDashes, keys, placedKeys } from './sphere_legend';
import { thinks, typicalOutside } from './thinks';

export interface Turn {
  lambda: number;
  phi: number;
  zoom: number;
}

const kKinds = ['own', 'teacher', 'common', 'joint'];
const kTop = 22; // name above a globe, px
const kBottom = 54; // what is said below it, px

export interface Layout {
  columns: number;
  cell: number;
  radius: number;
  rows: number;
}

export function layoutOf(count: number, width: number): Layout {
  const fitting = Math.max(2, Math.floor(width / 150));
  const rows = Math.ceil(count / fitting);
  const columns = Math.ceil(count / rows);
  const cell = Math.min(Math.floor((width - 10) / columns), 250);
  return { columns, cell, radius: Math.floor((cell - 18) / 2), rows };
}

export function particleRows(particles: Particles, team: BeliefTeam, frame: number): Json[] {
  return team.beliefs.flatMap(({ kind }, belief) =>
    particles.at(frame, belief).map((vector) => ({ type: 'Point', coordinates: toLonLat(vector), belief, kind })),
  );
}

// What is written about a globe. One particle that is outside the policy's region is put into words.
export function beliefRows(beliefs: Beliefs, team: BeliefTeam, particles: Particles, frame: number): Json[] {
  return team.beliefs.map(({ name }, belief) => {
    const typical = typicalOutside(particles.at(frame, belief), beliefs.regions[0]?.outline ?? []);
    return {
      belief,
      name,
      mass: `knowledge ${formatFixed(team.mass[frame]?.[belief], 2)}`,
      thinks: typical ? thinks(typical, beliefs.truth, beliefs.features) : null,
      ...(typical ? inRadians(typical) : { lon: 0, lat: 0 }),
    };
  });
}

function inRadians(v: Vector): { lon: number; lat: number } {
  const [lon, lat] = toLonLat(v);
  return { lon: (lon * Math.PI) / 180, lat: (lat * Math.PI) / 180 };
}

// The orthographic projection of points whose marks keep their shape at the edge: place and whether
// they are in front.
function onGlobe(radius: number): Json[] {
  const away = 'datum.lon - lambda*PI/180';
  return [
    {
      type: 'formula',
      as: 'front',
      expr: `sin(phi*PI/180)*sin(datum.lat) + cos(phi*PI/180)*cos(datum.lat)*cos(${away})`,
    },
    { type: 'formula', as: 'px', expr: `${radius} + zoom*${radius - 1}*cos(datum.lat)*sin(${away})` },
    {
      type: 'formula',
      as: 'py',
      expr: `${radius} - zoom*${radius - 1}*(cos(phi*PI/180)*sin(datum.lat) - sin(phi*PI/180)*cos(datum.lat)*cos(${away}))`,
    },
  ];
}

// Both ends of every feature's axis, for orientation.
function axisRows(features: string[]): Json[] {
  return features.slice(0, 3).flatMap((name, i) =>
    [1, -1].map((sign) => {
      const end: Vector = [i === 0 ? sign : 0, i === 1 ? sign : 0, i === 2 ? sign : 0];
      return { label: `${name} ${sign > 0 ? '+' : '\u2212'}`, ...inRadians(end) };
    }),
  );
}

export function sphereSpec(
  beliefs: Beliefs,
  team: BeliefTeam,
  particles: Particles,
  frame: number,
  turn: Turn,
  width: number,
): Spec {
  const { columns, cell, radius, rows } = layoutOf(team.beliefs.length, width);
  const pitch = 2 * radius + kTop + kBottom + 8;
  const legend = placedKeys(keys(beliefs), columns * cell);
  const x = `(datum.belief % ${columns}) * ${cell} + ${(cell - 2 * radius) / 2}`;
  const y = `floor(datum.belief / ${columns}) * ${pitch}`;
  const caption = (field: string, dy: number, extra: Spec): Spec => ({
    type: 'text',
    from: { data: 'beliefs' },
    encode: {
      update: {
        x: { signal: `${x} + ${radius}` },
        y: { signal: `${y} + ${dy}` },
        text: { field },
        align: { value: 'center' },
        limit: { value: cell - 4 },
        ...extra,
      },
    },
  });
  const legendTop = rows * pitch + 6;
  return {
    $schema: 'https://vega.github.io/schema/vega/v5.json',
    width: columns * cell,
    height: legendTop + legend.lines * 20,
    signals: [
      { name: 'lambda', value: turn.lambda },
      { name: 'phi', value: turn.phi },
      { name: 'zoom', value: turn.zoom },
    ],
    projections: [
      {
        name: 'globe',
        type: 'orthographic',
        rotate: [{ signal: '-lambda' }, { signal: '-phi' }, 0],
        scale: { signal: `zoom * ${radius - 1}` },
        translate: [radius, radius],
        precision: 0.3,
      },
    ],
    scales: [{ name: 'kind', type: 'ordinal', domain: kKinds, range: kKinds.map(color) }],
    data: [
      { name: 'sphere', values: [{ type: 'Sphere' }] },
      { name: 'graticule', transform: [{ type: 'graticule', step: [30, 30] }] },
      { name: 'region', values: beliefs.regions.slice(0, 1).map(({ outline }) => polygon(outline)) },
      {
        name: 'outlines',
        values: beliefs.regions
          .slice(1)
          .map(({ outline }, i) => ({ ...closedLine(outline), dash: kRegionDashes[(i + 1) % 4] })),
      },
      { name: 'truth', values: [inRadians(beliefs.truth)], transform: onGlobe(radius) },
      { name: 'particles', values: particleRows(particles, team, frame) },
      { name: 'beliefs', values: beliefRows(beliefs, team, particles, frame), transform: onGlobe(radius) },
      {
        name: 'axes',
        values: axisRows(beliefs.features),
        transform: onGlobe(radius),
      },
      { name: 'keys', values: legend.rows },
    ],
    marks: [
      caption('name', 12, { fontSize: { value: 12 }, fontWeight: { value: 600 }, fill: { value: color('text') } }),
      {
        type: 'group',
        from: { facet: { name: 'cloud', data: 'particles', groupby: ['belief'] } },
        encode: {
          update: {
            x: { signal: x },
            y: { signal: `${y} + ${kTop}` },
            width: { value: 2 * radius },
            height: { value: 2 * radius },
            cornerRadius: { value: radius },
            clip: { signal: 'zoom > 1' },
            stroke: { signal: `zoom > 1 ? '${color('line')}' : null` },
          },
        },
        marks: globeMarks(),
      },
      caption('mass', kTop + 2 * radius + 17, { fontSize: { value: 12 }, fill: { value: color('text') } }),
      {
        type: 'symbol',
        from: { data: 'beliefs' },
        encode: {
          update: {
            x: { signal: `${x} + datum.px` },
            y: { signal: `${y} + ${kTop} + datum.py` },
            shape: { value: 'circle' },
            size: { value: 110 },
            fill: { value: 'transparent' },
            stroke: { value: color('text') },
            strokeWidth: { value: 1.6 },
            opacity: { signal: `datum.thinks && datum.front > 0 && pow(datum.px - ${radius}, 2) + pow(datum.py - ${radius}, 2) < ${radius * radius} ? 1 : 0` },
          },
        },
      },
      caption('thinks', kTop + 2 * radius + 32, {
        fontSize: { value: 11 },
        lineHeight: { value: 13 },
        fill: { value: color('muted') },
      }),
      {
        type: 'symbol',
        from: { data: 'keys' },
        encode: {
          update: {
            x: { signal: 'datum.x + 9' },
            y: { signal: `${legendTop} + datum.line * 20 + 8` },
            shape: { field: 'shape' },
            size: {
              signal:
                "datum.shape === 'circle' ? 40 : datum.shape === 'square' ? 110 : datum.shape === 'stroke' ? 240 : 160",
            },
            fill: { field: 'fill' },
            fillOpacity: { signal: "datum.shape === 'square' ? 0.28 : datum.shape === 'circle' ? 0.6 : 1" },
            stroke: { field: 'stroke' },
            strokeDash: { field: 'dash' },
            strokeWidth: { value: 1.4 },
          },
        },
      },
      {
        type: 'text',
        from: { data: 'keys' },
        encode: {
          update: {
            x: { signal: 'datum.x + 22' },
            y: { signal: `${legendTop} + datum.line * 20 + 12` },
            text: { field: 'label' },
            fontSize: { value: 12 },
            fill: { value: color('text') },
          },
        },
      },
    ],
  };
}
