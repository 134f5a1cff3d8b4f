// Outcomes by strategy and composition: means, intervals and every team.
import type { Row } from '../document';
import { type Study, rowsOf } from '../study';
import { dots } from './dots';
import type { Figure } from './figure';
import { range } from './gist';

interface Outcome {
  id: string;
  column: string; // of the table of teams; of that of cells with _mean, _low and _high
  title: string;
  xTitle: string;
  reading: string;
}

const kOutcomes: Outcome[] = [
  {
    id: 'periods',
    column: 'periods',
    title: 'Periods of teaching by strategy and composition',
    xTitle: 'Periods',
    reading:
      'Further left is faster. Large marks are means with 95\u00a0% intervals, small dots are individual teams. For the baseline, periods are summed over members.',
  },
  {
    id: 'knowledge',
    column: 'knowledge',
    title: 'Knowledge at the end by strategy and composition',
    xTitle: 'Knowledge',
    reading:
      'Further right is better. Knowledge is the share of belief in the policy\u2019s region (BEC). Large marks are means with 95\u00a0% intervals, small dots are individual teams.',
  },
];

const kExamOutcomes: Outcome[] = [
  {
    id: 'exam-regret-cells',
    column: 'exam_regret',
    title: 'Regret in the exam by strategy and composition',
    xTitle: 'Regret',
    reading:
      'Further left is better. Regret is what the members\u2019 predictions lose against the robot\u2019s paths over all starts. Large marks are means with 95\u00a0% intervals, small dots are individual teams.',
  },
  {
    id: 'exam-share-cells',
    column: 'exam_share_right',
    title: 'Share right in the exam by strategy and composition',
    xTitle: 'Share right',
    reading:
      'Further right is better: the share of all starts from which members predict the robot. Large marks are means with 95\u00a0% intervals, small dots are individual teams.',
  },
  {
    id: 'exam-worst-cells',
    column: 'exam_worst_share_right',
    title: 'Share right of the worst member by strategy and composition',
    xTitle: 'Share right of the worst member',
    reading:
      'Further right is better: the share right of the member who does worst in the exam. Large marks are means with 95\u00a0% intervals, small dots are individual teams.',
  },
];

export const outcomeFigures = (study: Study): Figure[] => figuresOf(study, kOutcomes);
export const examOutcomeFigures = (study: Study): Figure[] => figuresOf(study, kExamOutcomes);

function figuresOf(study: Study, outcomes: Outcome[]): Figure[] {
  const cells = study.table('cells');
  if (!cells) return [];
  const means = rowsOf(cells);
  const teams = study.table('teams');
  const points = teams ? rowsOf(teams) : [];
  const looks = study.looks(means);
  const within = (rows: Row[], composition: string): Row[] => rows.filter((row) => row.composition === composition);
  const name = (row: Row): string => `${study.words.strategy(row.strategy)}, ${String(row.composition)}`;
  const present = outcomes.filter(({ column }) => cells.columns.includes(`${column}_mean`));
  return present.map(({ id, column, title, xTitle, reading }) => ({
    id,
    title,
    reading,
    gist: `${title}. Means: ${range(means, `${column}_mean`, name)}`,
    table: cells,
    raw: teams ? { what: 'teams', table: teams } : undefined,
    spec: (width) =>
      dots(
        {
          looks,
          panels: study
            .compositions(means)
            .map((code) => ({ title: code, means: within(means, code), points: within(points, code) })),
          mean: `${column}_mean`,
          low: `${column}_low`,
          high: `${column}_high`,
          point: column,
          xTitle,
          zero: !column.includes('share_right'),
          strategyOf: (row) => study.words.strategy(row.strategy),
        },
        width,
      ),
  }));
}
