// The tables and claims of docs/teachers.md.
import { study } from './runs.mjs';
import { areaUnderCurve, correlation, errorOfMean, groupBy, mean, share } from './statistics.mjs';
import { figure, fixed, withError } from './format.mjs';

const TEACHERS = 'studies/teachers.toml';
const MIXED = 'studies/teachers-mixed.toml';
const ROBOTS = 'studies/robots.toml';
const PAPER = ['individual-low', 'individual-high', 'common', 'joint'];
const RIVALS = ['joint', 'plan', 'set-cover', 'highlights', 'random'];
const DOMAINS = ['item-delivery', 'colored-tiles', 'skateboard'];
const only = (...strategies) => `design.strategies=${JSON.stringify(strategies)}`;
const FEW = 'replicates=50';
const HUNDRED = 'replicates=100';
const TWO_DEMONSTRATIONS = 'teacher.max_demonstrations=2';
const PAPER_STOP = 'stop.mastery="all-right"';
const EXAM_STOP = 'stop.mastery="exam"';
const TAKE_IN_TWO = ['learner.N.capacity=2', 'learner.P.capacity=2'];
const MIXED_TAKE_IN_TWO = ['learner.L.capacity=2', 'learner.H.capacity=2'];
const PLAN_FOR_TWO = ['strategy.plan.capacity=2', 'strategy.adaptive.capacity=2', 'strategy.oracle.capacity=2'];
const PLANNERS = ['plan', 'adaptive', 'oracle'];

const AT_ONCE = 'teacher.scaffold="none"';
// With what the teacher can tell after every period, beside the truth.
const ESTIMATES = ['record.level="period"', 'record.estimates=true'];
// A teacher that plans for one average person and sees no answers, as in the prototype that this work began with.
const BLIND = ['strategy.adaptive.answers=0', 'teacher.hypotheses="average"'];
const EQUALLY_MANY = [TWO_DEMONSTRATIONS, ...PLANNERS.map((one) => `strategy.${one}.min_gain=0`)];
const FORECAST = ['joint', 'pick', 'plan'];
const POSTERIOR = (probability) => ['stop.mastery="posterior"', `stop.probability=${probability}`];
const KNOWN = [
  FEW, AT_ONCE, 'stop.periods_per_component=4', 'teacher.max_demonstrations=1', 'teacher.hypotheses="known-components"',
  'learner.N.known=0.5', 'learner.P.known=0.5',
];
// What is released and separated, {label: settings}.
const SESSIONS = {
  together: [],
  'together, `release = "posterior"`': ['stop.release="posterior"'],
  '`by-type`': ['teacher.grouping="by-type"'],
};
const CREWS = { NNPP: TEACHERS, LLHH: MIXED };

