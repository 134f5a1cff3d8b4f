// Knowledge, or the share right where the exam leads, against items shown: which strategies are on the efficiency front.
import type { Spec } from '../chart';
import { type Row, num } from '../document';
import { strategyLegend } from '../legend';
import { extent, panels, roundTicks, yAxis } from '../panels';
import type { Study } from '../study';
import type { Figure } from './figure';

// What counts: its column, its name on an axis, and in a sentence.
interface Known {
  column: string;
  name: string;
  reading: string;
}

function knownOf(study: Study): Known {
  return study.report.overview.leads === 'exam'
    ? { column: 'share_right', name: 'Share right', reading: 'as large a share right' }
    : { column: 'knowledge', name: 'Knowledge', reading: 'as much knowledge' };
}

// Of an interval, what a share can be.
const asShare = (value: number | null): number | null => (value === null ? null : Math.min(1, Math.max(0, value)));

function spec(study: Study, rows: Row[], known: Known, width: number): Spec {
  const looks = study.looks(rows);
  const labels = looks.map((look) => look.label);
  const scale = (range: (string | number)[]): Spec => ({ domain: labels, range });
  const facets = study.facets(rows, 'composition');
  const ends = (name: string): (number | null)[] =>
    rows.flatMap((row) => [num(row[name]), num(row[`${name}_low`]), num(row[`${name}_high`])]);
  const xs = roundTicks(extent(ends('items').map((value) => value && Math.max(0, value))));
  const ys = roundTicks(extent(ends(known.column).map(asShare)));
  const grid = { left: 52, min: 190, max: 2, gap: 22, rowGap: 54 };
  const concat = panels(facets.length, width, grid, (i, place) => {
    const values = (facets[i]?.rows ?? []).map((row) => ({
        strategy: study.words.strategy(row.strategy),
        items: num(row.items),
        itemsLow: Math.max(0, num(row.items_low) ?? NaN),
        itemsHigh: num(row.items_high),
        known: num(row[known.column]),
        knownLow: asShare(num(row[`${known.column}_low`])),
        knownHigh: asShare(num(row[`${known.column}_high`])),
        front: row.on_front === true,
        share: num(row.front_share),
    }));
    const x: Spec = {
      type: 'quantitative',
      scale: { domain: xs.domain, zero: false, nice: false },
      axis: { title: place.lastRow ? 'Demonstrations and tests' : null, grid: false, labelFlush: false, tickCount: 5 },
    };
    const y: Spec = {
      type: 'quantitative',
      scale: { domain: ys.domain, zero: false, nice: false },
      axis: yAxis(place, { title: known.name, values: ys.values, domain: false, format: '.3~f' }, true),
    };
    const color: Spec = {
      field: 'strategy',
      type: 'nominal',
      scale: scale(looks.map((look) => look.color)),
      legend: null,
    };
    const shape: Spec = {
      field: 'strategy',
      type: 'nominal',
      scale: scale(looks.map((look) => look.shape)),
      legend: null,
    };
    const rule = (filter: string, encoding: Spec): Spec => ({
      transform: [{ filter }],
      mark: { type: 'rule', strokeWidth: 1.2, opacity: 0.7 },
      encoding: { ...encoding, color },
    });
    const tooltip = [
      { field: 'strategy', title: 'Strategy' },
      { field: 'items', title: 'Items shown', format: '.3~r' },
      { field: 'known', title: known.name, format: '.3~r' },
      { field: 'share', title: 'On the front, share of samples', format: '.2~r' },
    ];
    return {
      title: facets[i]?.title ?? '',
      data: { values },
      width: place.width,
      height: 190,
      layer: [
        {
          transform: [{ filter: 'datum.front' }],
          mark: { type: 'line', stroke: 'var(--text)', strokeWidth: 1, strokeDash: [4, 3], opacity: 0.6 },
          encoding: { x: { ...x, field: 'items' }, y: { ...y, field: 'known' } },
        },
        rule('isValid(datum.itemsLow)', {
          x: { ...x, field: 'itemsLow' },
          x2: { field: 'itemsHigh' },
          y: { ...y, field: 'known' },
        }),
        rule('isValid(datum.knownLow)', {
          x: { ...x, field: 'items' },
          y: { ...y, field: 'knownLow' },
          y2: { field: 'knownHigh' },
        }),
        {
          mark: { type: 'point', filled: true, size: 62, opacity: 1, stroke: 'var(--ground)', strokeWidth: 1 },
          encoding: { x: { ...x, field: 'items' }, y: { ...y, field: 'known' }, color, shape, tooltip },
        },
      ],
    };
  });
  return { ...concat, usermeta: { legend: strategyLegend(looks, width - 60, 'mark') } };
}

export function frontFigures(study: Study): Figure[] {
  const table = study.table('efficiency');
  if (!table) return [];
  const rows = study.rows(table);
  const known = knownOf(study);
  const title = `Efficiency: ${known.name.toLowerCase()} and items shown`;
  const fronts = study.facets(rows, 'composition').map(({ title: code, rows: own }) => {
    const names = own.filter((row) => row.on_front === true).map((row) => study.words.strategy(row.strategy));
    return `${code}: ${names.join(', ')}`;
  });
  return [
    {
      id: 'efficiency',
      title,
      reading: `Higher and further left is better. The broken line joins the strategies of the efficiency front: no other strategy leads to ${known.reading} with fewer demonstrations and tests. Means with 95\u00a0% t intervals; the data say how often a strategy is on the front in bootstrap samples.`,
      gist: `${title}. On the front: ${fronts.join('; ')}.`,
      table,
      spec: (width) => spec(study, rows, known, width),
    },
  ];
}
