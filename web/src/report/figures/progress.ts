// What changes from period to period: completion, knowledge, ability and right answers.
import type { Row, Table } from '../document';
import { type Study, componentName, rowsOf } from '../study';
import { type CurvesOptions, curves } from './curves';
import type { Figure } from './figure';
import { ends } from './gist';

type Words = Pick<Figure, 'id' | 'title' | 'reading'>;
type Shape = Pick<CurvesOptions, 'x' | 'y' | 'xTitle' | 'yTitle' | 'step'> & Partial<CurvesOptions>;

function figure(
  study: Study,
  table: Table,
  words: Words,
  shape: Shape,
  groups: (rows: Row[]) => CurvesOptions['panels'],
): Figure {
  const rows = rowsOf(table);
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
  if (!table) return [];
  return [
    figure(
      study,
      table,
      {
        id: 'completion',
        title: 'Share of teams that have learned everything',
        reading:
          'Curves that are steeper and further left are faster. One minus the Kaplan-Meier estimate with 95\u00a0% bands. For the baseline, periods are summed over members.',
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
      (rows) =>
        study.compositions(rows).map((code) => ({ title: code, rows: rows.filter((row) => row.composition === code) })),
    ),
  ];
}

const byType =
  (study: Study) =>
  (rows: Row[]): CurvesOptions['panels'] =>
    study
      .types(rows)
      .map((type) => ({ title: study.words.type(type), rows: rows.filter((row) => String(row.type) === type) }));

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
          'Share of a person\u2019s belief in the policy\u2019s region (BEC), means with 95\u00a0% bands. Lines end where too few people are still being taught.',
      },
      { x: 'period', y: 'mean', xTitle: 'Period', yTitle: 'Knowledge', step: false },
      byType(study),
    ),
  ];
}

export function abilityFigures(study: Study): Figure[] {
  const table = study.table('ability_by_period');
  if (!table) return [];
  return [
    figure(
      study,
      table,
      {
        id: 'ability-periods',
        title: 'Learning ability over the periods of a component',
        reading:
          'Ability while watching, mean with 95\u00a0% bands; it is reset at the start of every component and rises with feedback.',
      },
      { x: 'period_of_kc', y: 'mean', xTitle: 'Period of the component', yTitle: 'Ability', step: false },
      (rows) =>
        study
          .types(rows)
          .flatMap((type) =>
            study.codes(rows, 'kc').map((kc) => ({
              title: `${study.words.type(type)}, ${componentName(kc).toLowerCase()}`,
              rows: rows.filter((row) => String(row.type) === type && String(row.kc) === kc),
            })),
          )
          .filter((panel) => panel.rows.length > 0),
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
          'Share of test answers that were right, with 95\u00a0% bands; later periods include only the teams that needed longest.',
      },
      { x: 'period', y: 'share', xTitle: 'Period', yTitle: 'Share of right answers', step: false },
      byType(study),
    ),
  ];
}