export const COMMANDS = {
  lessons: study(TEACHERS),
  'six periods': study(TEACHERS, only('joint', 'plan'), 'stop.periods_per_component=2'),
  review: study(TEACHERS, only('joint', 'pick', 'plan'), 'teacher.review=true'),
  'stop of the paper': study(TEACHERS, PAPER_STOP),
  'stop of the paper, two demonstrations': study(TEACHERS, only('plan'), PAPER_STOP, TWO_DEMONSTRATIONS),
  'mixed abilities': study(MIXED),
  'mixed abilities, equally many items': study(MIXED, HUNDRED, only(...PLANNERS), ...EQUALLY_MANY),
  'mixed abilities, equally many items, blind': study(MIXED, HUNDRED, only('adaptive'), ...EQUALLY_MANY, ...BLIND),
  'mixed abilities, equally many items, bank alone': study(MIXED, HUNDRED, only('adaptive'), ...EQUALLY_MANY, 'strategy.adaptive.answers=0'),
  abilities: study(TEACHERS, HUNDRED, only('joint'), ...ESTIMATES),
  'abilities, mixed': study(MIXED, HUNDRED, only('joint'), 'design.compositions=["LLH"]', ...ESTIMATES),
  ...Object.fromEntries([5].map((n) => [`fixed ${n}`, study(TEACHERS, FEW, only('joint'), AT_ONCE, ...ESTIMATES, `stop.periods_per_component=${n}`)])),
  ...Object.fromEntries([0.8, 0.9, 0.95].map((p) => [`posterior ${p}`, study(TEACHERS, FEW, only('joint'), AT_ONCE, ...ESTIMATES, ...POSTERIOR(p))])),
  known: study(TEACHERS, only('joint', ...PLANNERS), ...KNOWN, ...ESTIMATES),
  'known, blind': study(TEACHERS, only('adaptive'), ...KNOWN.filter((one) => !one.startsWith('teacher.hypotheses')), ...BLIND),
  ...Object.fromEntries(
    Object.entries(CREWS).flatMap(([crew, file]) =>
      Object.entries(SESSIONS).map(([label, settings]) => [
        `${crew} ${label.replaceAll('`', '')}`,
        study(file, HUNDRED, only('joint'), `design.compositions=["${crew}"]`, AT_ONCE, ...POSTERIOR(0.9), ...settings),
      ]),
    ),
  ),
  forecasts: study(TEACHERS, 'replicates=20', only(...FORECAST), 'design.compositions=["NNN","NPP"]', PAPER_STOP, 'record.level="period"', 'record.forecast=60'),
  ...Object.fromEntries(DOMAINS.map((domain) => [`rivals, ${domain}`, study(TEACHERS, FEW, only(...RIVALS), `domain="${domain}"`)])),
  ...Object.fromEntries(
    DOMAINS.map((domain) => [
      `rivals in six periods, ${domain}`,
      study(TEACHERS, FEW, only(...RIVALS.slice(1)), 'stop.periods_per_component=2', `domain="${domain}"`),
    ]),
  ),
  'stop by the exam, navigation': study(ROBOTS, 'replicates=10', only('joint', 'plan'), EXAM_STOP),
  'stop by the exam, warehouse': study(ROBOTS, 'replicates=10', only('plan'), EXAM_STOP, 'domain="warehouse"'),
  'capacity 2': study(TEACHERS, FEW, only('joint', ...PLANNERS), ...TAKE_IN_TWO),
  'capacity 2, review': study(TEACHERS, FEW, only('joint'), 'teacher.review=true', ...TAKE_IN_TWO),
  'capacity 2, planned for': study(TEACHERS, FEW, only(...PLANNERS), ...TAKE_IN_TWO, ...PLAN_FOR_TWO),
  'planned for capacity 2 in vain': study(TEACHERS, FEW, only('plan'), 'strategy.plan.capacity=2'),
  'capacity 2, mixed abilities, planned for': study(MIXED, FEW, only(...PLANNERS), ...MIXED_TAKE_IN_TWO, ...PLAN_FOR_TWO),
};

// What a team is judged by: a number of a row of teams.csv, and its digits.
const MEASURES = {
  periods: [(team) => team.periods, 2],
  regret: [(team) => team.exam_regret, 4],
  'share right': [(team) => team.exam_share_right, 4],
  p_BEC: [(team) => team.knowledge, 3],
  'person periods': [(team) => team.person_periods, 1],
  items: [(team) => team.demonstrations + team.tests, 1],
};

// Mean over the compositions of a run, all of which have equally many teams, with its standard error.
function overCompositions(teams, measure) {
  const strata = [...groupBy(teams, (team) => team.composition).values()].map((rows) => rows.map(measure));
  return {
    value: mean(strata.map(mean)),
    se: Math.sqrt(strata.reduce((sum, values) => sum + errorOfMean(values) ** 2, 0)) / strata.length,
  };
}

