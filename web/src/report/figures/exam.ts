// What the exam says after every period, against what teaching had taken by then.
import type { Row } from '../document';
import { type Study, rowsOf } from '../study';
import { curves } from './curves';
import type { Figure } from './figure';
import { ends } from './gist';

const kCosts = [
  { x: 'period', title: 'Against periods', xTitle: 'Periods' },
  { x: 'items', title: 'Against items shown', xTitle: 'Demonstrations and tests' },
  { x: 'minutes', title: 'Against teaching time', xTitle: 'Teaching minutes' },
  { x: 'person_minutes', title: 'Against the members\u2019 time', xTitle: 'Person minutes' },
];

const kCurves: { id: string; y: string; title: string; yTitle: string; possible: [number, number]; reading: string }[] = [
  {
    id: 'exam-regret',
    y: 'regret',
    title: 'Regret against what teaching took',
    yTitle: 'Regret',
    possible: [0, Infinity],
    reading: 'Curves that are lower and further left are better.',
  },
  {
    id: 'exam-knowledge',
    y: 'knowledge',
    title: 'Knowledge against what teaching took',
    yTitle: 'Knowledge',
    possible: [0, 1],
    reading: 'Curves that are higher and further left are better.',
  },
];

export function examCurveFigures(study: Study): Figure[] {
  const table = study.table('exam_by_period');
  if (!table) return [];
  const rows = rowsOf(table);
  const strategyOf = (row: Row): string => study.words.strategy(row.strategy);
  return kCurves.map(({ id, y, title, yTitle, possible, reading }) => ({
    id,
    title,
    reading: `${reading} Means over teams with 95\u00a0% t intervals at some points; teams that have ended stay as they are. Minutes follow the study\u2019s pace.`,
    gist: `${title}. ${ends(rows, 'period', y, strategyOf)}`,
    table,
    spec: (width) =>
      curves(
        {
          looks: study.looks(rows),
          panels: kCosts.map((cost) => ({ ...cost, rows })),
          x: 'period',
          y,
          low: `${y}_low`,
          high: `${y}_high`,
          xTitle: 'Periods',
          yTitle,
          possible,
          step: false,
          strategyOf,
          maxColumns: 2,
        },
        width,
      ),
  }));
}
