// What the teacher can tell about people, beside the truth.
import type { Spec } from '../chart';
import { type Row, num } from '../document';
import { panels } from '../panels';
import { type Study, rowsOf } from '../study';
import { formatNumber } from '../words';
import type { Figure } from './figure';
import { reliability } from './reliability';

function masterySpec(rows: Row[], width: number): Spec {
  return panels(1, width, { left: 52, min: 170, max: 1, gap: 22, rowGap: 54 }, (_, place) =>
    reliability(place, {
      rows,
      x: { field: 'predicted', title: 'Predicted probability of mastery', name: 'Predicted' },
      y: { field: 'actual', title: 'True probability', name: 'True' },
      limits: ['actual_low', 'actual_high'],
      count: 'Periods',
      height: 220,
    }),
  );
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
