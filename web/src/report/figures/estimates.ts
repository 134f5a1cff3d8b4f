// What the teacher can tell about people, beside the truth.
import type { Spec } from '../chart';
import { type Row, num } from '../document';
import { panels, yAxis } from '../panels';
import { type Study, rowsOf } from '../study';
import { formatNumber } from '../words';
import type { Figure } from './figure';

function masterySpec(rows: Row[], width: number): Spec {
  return panels(1, width, { left: 52, min: 170, max: 1, gap: 22, rowGap: 54 }, (_, place) => {
    const values = rows.map((row) => ({
      predicted: num(row.predicted),
      actual: num(row.actual),
      low: num(row.actual_low),
      high: num(row.actual_high),
      n: num(row.n),
    }));
    const scale: Spec = { domain: [0, 1], nice: false };
    const x: Spec = {
      type: 'quantitative',
      scale,
      axis: { title: 'Predicted probability of mastery', grid: false, labelFlush: false, tickCount: 5 },
    };
    const y: Spec = {
      type: 'quantitative',
      scale,
      axis: yAxis(place, { title: 'True probability', domain: false, tickCount: 5 }, true),
    };
    return {
      data: { values },
      width: place.width,
      height: 220,
      layer: [
        {
          data: {
            values: [
              { predicted: 0, actual: 0 },
              { predicted: 1, actual: 1 },
            ],
          },
          mark: { type: 'line', stroke: 'var(--text)', strokeWidth: 1, strokeDash: [4, 3], opacity: 0.6 },
          encoding: { x: { ...x, field: 'predicted' }, y: { ...y, field: 'actual' } },
        },
        {
          mark: { type: 'rule', stroke: 'var(--text)', strokeWidth: 1.2, opacity: 0.7 },
          encoding: { x: { ...x, field: 'predicted' }, y: { ...y, field: 'low' }, y2: { field: 'high' } },
        },
        {
          mark: { type: 'point', filled: true, fill: 'var(--text)', size: 46, opacity: 1 },
          encoding: {
            x: { ...x, field: 'predicted' },
            y: { ...y, field: 'actual' },
            tooltip: [
              { field: 'predicted', title: 'Predicted', format: '.2~f' },
              { field: 'actual', title: 'True', format: '.2~f' },
              { field: 'n', title: 'Periods' },
            ],
          },
        },
      ],
    };
  });
}

export function estimateFigures(study: Study): Figure[] {
  const table = study.table('mastery_calibration');
  if (!table) return [];
  const rows = rowsOf(table);
  const title = 'Calibration of the predicted mastery';
  const off = rows.map((row) => Math.abs((num(row.predicted) ?? 0) - (num(row.actual) ?? 0)));
  return [
    {
      id: 'mastery-calibration',
      title,
      reading:
        'The probability that everybody present answers a random test of the component correctly after a period: as the teacher predicts it from the answers, and under what people really believe. Points on the diagonal are correct predictions. Periods are grouped by tenths of the prediction, with 95\u00a0% intervals of the mean, which are somewhat too short because the periods of a team depend on each other.',
      gist: `${title}. Largest difference between predicted and true probability: ${formatNumber(Math.max(0, ...off))}.`,
      table,
      spec: (width) => masterySpec(rows, width),
    },
  ];
}
