// Forecasts beside what happened.
import type { Spec } from '../chart';
import { type Row, num } from '../document';
import { panels } from '../panels';
import { type Study, rowsOf } from '../study';
import { formatNumber } from '../words';
import { dots } from './dots';
import type { Figure } from './figure';
import { range } from './gist';
import { reliability } from './reliability';

function calibrationSpec(rows: Row[], ahead: number[], width: number): Spec {
  return panels(ahead.length, width, { left: 52, min: 170, max: 3, gap: 22, rowGap: 54 }, (i, place) => ({
    title: `After ${ahead[i] === 1 ? 'one more period' : `${String(ahead[i])} more periods`}`,
    ...reliability(place, {
      rows: rows.filter((row) => num(row.within) === ahead[i]),
      x: { field: 'forecast', title: place.lastRow ? 'Forecast probability' : null, name: 'Forecast' },
      y: { field: 'share', title: 'Share of teams done', name: 'Share done' },
      limits: ['low', 'high'],
      count: 'Forecasts',
      height: 170,
    }),
  }));
}

function calibrationFigures(study: Study): Figure[] {
  const table = study.table('forecast_calibration');
  if (!table) return [];
  const rows = rowsOf(table);
  const ahead = [...new Set(rows.map((row) => num(row.within) ?? 0))];
  const title = 'Calibration of the forecasts after each period';
  const off = rows.map((row) => Math.abs((num(row.forecast) ?? 0) - (num(row.share) ?? 0)));
  return [
    {
      id: 'forecast-calibration',
      title,
      reading:
        'Points on the diagonal are forecasts that came true as often as they said. Forecasts are grouped by tenths of probability, with Wilson\u2019s 95\u00a0% intervals, which are somewhat too short because the periods of a team depend on each other.',
      gist: `${title}. Largest difference between forecast and share: ${formatNumber(Math.max(0, ...off))}.`,
      table,
      spec: (width) => calibrationSpec(rows, ahead, width),
    },
  ];
}

function periodFigures(study: Study): Figure[] {
  const table = study.table('forecasts');
  if (!table) return [];
  const rows = study.rows(table);
  const title = 'Periods as forecast before the first lesson';
  const name = (row: Row): string => `${study.words.strategy(row.strategy)}, ${String(row.composition)}`;
  return [
    {
      id: 'forecast-periods',
      title,
      reading:
        'Marks are means of the forecast with its central 80\u00a0%. The data have the means of the teams and the share of teams within that range, which should be about 80\u00a0% (more where periods take few values).',
      gist: `${title}. Share of teams within the central 80\u00a0%: ${range(rows, 'within', name)}`,
      table,
      spec: (width) =>
        dots(
          {
            ...study.panelsBy('composition', rows),
            mean: 'forecast_mean',
            low: 'forecast_low',
            high: 'forecast_high',
            xTitle: 'Periods',
            interval: '80 %',
            zero: true,
          },
          width,
        ),
    },
  ];
}

export const forecastFigures = (study: Study): Figure[] => [...periodFigures(study), ...calibrationFigures(study)];
