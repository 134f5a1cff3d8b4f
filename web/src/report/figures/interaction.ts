// Interaction plots: do the lines of the strategies run side by side over the compositions? The
// baseline's periods have their own panel, since it counts the sum over members and its size would
// press the others flat.
import type { Spec } from '../chart';
import { type Row, num } from '../document';
import { strategyLegend } from '../legend';
import type { Look } from '../palette';
import { extent, panels, roundTicks } from '../panels';
import { type Study, rowsOf } from '../study';
import type { Figure } from './figure';
import { counted, range } from './gist';

interface Panel {
  title: string;
  column: string;
  rows: Row[];
}

// An interval of shares ends where shares do.
const possible = ({ column }: Panel, value: number | null): number | null =>
  value === null || column !== 'knowledge' ? value : Math.min(1, Math.max(0, value));

function panelsOf(rows: Row[], hasFixedPeriods: boolean): Panel[] {
  const group = rows.filter((row) => row.strategy !== 'baseline');
  const baseline = rows.filter((row) => row.strategy === 'baseline');
  return [
    { title: 'Periods, group strategies', column: 'periods', rows: group },
    { title: 'Periods, baseline', column: 'periods', rows: baseline },
    { title: 'Knowledge', column: 'knowledge', rows },
  ].filter((panel) => panel.rows.length > 0 && !(hasFixedPeriods && panel.column === 'periods'));
}

function spec(study: Study, list: Panel[], compositions: string[], looks: Look[], width: number): Spec {
  const labels = looks.map((look) => look.label);
  const scale = (range: (string | number[])[]): Spec => ({ domain: labels, range });
  const legend = strategyLegend(looks, width - 60, 'mark');
  return {
    ...panels(list.length, width, { left: 46, min: 170, gap: 58, rowGap: 64 }, (i, place) => {
      const panel = list[i];
      if (!panel) return {};
      const local = study.looks(panel.rows);
      const values = panel.rows.map((row) => {
        const strategy = study.words.strategy(row.strategy);
        // Side by side within a composition, so that intervals do not cover each other.
        const aside = (local.findIndex((look) => look.label === strategy) - (local.length - 1) / 2) * 0.09;
        const at = compositions.indexOf(String(row.composition));
        return {
          strategy,
          at: at + aside,
          composition: String(row.composition),
          mean: num(row[`${panel.column}_mean`]),
          low: possible(panel, num(row[`${panel.column}_low`])),
          high: possible(panel, num(row[`${panel.column}_high`])),
        };
      });
      const { domain, values: ticks } = roundTicks(extent(values.flatMap((row) => [row.mean, row.low, row.high])));
      const x: Spec = {
        field: 'at',
        type: 'quantitative',
        scale: { domain: [-0.4, compositions.length - 0.6], nice: false },
        axis: {
          title: place.lastRow ? 'Composition' : null,
          values: compositions.map((_, k) => k),
          labelExpr: `${JSON.stringify(compositions)}[datum.value]`,
          grid: false,
          labelOverlap: false,
        },
      };
      const y: Spec = {
        type: 'quantitative',
        scale: { domain, zero: false, nice: false },
        axis: { title: null, domain: false, values: ticks, format: '.6~f' },
      };
      const color: Spec = {
        field: 'strategy',
        type: 'nominal',
        scale: scale(looks.map((look) => look.color)),
        legend: null,
      };
      const tooltip = [
        { field: 'strategy', title: 'Strategy' },
        { field: 'composition', title: 'Composition' },
        { field: 'mean', title: panel.title, format: '.3~r' },
        { field: 'low', title: '95 % from', format: '.3~r' },
        { field: 'high', title: 'to', format: '.3~r' },
      ];
      return {
        title: panel.title,
        data: { values },
        width: place.width,
        height: 190,
        layer: [
          {
            transform: [{ filter: 'isValid(datum.low) && isValid(datum.high)' }],
            mark: { type: 'rule', strokeWidth: 1.2, opacity: 0.7 },
            encoding: { x, y: { ...y, field: 'low' }, y2: { field: 'high' }, color },
          },
          {
            mark: { type: 'line', strokeWidth: 1.8 },
            encoding: {
              x,
              y: { ...y, field: 'mean' },
              color,
              strokeDash: {
                field: 'strategy',
                type: 'nominal',
                scale: scale(looks.map((look) => look.dash)),
                legend: null,
              },
            },
          },
          {
            mark: { type: 'point', filled: true, size: 60, opacity: 1 },
            encoding: {
              x,
              y: { ...y, field: 'mean' },
              color,
              shape: {
                field: 'strategy',
                type: 'nominal',
                scale: scale(looks.map((look) => look.shape)),
                legend: null,
              },
              tooltip,
            },
          },
        ],
      };
    }),
    usermeta: { legend },
  };
}

export function interactionFigures(study: Study): Figure[] {
  const cells = study.table('cells');
  if (!cells) return [];
  const rows = rowsOf(cells);
  const compositions = study.compositions(rows);
  if (compositions.length < 2) return [];
  const title = 'Interaction of strategy and composition';
  const name = (row: Row): string => `${study.words.strategy(row.strategy)}, ${String(row.composition)}`;
  return [
    {
      id: 'interaction',
      title,
      reading:
        `Parallel lines mean that a strategy\u2019s advantage does not depend on who is in the team. Every panel has a scale of its own, which does not begin at 0. Bars are 95\u00a0% t intervals. ${counted(rows, 'teams', 'teams in a cell')} ${study.words.letters()}`,
      gist: `${title}. Mean periods: ${range(rows, 'periods_mean', name)} Mean knowledge: ${range(rows, 'knowledge_mean', name)}`,
      table: cells,
      spec: (width) => spec(study, panelsOf(rows, study.hasFixedPeriods), compositions, study.looks(rows), width),
    },
  ];
}
