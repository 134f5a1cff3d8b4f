// Curves over periods, one line per strategy, one panel per group. The interval of a single line is a band; those of
// several would lie over each other, so that every line has bars at some of its points, none beside another's.
import type { Spec } from '../chart';
import { type Row, num } from '../document';
import type { Look } from '../palette';
import { strategyLegend } from '../legend';
import { type Place, extent, panels, roundTicks, wholeTicks, yAxis } from '../panels';

export interface CurvesOptions {
  looks: Look[];
  panels: { title: string; rows: Row[]; x?: string; xTitle?: string }[]; // some with an x of their own
  x: string;
  y: string;
  low?: string; // columns of the band; 'low' and 'high' unless said otherwise
  high?: string;
  xTitle: string;
  yTitle: string;
  yDomain?: [number, number];
  possible?: [number, number]; // what y can be: the axis and the intervals are cut there
  step: boolean; // holds its value until the next row
  strategyOf(row: Row): string;
  maxColumns?: number;
}

const xOf = (options: CurvesOptions, panel: CurvesOptions['panels'][number]): string => panel.x ?? options.x;

function layers(
  options: CurvesOptions,
  panel: CurvesOptions['panels'][number],
  place: Place,
  domains: { x: [number, number]; y: ReturnType<typeof roundTicks> },
): Spec {
  const labels = options.looks.map((look) => look.label);
  const xTitle = panel.xTitle ?? options.xTitle;
  const values = panel.rows.map((row) => ({
    strategy: options.strategyOf(row),
    x: num(row[xOf(options, panel)]),
    y: num(row[options.y]),
    low: num(row[options.low ?? 'low']),
    high: num(row[options.high ?? 'high']),
  }));
  const x: Spec = {
    field: 'x',
    type: 'quantitative',
    scale: { domain: domains.x, nice: false },
    axis: {
      title: place.lastRow || panel.xTitle ? xTitle : null,
      values: wholeTicks(domains.x, Math.floor(place.width / 36)),
      format: 'd',
      grid: false,
      labelFlush: false,
    },
  };
  const yScale: Spec = { domain: domains.y.domain, zero: false, nice: false };
  const y: Spec = {
    type: 'quantitative',
    scale: yScale,
    axis: yAxis(place, { title: options.yTitle, values: domains.y.values, domain: false, format: '.3~f' }, true),
  };
  const color: Spec = {
    field: 'strategy',
    type: 'nominal',
    scale: { domain: labels, range: options.looks.map((look) => look.color) },
    legend: null,
  };
  const dash: Spec = {
    field: 'strategy',
    type: 'nominal',
    scale: { domain: labels, range: options.looks.map((look) => look.dash) },
    legend: null,
  };
  const interpolate = options.step ? 'step-after' : 'linear';
  const tooltip = [
    { field: 'strategy', title: 'Strategy' },
    { field: 'x', title: xTitle, format: '.3~r' },
    { field: 'y', title: options.yTitle, format: '.3~r' },
    { field: 'low', title: '95 % from', format: '.3~r' },
    { field: 'high', title: 'to', format: '.3~r' },
  ];
  const shape: Spec = {
    field: 'strategy',
    type: 'nominal',
    scale: { domain: labels, range: options.looks.map((look) => look.shape) },
    legend: null,
  };
  const bars = barsOf(values, labels);
  const layer: Spec[] = [
    labels.length === 1
      ? {
          transform: [{ filter: 'isValid(datum.low) && isValid(datum.high)' }],
          mark: { type: 'area', fillOpacity: 0.14, interpolate, clip: true },
          encoding: { x, y: { ...y, field: 'low' }, y2: { field: 'high' }, color },
        }
      : {
          data: { values: bars },
          mark: { type: 'rule', strokeWidth: 1.4, opacity: 0.8, clip: true },
          encoding: { x, y: { ...y, field: 'low' }, y2: { field: 'high' }, color },
        },
    {
      mark: { type: 'line', strokeWidth: 2, interpolate, strokeJoin: 'round' },
      encoding: { x, y: { ...y, field: 'y' }, color, strokeDash: dash },
    },
    options.step
      ? {
          mark: { type: 'point', filled: true, size: 60, opacity: 0 },
          encoding: { x, y: { ...y, field: 'y' }, tooltip },
        } // for tooltips only
      : {
          mark: { type: 'point', filled: true, size: 36, opacity: 1 },
          encoding: { x, y: { ...y, field: 'y' }, color, shape, tooltip },
        },
  ];
  return { data: { values }, width: place.width, height: 190, layer };
}

interface Point extends Row {
  strategy: string;
  x: number | null;
}

// Of k lines every one has the bar at every k-th of its points, the next line at the next point.
function barsOf<T extends Point>(values: T[], labels: string[]): T[] {
  return labels.flatMap((label, i) => {
    const own = values.filter(({ strategy, low, high }) => strategy === label && low !== null && high !== null);
    const chosen = own.filter((_, k) => k % labels.length === i);
    return chosen.length > 0 ? chosen : own.slice(own.length >> 1, (own.length >> 1) + 1);
  });
}

export function curves(options: CurvesOptions, width: number): Spec {
  const all = options.panels.flatMap((panel) => panel.rows);
  const shared = extent(all.map((row) => num(row[options.x])));
  const [least, most] = options.possible ?? [-Infinity, Infinity];
  const shown = all
    .flatMap((row) => [num(row[options.y]), num(row[options.low ?? 'low']), num(row[options.high ?? 'high'])])
    .map((value) => value && Math.min(Math.max(value, least), most));
  const y = roundTicks(options.yDomain ?? extent(shown));
  const rowGap = options.panels.some((panel) => panel.xTitle) ? 76 : 54; // room for the titles of all x axes
  const legend = strategyLegend(options.looks, width - 60, options.step ? 'line' : 'mark');
  return {
    ...panels(
      options.panels.length,
      width,
      { left: 52, min: 190, max: options.maxColumns ?? 3, gap: 22, rowGap },
      (i, place) => {
        const panel = options.panels[i];
        if (!panel) return {};
        const x = panel.x ? extent(panel.rows.map((row) => num(row[panel.x ?? '']))) : shared;
        return { title: panel.title, ...layers(options, panel, place, { x, y }) };
      },
    ),
    usermeta: { legend },
  };
}
