// The manipulation check: how much do the demonstrations of a strategy convey?
import type { Cell, Row } from '../document';
import type { Study } from '../study';
import { dots } from './dots';
import type { Figure } from './figure';
import { counted, range } from './gist';

export function areaFigures(study: Study): Figure[] {
  const table = study.table('area');
  if (!table) return [];
  const area = (cell: Cell | undefined): number | null => (typeof cell === 'number' ? Math.exp(cell) : null);
  const rows = study.rows(table).map(
    (row): Row => ({ ...row, area: area(row.mean_log_area), low: area(row.low), high: area(row.high) }),
  );
  const title = 'Area that the demonstrations leave, by strategy and component';
  return [
    {
      id: 'area-component',
      title,
      reading:
        `Points further left convey more: a smaller area means that fewer rewards are possible. Geometric mean of the area per period in steradians on a logarithmic scale, the first period of a component left out, with 95\u00a0% t intervals. ${counted(rows, 'n', 'teams')}`,
      gist: `${title}. Mean area in steradians: ${range(rows, 'area', (row) => `${study.words.strategy(row.strategy)}, component ${String(row.kc)}`)}`,
      table,
      spec: (width) =>
        dots(
          {
            ...study.panelsBy('kc', rows),
            mean: 'area',
            low: 'low',
            high: 'high',
            xTitle: 'Area left (sr, log scale)',
            zero: false,
            log: true,
          },
          width,
        ),
    },
  ];
}