export function makeContent(runs) {
  const teamsOf = (run, strategy, composition) =>
    runs.table(run, 'teams').filter((team) => team.strategy === strategy && (!composition || team.composition === composition));
  const of = (run, strategy, measure, composition) => overCompositions(teamsOf(run, strategy, composition), MEASURES[measure][0]);
  const cell = (run, strategy, measure, composition) => withError(of(run, strategy, measure, composition), MEASURES[measure][1]);

  // A table with a row for each [label, run, strategy].
  const table = (first, measures, rows) => ({
    columns: [first, ...measures],
    rows: rows.map(([label, run, strategy]) => [label, ...measures.map((measure) => cell(run, strategy, measure))]),
  });
  const named = (run, strategies) => strategies.map((strategy) => [`\`${strategy}\``, run, strategy]);

  // `joint` needs nine periods for the items that the others, with three demonstrations per lesson, have in six.
  const runOfFewItems = (domain, strategy) => (strategy === 'joint' ? `rivals, ${domain}` : `rivals in six periods, ${domain}`);
  // Rows about people: {type, ability, ability_mean, ...} after a period.
  const people = (run, period) => runs.table(run, 'estimates').filter((row) => row.kc === '' && row.period === period);
  const abilities = (run, period, [low, high]) => {
    const rows = people(run, period);
    const of = (type) => rows.filter((row) => row.type === type).map((row) => row.ability_mean);
    const told = rows.filter((row) => row.proficiency !== 'cannot tell yet');
    const correctly = told.filter((row) => (row.proficiency === 'proficient') === row.ability >= 0.735);
    return {
      correlation: correlation(rows.map((row) => row.ability), rows.map((row) => row.ability_mean)),
      area: areaUnderCurve(of(low), of(high)),
      covered: share(rows.filter((row) => row.ability_low <= row.ability && row.ability <= row.ability_high).length, rows.length),
      told: share(told.length, rows.length),
      correctly: share(correctly.length, told.length),
    };
  };
  // Probabilities of mastery after the last period of each team: predicted, true, and how many teams did not finish.
  const mastery = (run) => {
    const last = [...groupBy(runs.table(run, 'periods'), (row) => row.team).values()].map((rows) => rows.at(-1));
    const meanOf = (values) => ({ value: mean(values), se: errorOfMean(values) });
    const teams = runs.table(run, 'teams');
    return {
      predicted: meanOf(last.map((row) => row.p_mastery)),
      actual: meanOf(last.map((row) => row.mastery)),
      stalled: share(teams.filter((team) => team.status !== 'complete').length, teams.length),
    };
  };
  // Forecasts of being done within three more periods, {forecast, done}.
  const forecasts = () => {
    const teams = new Map(runs.table('forecasts', 'teams').map((team) => [team.team, team]));
    return runs
      .table('forecasts', 'periods')
      .filter((row) => row.period < teams.get(row.team).periods)
      .map((row) => {
        const team = teams.get(row.team);
        return { forecast: row.forecast_done_3, done: team.status === 'complete' && team.periods - row.period <= 3 ? 1 : 0 };
      });
  };
  const sureForecasts = () => forecasts().filter(({ forecast }) => forecast >= 0.9);
  const lowForecasts = () => forecasts().filter(({ forecast }) => forecast < 0.1);

  const tables = {
    lessons: () =>
      table('strategy', ['regret', 'p_BEC', 'items'], [
        ...named('lessons', [...PAPER, 'pick', ...PLANNERS]),
        ['`joint` with `review`', 'review', 'joint'],
        ['`pick` with `review`', 'review', 'pick'],
      ]),

    rivals: () => ({
      columns: ['strategy', ...DOMAINS],
      rows: RIVALS.map((strategy) => [`\`${strategy}\``, ...DOMAINS.map((domain) => cell(`rivals, ${domain}`, strategy, 'share right'))]),
    }),

    capacity: () =>
      table('strategy', ['regret', 'p_BEC'], [
        ...named('capacity 2', ['joint', ...PLANNERS]),
        ['`joint` with `review`', 'capacity 2, review', 'joint'],
        ...PLANNERS.map((strategy) => [`\`${strategy}\` with \`capacity = 2\``, 'capacity 2, planned for', strategy]),
      ]),
  };

  const best = (run, measure, pick) => pick(...PAPER.map((strategy) => of(run, strategy, measure).value));
  const value = (...one) => of(...one).value;
  const claims = {
    'plan-needs-fewer-periods': () => value('six periods', 'plan', 'p_BEC') > best('lessons', 'p_BEC', Math.max) && value('six periods', 'plan', 'regret') < best('lessons', 'regret', Math.min),
    'review-is-missing': () => value('review', 'joint', 'regret') < best('lessons', 'regret', Math.min) / 5,
    'oracle-is-no-bound': () => value('lessons', 'oracle', 'regret') > value('lessons', 'plan', 'regret'),
    'stops-earlier': () =>
      value('stop of the paper', 'plan', 'periods') < best('stop of the paper', 'periods', Math.min) - 0.5 &&
      value('stop of the paper', 'plan', 'p_BEC') > best('stop of the paper', 'p_BEC', Math.max) + 0.08,
    'two-stop-less-early': () => {
      const saved = best('stop of the paper', 'periods', Math.min) - value('stop of the paper, two demonstrations', 'plan', 'periods');
      return saved > 0 && saved < 0.5;
    },
    'adapting-pays-little': () =>
      ['LLH', 'LLLHHH'].every((composition) => {
        const ratio = value('mixed abilities', 'adaptive', 'regret', composition) / value('mixed abilities', 'plan', 'regret', composition);
        return ratio < 1 && ratio > 0.9;
      }),
    'answers-lower-regret': () =>
      ['LLH', 'LLLHHH'].every((one) => {
        const run = 'mixed abilities, equally many items';
        const blind = value(`${run}, blind`, 'adaptive', 'regret', one);
        return value(`${run}, bank alone`, 'adaptive', 'regret', one) < 0.75 * blind && value(run, 'adaptive', 'regret', one) < 0.6 * blind;
      }),
    'little-is-left': () =>
      ['LLH', 'LLLHHH'].every((one) => {
        const ratio = (strategy) =>
          value('mixed abilities, equally many items', strategy, 'regret', one) / value('mixed abilities, equally many items', 'plan', 'regret', one);
        return ratio('oracle') > 0.9 && ratio('oracle') < 1 && ratio('adaptive') > 0.9 && ratio('adaptive') < 1;
      }),
    'adapting-costs-nothing': () =>
      value('lessons', 'adaptive', 'p_BEC') > value('lessons', 'plan', 'p_BEC') - 0.005 &&
      ['LLH', 'LLLHHH'].every((one) => value('mixed abilities', 'adaptive', 'p_BEC', one) > value('mixed abilities', 'plan', 'p_BEC', one) - 0.005),
    'knowing-pays-a-little': () => {
      const gain = (strategy) => value('known', strategy, 'p_BEC') - value('known', 'plan', 'p_BEC');
      return gain('adaptive') > 0 && gain('adaptive') < 0.05 && gain('oracle') < 0.05 && value('known', 'adaptive', 'regret') < 0.9 * value('known', 'plan', 'regret');
    },
    'abilities-are-found': () => {
      const { correlation: r, area, covered } = abilities('abilities', 9, 'NP');
      return r.value >= 0.5 && area.value >= 0.75 && covered.value >= 0.75 && covered.value <= 0.88;
    },
    'mastery-is-calibrated': () =>
      [0.8, 0.9, 0.95].every((p) => {
        const one = mastery(`posterior ${p}`);
        return Math.abs(one.predicted.value - one.actual.value) <= 0.05 && one.stalled.value <= 0.01;
      }),
    'little-to-gain-by-knowing': () => {
      const gain = (strategy) => value('known', strategy, 'p_BEC') - value('known, blind', 'adaptive', 'p_BEC');
      const less = (strategy) => value('known', strategy, 'regret') < value('known, blind', 'adaptive', 'regret');
      return ['adaptive', 'oracle'].every((one) => gain(one) > 0 && gain(one) < 0.05 && less(one)) && gain('plan') < 0 && !less('plan');
    },
    'releasing-costs-knowledge': () =>
      Object.keys(CREWS).every((crew) => {
        const [all, released] = [`${crew} together`, `${crew} together, release = "posterior"`];
        return value(released, 'joint', 'person periods') < 0.67 * value(all, 'joint', 'person periods') && value(released, 'joint', 'p_BEC') < value(all, 'joint', 'p_BEC') - 0.05;
      }),
    'types-apart': () =>
      Object.keys(CREWS).every((crew) => {
        const [all, apart] = [`${crew} together`, `${crew} by-type`];
        return value(apart, 'joint', 'person periods') < value(all, 'joint', 'person periods') && value(apart, 'joint', 'periods') > 1.3 * value(all, 'joint', 'periods');
      }),
    'plan-beats-rivals': () =>
      DOMAINS.every((domain) =>
        RIVALS.every((strategy) => strategy === 'plan' || value(`rivals, ${domain}`, 'plan', 'share right') > value(`rivals, ${domain}`, strategy, 'share right')),
      ),
    'plan-wins-at-equal-items': () =>
      DOMAINS.every((domain) =>
        RIVALS.filter((strategy) => strategy !== 'plan' && !(strategy === 'joint' && domain === 'skateboard')).every(
          (strategy) => value(runOfFewItems(domain, 'plan'), 'plan', 'share right') > value(runOfFewItems(domain, strategy), strategy, 'share right'),
        ),
      ),
    'skateboard-ties': () => value('rivals, skateboard', 'plan', 'p_BEC') < value('rivals, skateboard', 'set-cover', 'p_BEC'),
    'capacity-turns-it-round': () => value('capacity 2', 'plan', 'p_BEC') < value('capacity 2', 'joint', 'p_BEC'),
    'capacity-adapting-pays': () =>
      ['LLH', 'LLLHHH'].every((one) => {
        const run = 'capacity 2, mixed abilities, planned for';
        return value(run, 'adaptive', 'regret', one) < 0.9 * value(run, 'plan', 'regret', one) && value(run, 'adaptive', 'p_BEC', one) > value(run, 'plan', 'p_BEC', one);
      }),
    'capacity-planned-for': () => value('capacity 2, planned for', 'plan', 'p_BEC') > value('capacity 2', 'joint', 'p_BEC') + 0.1,
    'planning-for-little-is-safe': () => value('planned for capacity 2 in vain', 'plan', 'p_BEC') > value('lessons', 'joint', 'p_BEC') && value('planned for capacity 2 in vain', 'plan', 'regret') < value('lessons', 'joint', 'regret'),
  };
  const doneShare = (rows) => share(rows.reduce((sum, row) => sum + row.done, 0), rows.length);
  const forecastMean = (rows) => mean(rows.map((row) => row.forecast));
  // The smallest and the largest value of a team; of all strategies without one.
  const rangeOf = (run, strategy, measure, digits) => {
    const teams = runs.table(run, 'teams').filter((team) => !strategy || team.strategy === strategy);
    const values = teams.map(MEASURES[measure][0]);
    return `${fixed(Math.min(...values), digits)} to ${fixed(Math.max(...values), digits)}`;
  };
  const ability = (run, letters) =>
    Object.fromEntries(
      Object.entries({ correlation: 'correlation', area: 'auc', covered: 'covered', told: 'told', correctly: 'told-right' }).map(([measure, name]) => [
        `${letters}-${name}`,
        () => figure(abilities(run, 9, letters)[measure], 2),
      ]),
    );
  const figures = {
    ...ability('abilities', 'NP'),
    ...ability('abilities, mixed', 'LH'),
    'fixed-5-periods': () => figure(of('fixed 5', 'joint', 'periods'), 1),
    'fixed-5-mastery': () => figure(mastery('fixed 5').actual, 3),
    ...Object.fromEntries(
      [0.8, 0.9, 0.95].flatMap((p) => [
        [`posterior-${p}-periods`, () => figure(of(`posterior ${p}`, 'joint', 'periods'), 1)],
        [`posterior-${p}-mastery`, () => figure(mastery(`posterior ${p}`).actual, 3)],
      ]),
    ),
    'sure-forecasts': () => String(sureForecasts().length),
    'sure-forecast-mean': () => forecastMean(sureForecasts()).toFixed(3),
    'sure-forecast-share': () => figure(doneShare(sureForecasts()), 3),
    'low-forecasts': () => String(lowForecasts().length),
    'low-forecast-mean': () => forecastMean(lowForecasts()).toFixed(3),
    'low-forecast-share': () => figure(doneShare(lowForecasts()), 3),
    'navigation-right': () => figure(of('stop by the exam, navigation', 'joint', 'share right'), 2),
    'navigation-knowledge': () => figure(of('stop by the exam, navigation', 'joint', 'p_BEC'), 2),
    'exam-stop-plan-periods': () => rangeOf('stop by the exam, navigation', 'plan', 'periods', 0),
    'exam-stop-joint-periods': () => rangeOf('stop by the exam, navigation', 'joint', 'periods', 0),
    'exam-stop-right': () => rangeOf('stop by the exam, navigation', undefined, 'share right', 2),
    'exam-stop-warehouse-periods': () => rangeOf('stop by the exam, warehouse', 'plan', 'periods', 0),
    'exam-stop-warehouse-right': () => rangeOf('stop by the exam, warehouse', 'plan', 'share right', 2),
  };
  return { tables, figures, claims };
}
