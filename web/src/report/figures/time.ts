// Where teaching time goes: periods per component.
import type { Spec } from '../chart';
import { type Row, num } from '../document';
import { extent, panels, yAxis } from '../panels';
import { type Study, componentName } from '../study';
import { color } from '../../shared/theme';
import type { Figure } from './figure';
import { range } from './gist';

// Components are ordered, so their shades run from light to dark.
const shades = (count: number): string[] => Array.from({ length: count }, (_, i) => color(`k${i % 6}`));

function teachingSpec(study: Study, rows: Row[], width: number): Spec {
  const facets = study.facets(rows, 'composition');
  const components = study.codes(rows, 'kc');
  const strategies = study.looks(rows).map((look) => look.label);
  const totals = new Map<string, number>();
  for (const row of rows) {
    const key = `${String(row.strategy)} ${String(row.composition)} ${String(row.setting)}`;
    totals.set(key, (totals.get(key) ?? 0) + (num(row.mean_periods) ?? 0));
  }
  const domain = extent([...totals.values()], true);
  const names = components.map(componentName);
  return panels(facets.length, width, { left: 104, min: 124, gap: 26 }, (i, place) => ({
    title: facets[i]?.title ?? '',
    width: place.width,
    height: strategies.length * 26,
    data: {
      values: (facets[i]?.rows ?? []).map((row) => ({
        strategy: study.words.strategy(row.strategy),
        component: componentName(String(row.kc)),
        order: components.indexOf(String(row.kc)),
        periods: num(row.mean_periods),
      })),
    },
    mark: { type: 'bar', stroke: color('ground'), strokeWidth: 1.5 },
    encoding: {
      y: {
        field: 'strategy',
        type: 'nominal',
        scale: { domain: strategies, paddingInner: 0.3 },
        axis: yAxis(place, {
          title: null,
          ticks: false,
          domain: false,
          labelFontSize: 12,
          labelColor: color('text'),
          labelLimit: 116,
          labelPadding: 6,
        }),
      },
      x: {
        field: 'periods',
        type: 'quantitative',
        stack: true,
        scale: { domain, nice: true },
        axis: {
          title: place.lastRow ? 'Periods, mean' : null,
          domain: false,
          labelFlush: false,
          tickCount: Math.max(3, Math.floor(place.width / 45)),
        },
      },
      order: { field: 'order', type: 'quantitative' },
      color: {
        field: 'component',
        type: 'nominal',
        scale: { domain: names, range: shades(names.length) },
        legend: {
          title: null,
          symbolType: 'square',
          columns: Math.max(1, Math.min(names.length, Math.floor(width / 120))),
        },
      },
      tooltip: [
        { field: 'strategy', title: 'Strategy' },
        { field: 'component', title: 'Part' },
        { field: 'periods', title: 'Periods, mean', format: '.3~r' },
      ],
    },
  }));
}

export function timeFigures(study: Study): Figure[] {
  const table = study.table('periods_by_component');
  if (!table) return [];
  const rows = study.rows(table);
  const title = 'Where teaching time goes';
  return [
    {
      id: 'time-components',
      title,
      reading:
        `Mean periods spent on each component; the length of a bar is the mean number of periods of a team. Intervals are in the data. ${study.words.letters()}`,
      gist: `${title}. Mean periods of one component: ${range(rows, 'mean_periods', (row) => `${study.words.strategy(row.strategy)}, ${String(row.composition)}, component ${String(row.kc)}`)}`,
      table,
      spec: (width) => teachingSpec(study, rows, width),
    },
  ];
}
