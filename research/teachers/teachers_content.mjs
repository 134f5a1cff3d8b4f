// The tables and claims of research/teachers/teachers.md.
import { study } from '../../tests/validation/runs.mjs';
import { areaUnderCurve, correlation, errorOfMean, groupBy, mean, share } from '../../tests/validation/statistics.mjs';
import { teamsAfter } from './items.mjs';
import { figure, fixed, withError } from '../../tests/validation/format.mjs';

const TEACHERS = 'studies/teachers.toml';
const MIXED = 'studies/teachers-mixed.toml';
const ROBOTS = 'studies/robots.toml';
const PAPER = ['individual-low', 'individual-high', 'common', 'joint'];
const RIVALS = ['set-cover', 'random', 'highlights'];
const DOMAINS = {
  'item-delivery': 'item-delivery',
  'colored-tiles': 'colored-tiles',
  skateboard: 'skateboard',
  'two-goals': 'two-goals',
  'frozen lake': 'domains/gallery/frozen_lake.toml',
};
const ITEMS = 15;
const only = (...strategies) => `design.strategies=${JSON.stringify(strategies)}`;
const FEW = 'replicates=50';
const HUNDRED = 'replicates=100';
const PAPER_STOP = 'stop.mastery="all-right"';
const TAKE_IN_TWO = ['learner.N.capacity=2', 'learner.P.capacity=2'];
const AT_ONCE = 'teacher.scaffold="none"';
const NNP = 'design.compositions=["NNP"]';
const EVERY_PERIOD = ['record.level="period"', 'record.exam="period"'];
// With what the teacher can tell after every period, beside the truth.
const ESTIMATES = ['record.level="period"', 'record.estimates=true'];
const POSTERIOR = (probability) => ['stop.mastery="posterior"', `stop.probability=${probability}`];
const BY_EXAM = 'stop.mastery="exam"';
const ENOUGH = { 'item-delivery': 'item-delivery', 'colored-tiles': 'colored-tiles', 'frozen lake': 'domains/gallery/frozen_lake.toml' };
const CERTAIN = [0.5, 0.7, 0.9, 0.95];
const REGRET = ['item-delivery', 'colored-tiles'];
const MANY = 'stop.periods_per_component=12';
// What is released, {label: settings}.
const SESSIONS = { together: [], 'together, `release = "posterior"`': ['stop.release="posterior"'] };
const CREWS = { NNPP: TEACHERS, LLHH: MIXED };

