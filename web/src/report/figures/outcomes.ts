// Outcomes by strategy and composition: means, intervals and every team.
import type { Spec } from '../chart';
import type { Row } from '../document';
import { stacked } from '../panels';
import { type Study, rowsOf } from '../study';
import { dots, type DotsOptions } from './dots';
import type { Figure } from './figure';
import { counted, range } from './gist';

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
      'Further left is faster. Large marks are means with 95\u00a0% t intervals, small dots are single teams.',
  },
  {
    id: 'knowledge',
    column: 'knowledge',
    title: 'Knowledge at the end by strategy and composition',
    xTitle: 'Knowledge',
    reading:
      'Further right is better. Knowledge is the share of belief in the policy\u2019s region (BEC). Large marks are means with 95\u00a0% t intervals, small dots are single teams.',
  },
];

const kExamOutcomes: Outcome[] = [
  {
    id: 'exam-regret-cells',
    column: 'exam_regret',
    title: 'Regret in the exam by strategy and composition',
    xTitle: 'Regret',
    reading:
      'Further left is better. Regret is what the members\u2019 predictions lose against the robot\u2019s paths over all starts. Large marks are means with 95\u00a0% t intervals, small dots are single teams.',
  },
  {
    id: 'exam-share-cells',
    column: 'exam_share_right',
    title: 'Share right in the exam by strategy and composition',
    xTitle: 'Share right',
    reading:
      'Further right is better: the share of all starts from which members predict the robot. Large marks are means with 95\u00a0% t intervals, small dots are single teams.',
  },
  {
    id: 'exam-worst-cells',
    column: 'exam_worst_share_right',
    title: 'Share right of the worst member by strategy and composition',
    xTitle: 'Share right of the worst member',
    reading:
      'Further right is better: the share right of the member who does worst in the exam. Large marks are means with 95\u00a0% t intervals, small dots are single teams.',
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
  const name = (row: Row): string => `${study.words.strategy(row.strategy)}, ${String(row.composition)}`;
  const n = counted(means, 'teams', 'teams in a cell');
  const isVaried = (column: string): boolean => column !== 'periods' || !study.hasFixedPeriods;
  const present = outcomes.filter(({ column }) => cells.columns.includes(`${column}_mean`) && isVaried(column));
  return present.map(({ id, column, title, xTitle, reading }) => ({
    id,
    title,
    reading: `${reading}${study.report.lessons && teams ? ' A click on a dot shows the team.' : ''}${column === 'periods' && hasTwoScales(means) ? kTwoScales : ''} ${n} ${study.words.letters()}`,
    gist: `${title}. Means: ${range(means, `${column}_mean`, name)}`,
    table: cells,
    raw: teams ? { what: 'teams', table: teams } : undefined,
    spec: (width) => spec(study, { column, xTitle }, means, points, width),
  }));
}

const kTwoScales = ' The baseline has a scale of its own: its periods are summed over members.';
const isBaseline = (row: Row): boolean => row.strategy === 'baseline';
const hasTwoScales = (means: Row[]): boolean => means.some(isBaseline) && !means.every(isBaseline);

// A panel per composition. Periods of the baseline, which are sums over members, would press the others flat: they have
// a row of their own.
function spec(
  study: Study,
  { column, xTitle }: Pick<Outcome, 'column' | 'xTitle'>,
  means: Row[],
  points: Row[],
  width: number,
): Spec {
  const compositions = study.compositions(means);
  const common = {
    mean: `${column}_mean`,
    low: `${column}_low`,
    high: `${column}_high`,
    point: column,
    xTitle,
    opensTeams: study.report.lessons !== undefined,
    zero: !column.includes('share_right'),
    possible: column === 'knowledge' || column.includes('share_right') ? ([0, 1] as [number, number]) : undefined,
  };
  const part = (rows: Row[], raw: Row[], first?: number): DotsOptions => ({
    ...common,
    first,
    looks: study.looks(rows),
    panels: compositions.map((code) => ({
      title: code,
      means: rows.filter((row) => row.composition === code),
      points: raw.filter((row) => row.composition === code),
    })),
    strategyOf: (row) => study.words.strategy(row.strategy),
  });
  if (column !== 'periods' || !hasTwoScales(means)) return dots(part(means, points), width);
  const others = means.filter((row) => !isBaseline(row));
  const baseline = means.filter(isBaseline);
  const look = study.looks(baseline)[0];
  const plain = { color: 'var(--text)', shape: 'circle', dash: [1, 0] };
  return stacked([
    dots(part(others, points.filter((row) => !isBaseline(row)), 0), width),
    dots(
      {
        ...common,
        first: compositions.length,
        looks: compositions.map((code) => ({ ...(look ?? plain), label: code })),
        panels: [{ title: study.words.strategy('baseline'), means: baseline, points: points.filter(isBaseline) }],
        strategyOf: (row) => String(row.composition),
      },
      width,
    ),
  ]);
}
