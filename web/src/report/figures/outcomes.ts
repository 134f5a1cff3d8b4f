// Periods and knowledge by strategy and composition: means, intervals and every team.
import type { Row } from '../document';
import { type Study, rowsOf } from '../study';
import { dots } from './dots';
import type { Figure } from './figure';
import { range } from './gist';

interface Outcome {
  id: string;
  column: 'periods' | 'knowledge';
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

export function outcomeFigures(study: Study): Figure[] {
  const cells = study.table('cells');
  if (!cells) return [];
  const means = rowsOf(cells);
  const teams = study.table('teams');
  const points = teams ? rowsOf(teams) : [];
  const looks = study.looks(means);
  const within = (rows: Row[], composition: string): Row[] => rows.filter((row) => row.composition === composition);
  const name = (row: Row): string => `${study.words.strategy(row.strategy)}, ${String(row.composition)}`;
  return kOutcomes.map(({ id, column, title, xTitle, reading }) => ({
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
          zero: true,
          strategyOf: (row) => study.words.strategy(row.strategy),
        },
        width,
      ),
  }));
}
