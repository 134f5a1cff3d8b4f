// A reliability diagram: what was said to be probable, and how often it came true.
import type { Spec } from '../chart';
import { type Row, num } from '../document';
import { type Place, yAxis } from '../panels';

interface Axis {
  field: string; // of the rows
  title: string | null; // of the axis; null: none
  name: string; // of the value in tooltips
}

interface Reliability {
  rows: Row[];
  x: Axis;
  y: Axis;
  limits: [string, string]; // columns of the interval about y
  count: string; // what n counts
  height: number;
}

export function reliability(place: Place, { rows, x, y, limits, count, height }: Reliability): Spec {
  const values = rows.map((row) => ({
    [x.field]: num(row[x.field]),
    [y.field]: num(row[y.field]),
    low: num(row[limits[0]]),
    high: num(row[limits[1]]),
    n: num(row.n),
  }));
  const scale: Spec = { domain: [0, 1], nice: false };
  const across: Spec = { field: x.field, type: 'quantitative', scale, axis: { title: x.title, grid: false, labelFlush: false, tickCount: 5 } };
  const up: Spec = { type: 'quantitative', scale, axis: yAxis(place, { title: y.title, domain: false, tickCount: 5 }, true) };
  const diagonal = [0, 1].map((p) => ({ [x.field]: p, [y.field]: p }));
  return {
    data: { values },
    width: place.width,
    height,
    layer: [
      {
        data: { values: diagonal },
        mark: { type: 'line', stroke: 'var(--text)', strokeWidth: 1, strokeDash: [4, 3], opacity: 0.6 },
        encoding: { x: across, y: { ...up, field: y.field } },
      },
      {
        mark: { type: 'rule', stroke: 'var(--text)', strokeWidth: 1.2, opacity: 0.7 },
        encoding: { x: across, y: { ...up, field: 'low' }, y2: { field: 'high' } },
      },
      {
        mark: { type: 'point', filled: true, fill: 'var(--text)', size: 46, opacity: 1 },
        encoding: {
          x: across,
          y: { ...up, field: y.field },
          tooltip: [
            { field: x.field, title: x.name, format: '.2~f' },
            { field: y.field, title: y.name, format: '.2~f' },
            { field: 'n', title: count },
          ],
        },
      },
    ],
  };
}
