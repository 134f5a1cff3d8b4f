// Means with intervals, strategies from top to bottom, one panel per composition or component;
// optionally the raw points behind them.
import type { Spec } from '../chart';
import { type Row, num } from '../document';
import type { Look } from '../palette';
import { type Place, extent, panels, yAxis } from '../panels';

export interface DotsOptions {
  looks: Look[];
  panels: { title: string; means: Row[]; points?: Row[] }[];
  mean: string;
  low: string;
  high: string;
  point?: string;
  xTitle: string;
  interval?: string; // what low and high are; '95 %' unless said otherwise
  zero: boolean;
  possible?: [number, number] | undefined; // what values can be: the axis and the intervals are cut there
  log?: boolean;
  opensTeams?: boolean; // a click on a point shows the team
  ownScales?: boolean; // panels that are not compared with each other
  left?: number | undefined; // room for the names, px; '|' breaks a line
  first?: number | undefined; // panels before these, where the figure has others too
  rows?: string | undefined; // what a row is; 'Strategy' unless said otherwise
  strategyOf(row: Row): string; // its label
}

// A point's place within the band of its strategy: spread evenly and without chance, so that a
// figure drawn twice is the same twice.
const spread = (i: number): number => ((i * 0.618034) % 1) * 2 - 1;

function layers(
  options: DotsOptions,
  panel: DotsOptions['panels'][number],
  place: Place,
  domain: [number, number],
): Spec {
  const labels = options.looks.map((look) => look.label);
  const scale = (range: (string | number)[]): Spec => ({ domain: labels, range });
  const y: Spec = {
    field: 'strategy',
    type: 'nominal',
    scale: { domain: labels, paddingInner: 0.25, paddingOuter: 0.15 },
    axis: yAxis(place, {
      title: null,
      ticks: false,
      domain: false,
      labelLimit: leftOf(options) + 12,
      labelExpr: "split(datum.label, '|')",
      labelPadding: 6,
      labelFontSize: 12,
      labelColor: 'var(--text)',
    }),
  };
  const x: Spec = {
    type: 'quantitative',
    scale: { domain, nice: false, ...(options.log ? { type: 'log' } : { zero: false }) },
    axis: {
      title: place.lastRow || options.ownScales ? options.xTitle : null,
      tickCount: Math.max(3, Math.min(8, Math.floor(place.width / 45))),
      ...(options.log ? { labelOverlap: 'greedy' } : {}),
      domain: false,
      labelFlush: false,
      format: '.3~f',
    },
  };
  const hue: Spec = {
    field: 'strategy',
    type: 'nominal',
    scale: scale(options.looks.map((look) => look.color)),
    legend: null,
  };
  const shape: Spec = {
    field: 'strategy',
    type: 'nominal',
    scale: scale(options.looks.map((look) => look.shape)),
    legend: null,
  };
  const [from, to] = options.possible ?? [-Infinity, Infinity];
  const cut = (value: number | null): number | null => (value === null ? null : Math.min(to, Math.max(from, value)));
  const means = panel.means.map((row) => ({
    strategy: options.strategyOf(row),
    name: options.strategyOf(row).replaceAll('|', ' '),
    mean: num(row[options.mean]),
    low: cut(num(row[options.low])),
    high: cut(num(row[options.high])),
  }));
  const seen = new Map<string, number>();
  const points = (panel.points ?? []).map((row) => {
    const strategy = options.strategyOf(row);
    const i = seen.get(strategy) ?? 0;
    seen.set(strategy, i + 1);
    return { strategy, value: num(row[options.point ?? '']), spread: spread(i), team: row.team ?? null };
  });
  const tooltip = [
    { field: 'name', title: options.rows ?? 'Strategy' },
    { field: 'mean', title: options.xTitle, format: '.3~r' },
    { field: 'low', title: `${options.interval ?? '95 %'} from`, format: '.3~r' },
    { field: 'high', title: 'to', format: '.3~r' },
  ];
  const raw: Spec = {
    data: { values: points },
    mark: { type: 'circle', size: 18, opacity: points.length > 600 ? 0.18 : 0.38, ...(options.opensTeams ? { cursor: 'pointer' } : {}) },
    encoding: {
      y,
      x: { ...x, field: 'value' },
      yOffset: { field: 'spread', type: 'quantitative', scale: { domain: [-1.05, 1.05] }, axis: null },
      color: hue,
      tooltip: [
        { field: 'team', title: options.opensTeams ? 'Click for team' : 'Team' },
        { field: 'strategy', title: options.rows ?? 'Strategy' },
        { field: 'value', title: options.xTitle, format: '.3~r' },
      ],
    },
  };
  const known = means.filter((row) => row.low !== null && row.high !== null);
  return {
    title: panel.title,
    width: place.width,
    height: options.looks.length * 32,
    layer: [
      ...(!options.log && domain[0] <= 0 && domain[1] >= 0 ? [zeroLine(x)] : []),
      ...(points.length > 0 ? [raw] : []),
      {
        data: { values: known },
        mark: { type: 'rule', strokeWidth: 2 },
        encoding: { y, x: { ...x, field: 'low' }, x2: { field: 'high' }, color: hue },
      },
      ...['low', 'high'].map(
        (field): Spec => ({
          data: { values: known },
          mark: { type: 'tick', thickness: 2, size: 9 },
          encoding: { y, x: { ...x, field }, color: hue },
        }),
      ),
      {
        data: { values: means },
        mark: { type: 'point', filled: true, size: 62, opacity: 1, stroke: 'var(--ground)', strokeWidth: 1 },
        encoding: { y, x: { ...x, field: 'mean' }, color: hue, shape, tooltip },
      },
    ],
  };
}

const zeroLine = (x: Spec): Spec => ({
  data: { values: [{ zero: 0 }] },
  mark: { type: 'rule', stroke: 'var(--text)', strokeWidth: 1, opacity: 0.7 },
  encoding: { x: { ...x, field: 'zero' } },
});

function domainOf(options: DotsOptions, list: DotsOptions['panels']): [number, number] {
  const values = list.flatMap((panel) => [
    ...panel.means.flatMap((row) => [num(row[options.mean]), num(row[options.low]), num(row[options.high])]),
    ...(panel.points ?? []).map((row) => num(row[options.point ?? ''])),
  ]);
  const [least, most] = extent(values, options.zero);
  if (options.log) return [least / 1.04, most * 1.04];
  const margin = 0.03 * (most - least); // so that marks at the ends are whole
  const low = options.zero && least === 0 ? 0 : least - margin;
  const [from, to] = options.possible ?? [-Infinity, Infinity];
  return [Math.max(low, from - margin), Math.min(most + margin, to + margin)];
}

// Room for the longest name, at most a third of a page.
const leftOf = ({ left, looks }: DotsOptions): number => left ?? Math.min(280, Math.max(104, ...looks.map(({ label }) => 6.5 * label.length)));

export function dots(options: DotsOptions, width: number): Spec {
  const shared = domainOf(options, options.panels);
  return panels(options.panels.length, width, { left: leftOf(options), min: 124, gap: 26, rowGap: options.ownScales ? 70 : 48, first: options.first }, (i, place) => {
    const panel = options.panels[i];
    return panel ? layers(options, panel, place, options.ownScales ? domainOf(options, [panel]) : shared) : {};
  });
}
