// Outcomes by strategy and composition: means, intervals and every team.
import type { Spec } from '../chart';
import type { Outcome, Row } from '../document';
import { stacked } from '../panels';
import type { Study } from '../study';
import { dots, type DotsOptions } from './dots';
import type { Figure } from './figure';
import { counted, range } from './gist';

// Of the lessons, or of the exam.
export function outcomeFigures(study: Study, ofExam: boolean): Figure[] {
  const cells = study.table('cells');
  if (!cells) return [];
  const means = study.rows(cells);
  const teams = study.table('teams');
  const points = teams ? study.rows(teams) : [];
  const name = (row: Row): string => [study.words.strategy(row.strategy), row.composition, row.setting].filter(Boolean).join(', ');
  const n = counted(means, 'teams', 'teams in a cell');
  const isVaried = (column: string): boolean => column !== 'periods' || !study.hasFixedPeriods;
  const present = study.report.outcomes.filter(
    ({ column, of_exam: isOfExam }) =>
      isOfExam === ofExam && cells.columns.includes(`${column}_mean`) && isVaried(column),
  );
  return present.map((outcome) => {
    const { column, better, meaning } = outcome;
    const title = `${outcome.name} by strategy and composition`;
    const reading = `Further ${outcome.less_is_better ? 'left' : 'right'} means ${better}.${meaning ? ` ${meaning}` : ''} Large marks are means with 95\u00a0% t intervals, small dots are single teams.`;
    return {
      id: ofExam ? `${column.replaceAll('_', '-')}-cells` : column,
      title,
      reading: `${reading}${study.report.lessons && teams ? ' A click on a dot shows the team.' : ''}${column === 'periods' && hasTwoScales(means) ? kTwoScales : ''} ${n} ${study.words.letters()}`,
      gist: `${title}. Means: ${range(means, `${column}_mean`, name)}`,
      table: cells,
      raw: teams ? { what: 'teams', table: teams } : undefined,
      spec: (width) => spec(study, outcome, means, points, width),
    };
  });
}

const kTwoScales = ' The baseline has a scale of its own: its periods are summed over members.';
const isBaseline = (row: Row): boolean => row.strategy === 'baseline';
const hasTwoScales = (means: Row[]): boolean => means.some(isBaseline) && !means.every(isBaseline);

// A panel per composition. Periods of the baseline, which are sums over members, would press the others flat: they have
// a row of their own.
function spec(
  study: Study,
  { column, axis, high, of_exam: isOfExam }: Outcome,
  means: Row[],
  points: Row[],
  width: number,
): Spec {
  const facets = study.facets(means, 'composition');
  const common = {
    mean: `${column}_mean`,
    low: `${column}_low`,
    high: `${column}_high`,
    point: column,
    xTitle: axis,
    opensTeams: study.report.lessons !== undefined,
    zero: high === null || !isOfExam,
    possible: high === null ? undefined : ([0, high] as [number, number]),
  };
  const part = (rows: Row[], raw: Row[], first?: number): DotsOptions => ({
    ...common,
    first,
    looks: study.looks(rows),
    panels: facets.map(({ title, rows: [of] }) => {
      const isOf = (row: Row): boolean => row.composition === of?.composition && row.setting === of?.setting;
      return { title, means: rows.filter(isOf), points: raw.filter(isOf) };
    }),
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
        first: facets.length,
        looks: facets.map(({ title }) => ({ ...(look ?? plain), label: title })),
        rows: 'Teams',
        panels: [{ title: study.words.strategy('baseline'), means: baseline, points: points.filter(isBaseline) }],
        strategyOf: (row) => facets.find(({ rows }) => rows.some((one) => one.composition === row.composition && one.setting === row.setting))?.title ?? '',
      },
      width,
    ),
  ]);
}
