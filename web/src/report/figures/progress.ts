// What changes from period to period: completion, knowledge and right answers.
import type { Row, Table } from '../document';
import { type Study, rowsOf } from '../study';
import { type CurvesOptions, curves } from './curves';
import type { Figure } from './figure';
import { counted, ends } from './gist';

type Words = Pick<Figure, 'id' | 'title' | 'reading'>;
type Shape = Pick<CurvesOptions, 'x' | 'y' | 'xTitle' | 'yTitle' | 'step'> & Partial<CurvesOptions>;

function figure(
  study: Study,
  table: Table,
  words: Words,
  shape: Shape,
  groups: (rows: Row[]) => CurvesOptions['panels'],
): Figure {
  const rows = study.rows(table);
  const list = groups(rows);
  const strategyOf = (row: Row): string => study.words.strategy(row.strategy);
  const gists = list.map(({ title, rows: own }) => `${title}: ${ends(own, shape.x, shape.y, strategyOf)}`);
  return {
    ...words,
    gist: `${words.title}. ${gists.join(' ')}`,
    table,
    spec: (width) => curves({ looks: study.looks(rows), panels: list, strategyOf, ...shape }, width),
  };
}

export function completionFigures(study: Study): Figure[] {
  const table = study.table('completion');
  if (!table || study.hasFixedPeriods) return [];
  return [
    figure(
      study,
      table,
      {
        id: 'completion',
        title: `Share of teams that ${study.report.overview.done ?? 'passed all tests'}`,
        reading:
          `Curves that are steeper and further left are faster. One minus the Kaplan-Meier estimate; bars are 95\u00a0% intervals with Greenwood\u2019s variance, each at some periods only, so that they do not cover each other. For the baseline, periods are summed over members. ${counted(rowsOf(table).filter((row) => row.period === 0), 'at_risk', 'teams in a cell')} ${study.words.letters()}`,
      },
      {
        x: 'period',
        y: 'done',
        xTitle: 'Period',
        yTitle: 'Share of teams done',
        step: true,
        yDomain: [0, 1],
        maxColumns: 2,
      },
      (rows) => study.facets(rows, 'composition'),
    ),
  ];
}

export function knowledgeFigures(study: Study): Figure[] {
  const table = study.table('knowledge_by_period');
  if (!table) return [];
  return [
    figure(
      study,
      table,
      {
        id: 'knowledge-periods',
        title: 'Knowledge over periods by type of learner',
        reading:
          `Share of a person\u2019s belief in the policy\u2019s region (BEC), means with 95\u00a0% t intervals at some periods. People who are no longer taught count with what they knew last. Lines end where too few people are still taught. ${counted(rowsOf(table), 'people', 'people')}`,
      },
      { x: 'period', y: 'mean', xTitle: 'Period', yTitle: 'Knowledge', step: false, possible: [0, 1] },
      (rows) => study.facets(rows, 'type'),
    ),
  ];
}

export function correctFigures(study: Study): Figure[] {
  const table = study.table('correct_by_period');
  if (!table) return [];
  return [
    figure(
      study,
      table,
      {
        id: 'correct-periods',
        title: 'Right answers over periods by type of learner',
        reading:
          `Only teams that are still being taught: later periods include only those that needed longest. Share of test answers that were right, with Wilson\u2019s 95\u00a0% intervals at some periods. ${counted(rowsOf(table), 'answers', 'answers')}`,
      },
      { x: 'period', y: 'share', xTitle: 'Period', yTitle: 'Share of right answers', step: false, possible: [0, 1] },
      (rows) => study.facets(rows, 'type'),
    ),
  ];
}
