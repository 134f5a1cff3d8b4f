// One Vega specification with a globe per belief (orthographic projection). All globes share one
// rotation, the signals `lambda` and `phi`: longitude and latitude that face the viewer, degrees; above a
// `zoom` of 1 a round window shows a part of them.
import type { Json, Spec } from '../chart';
import type { Beliefs, BeliefTeam, Vector } from '../document';
import { color } from '../theme';
import { formatFixed } from '../words';
import { closedLine, polygon, toLonLat } from './geometry';
import type { Particles } from './particles';

export interface Turn {
  lambda: number;
  phi: number;
  zoom: number;
}

const kKinds = ['own', 'teacher', 'common', 'joint'];
const kStar =
  'M0,-1L0.235,-0.324L0.951,-0.309L0.38,0.124L0.588,0.809L0,0.4L-0.588,0.809L-0.38,0.124L-0.951,-0.309L-0.235,-0.324Z';
const kTop = 22; // name above a globe, px
const kBottom = 26; // mass below it, px

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
    particles.at(frame, belief).map((coordinates) => ({ type: 'Point', coordinates, belief, kind })),
  );
}

export function beliefRows(team: BeliefTeam, frame: number): Json[] {
  return team.beliefs.map(({ name }, belief) => ({
    belief,
    name,
    mass: `p = ${formatFixed(team.mass[frame]?.[belief], 2)}`,
  }));
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

interface Key {
  label: string;
  shape: string;
  fill: string;
  stroke: string;
  dash: number[];
}

const kRegionDashes = [
  [1, 0],
  [4, 3],
  [1.5, 2.5],
  [7, 3],
];

function keys(beliefs: Beliefs): Key[] {
  return [
    ...beliefs.regions.map(({ label }, i) => ({
      label,
      shape: i === 0 ? 'square' : 'stroke',
      fill: i === 0 ? color('bec') : 'transparent',
      stroke: i === 0 ? color('bec') : color('muted'),
      dash: kRegionDashes[i % 4] ?? [1, 0],
    })),
    { label: 'true reward', shape: kStar, fill: color('truth'), stroke: color('ground'), dash: [1, 0] },
    { label: 'particle', shape: 'circle', fill: color('muted'), stroke: 'transparent', dash: [1, 0] },
  ];
}

// Places of the legend's entries, broken into lines; widths are estimated, text is short.
function placedKeys(list: Key[], width: number): { rows: Json[]; lines: number } {
  let x = 0;
  let line = 0;
  const rows = list.map((key) => {
    const size = 24 + key.label.length * 6.6;
    if (x > 0 && x + size > width) {
      x = 0;
      ++line;
    }
    const placed = { ...key, x, line };
    x += size + 10;
    return placed;
  });
  return { rows: rows as unknown as Json[], lines: line + 1 };
}

const geoshape = (from: string, encode: Spec, pointRadius?: number): Spec => ({
  type: 'shape',
  from: { data: from },
  encode: { update: encode },
  transform: [{ type: 'geoshape', projection: 'globe', ...(pointRadius ? { pointRadius } : {}) }],
});

function globeMarks(): Spec[] {
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
        fontSize: { value: 9 },
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
      { name: 'beliefs', values: beliefRows(team, frame) },
      {
        name: 'axes',
        values: axisRows(beliefs.features),
        transform: onGlobe(radius),
      },
      { name: 'keys', values: legend.rows },
    ],
    marks: [
      caption('name', 12, { fontSize: { value: 11.5 }, fontWeight: { value: 600 }, fill: { value: color('text') } }),
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