export const COMMANDS = {
  ...Object.fromEntries(
    Object.entries(DOMAINS).flatMap(([name, file]) => [
      [`paper, ${name}`, study(TEACHERS, FEW, only(...PAPER), PAPER_STOP, `domain="${file}"`, NNP, ...EVERY_PERIOD)],
      [`others, ${name}`, study(TEACHERS, FEW, only(...RIVALS, 'plan'), AT_ONCE, MANY, `domain="${file}"`, NNP, ...EVERY_PERIOD)],
    ]),
  ),
  lessons: study(TEACHERS, only(...PAPER)),
  review: study(TEACHERS, only('joint'), 'teacher.review=true'),
  abilities: study(TEACHERS, HUNDRED, only('joint'), ...ESTIMATES),
  'abilities, mixed': study(MIXED, HUNDRED, only('joint'), 'design.compositions=["LLH"]', ...ESTIMATES),
  'fixed 5': study(TEACHERS, FEW, only('joint'), AT_ONCE, ...ESTIMATES, 'stop.periods_per_component=5'),
  ...Object.fromEntries([0.8, 0.9, 0.95].map((p) => [`posterior ${p}`, study(TEACHERS, FEW, only('joint'), AT_ONCE, ...ESTIMATES, ...POSTERIOR(p))])),
  ...Object.fromEntries(
    Object.entries(CREWS).flatMap(([crew, file]) =>
      Object.entries(SESSIONS).map(([label, settings]) => [
        `${crew} ${label.replaceAll('`', '')}`,
        study(file, HUNDRED, only('joint'), `design.compositions=["${crew}"]`, AT_ONCE, ...POSTERIOR(0.9), ...settings),
      ]),
    ),
  ),
  forecasts: study(TEACHERS, 'replicates=20', only('joint', 'plan'), 'design.compositions=["NNN","NPP"]', PAPER_STOP, 'record.level="period"', 'record.forecast=60'),
  'stop by the exam, navigation': study(ROBOTS, 'replicates=10', only('joint', 'plan'), BY_EXAM),
  ...Object.fromEntries(
    Object.entries(ENOUGH).flatMap(([name, file]) =>
      CERTAIN.map((p) => [`enough ${p}, ${name}`, study(TEACHERS, FEW, only('plan'), `domain="${file}"`, NNP, BY_EXAM, `stop.probability=${p}`, 'stop.max_periods=60')]),
    ),
  ),
  ...Object.fromEntries(REGRET.map((name) => [`regret, ${name}`, study(TEACHERS, FEW, only('plan'), `domain="${name}"`, NNP, 'stop.mastery="regret"', 'stop.probability=0.9', 'stop.max_periods=60', ...EVERY_PERIOD)])),
  'capacity 2, joint': study(TEACHERS, FEW, only('joint'), NNP, ...EVERY_PERIOD, ...TAKE_IN_TWO),
  'capacity 2': study(TEACHERS, FEW, only('plan'), NNP, MANY, ...EVERY_PERIOD, ...TAKE_IN_TWO),
  'capacity 2, planned for': study(TEACHERS, FEW, only('plan'), NNP, MANY, ...EVERY_PERIOD, ...TAKE_IN_TWO, 'strategy.plan.capacity=2'),
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
  // Of the teams of a strategy, the regret after ITEMS as a share of that before.
  const left = (run, strategy) => {
    const teams = teamsAfter(runs, run, ITEMS).filter(({ row }) => row.strategy === strategy);
    const before = mean(teams.map((team) => team.before));
    const shares = teams.map((team) => team.regret / before);
    return { value: mean(shares), se: errorOfMean(shares) };
  };
  const runOf = (domain, strategy) => `${PAPER.includes(strategy) ? 'paper' : 'others'}, ${domain}`;
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

  const tables = {
    anytime: () => ({
      columns: ['strategy', ...Object.keys(DOMAINS)],
      rows: [...PAPER, ...RIVALS, 'plan'].map((strategy) => [
        `\`${strategy}\``,
        ...Object.keys(DOMAINS).map((domain) => {
          const { value, se } = left(runOf(domain, strategy), strategy);
          return withError({ value: 100 * value, se: 100 * se }, 2);
        }),
      ]),
    }),
  };

  // Of the teams that stopped because all were estimated to know enough, the share of which that is true.
  const enough = (name, p) => {
    const stopped = teamsOf(`enough ${p}, ${name}`, 'plan').filter((team) => team.status === 'complete');
    return { items: mean(stopped.map(MEASURES.items[0])), share: share(stopped.filter((team) => team.exam_worst_share_right >= 0.95).length, stopped.length) };
  };
  // The same of teams whose members were all estimated to lose little enough.
  const lost = (name) => {
    const last = new Map();  // by team and member
    for (const row of runs.table(`regret, ${name}`, 'exam').filter((one) => one.kc === '')) last.set(`${row.team} ${row.member}`, row);
    const losesMuch = new Set([...last.values()].filter((row) => row.regret > 0.05).map((row) => row.team));
    const stopped = teamsOf(`regret, ${name}`, 'plan').filter((team) => team.status === 'complete');
    return { items: mean(stopped.map(MEASURES.items[0])), share: share(stopped.filter((team) => !losesMuch.has(team.team)).length, stopped.length) };
  };
  tables.enough = () => ({
    columns: ['`probability`', ...Object.keys(ENOUGH).flatMap((name) => [name, 'items'])],
    rows: CERTAIN.map((p) => [
      String(p),
      ...Object.keys(ENOUGH).flatMap((name) => {
        const { items, share: know } = enough(name, p);
        return [figure(know, 2), fixed(items, 1)];
      }),
    ]),
  });

  const best = (run, measure, pick) => pick(...PAPER.map((strategy) => of(run, strategy, measure).value));
  const value = (...one) => of(...one).value;
  const claims = {
    'plan-is-first': () =>
      Object.keys(DOMAINS).every((domain) =>
        [...PAPER, ...RIVALS].every(
          (strategy) => left(runOf(domain, 'plan'), 'plan').value < (domain === 'frozen lake' ? 0.75 : 0.5) * left(runOf(domain, strategy), strategy).value,
        ),
      ),
    'capacity-planned-for': () => {
      const planned = left('capacity 2, planned for', 'plan').value;
      return planned < left('capacity 2', 'plan').value && planned < left('capacity 2, joint', 'joint').value;
    },
    'review-is-missing': () => value('review', 'joint', 'regret') < best('lessons', 'regret', Math.min) / 5,
    'abilities-are-found': () => {
      const { correlation: r, area, covered } = abilities('abilities', 9, 'NP');
      return r.value >= 0.5 && area.value >= 0.75 && covered.value >= 0.75 && covered.value <= 0.88;
    },
    'mastery-is-calibrated': () =>
      [0.8, 0.9, 0.95].every((p) => {
        const one = mastery(`posterior ${p}`);
        return Math.abs(one.predicted.value - one.actual.value) <= 0.05 && one.stalled.value <= 0.01;
      }),
    'enough-is-enough': () => ['item-delivery', 'colored-tiles'].every((name) => CERTAIN.every((p) => enough(name, p).share.value >= p)),
    'releasing-costs-knowledge': () =>
      Object.keys(CREWS).every((crew) => {
        const [all, released] = [`${crew} together`, `${crew} together, release = "posterior"`];
        return value(released, 'joint', 'person periods') < 0.67 * value(all, 'joint', 'person periods') && value(released, 'joint', 'p_BEC') < value(all, 'joint', 'p_BEC') - 0.02;
      }),
  };
  // The smallest and the largest value of a team; of all strategies without one.
  const rangeOf = (run, strategy, measure, digits) => {
    const teams = runs.table(run, 'teams').filter((team) => !strategy || team.strategy === strategy);
    const values = teams.map(MEASURES[measure][0]);
    return `${fixed(Math.min(...values), digits)} to ${fixed(Math.max(...values), digits)}`;
  };
  const ability = (run, letters) =>
    Object.fromEntries(
      [['correlation', 'correlation'], ['area', 'auc'], ['covered', 'covered'], ['told', 'told'], ['correctly', 'told-right']].map(
        ([measure, name]) => [`${letters}-${name}`, () => figure(abilities(run, 9, letters)[measure], 2)],
      ),
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
    'sure-forecast-mean': () => mean(sureForecasts().map((row) => row.forecast)).toFixed(3),
    'sure-forecast-share': () => figure(share(sureForecasts().filter((row) => row.done).length, sureForecasts().length), 3),
    'navigation-right': () => figure(of('stop by the exam, navigation', 'joint', 'share right'), 2),
    'navigation-knowledge': () => figure(of('stop by the exam, navigation', 'joint', 'p_BEC'), 2),
    'exam-stop-joint-periods': () => rangeOf('stop by the exam, navigation', 'joint', 'periods', 0),
    ...Object.fromEntries(
      REGRET.flatMap((name) => [
        [`regret-stop-${name}`, () => figure(lost(name).share, 2)],
        [`regret-stop-${name}-items`, () => fixed(lost(name).items, 1)],
      ]),
    ),
    'exam-stop-right': () => rangeOf('stop by the exam, navigation', undefined, 'share right', 2),
  };
  return { tables, figures, claims };
}
