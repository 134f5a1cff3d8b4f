// The tables and claims of docs/teachers.md.
import { study } from './runs.mjs';
import { errorOfMean, groupBy, mean } from './statistics.mjs';
import { withError } from './format.mjs';

const TEACHERS = 'studies/teachers.toml';
const MIXED = 'studies/teachers-mixed.toml';
const PAPER = ['individual-low', 'individual-high', 'common', 'joint'];
const RIVALS = ['joint', 'plan', 'set-cover', 'highlights', 'random'];
const DOMAINS = ['item-delivery', 'colored-tiles', 'skateboard'];
const only = (...strategies) => `design.strategies=${JSON.stringify(strategies)}`;
const FEW = 'replicates=50';
const TWO_DEMONSTRATIONS = 'teacher.max_demonstrations=2';
const PAPER_STOP = 'stop.mastery="all-right"';
const TAKE_IN_TWO = ['learner.N.capacity=2', 'learner.P.capacity=2'];
const MIXED_TAKE_IN_TWO = ['learner.L.capacity=2', 'learner.H.capacity=2'];
const PLAN_FOR_TWO = ['strategy.plan.capacity=2', 'strategy.adaptive.capacity=2', 'strategy.oracle.capacity=2'];
const PLANNERS = ['plan', 'adaptive', 'oracle'];

const AT_ONCE = 'teacher.scaffold="none"';
const POSTERIOR = (probability) => ['stop.mastery="posterior"', `stop.probability=${probability}`];
const KNOWN = [
  FEW, AT_ONCE, 'stop.periods_per_component=4', 'teacher.max_demonstrations=1', 'teacher.hypotheses="known-components"',
  'learner.N.known=0.5', 'learner.P.known=0.5',
];
// What is released and separated, {label: settings}.
const SESSIONS = {
  together: [],
  'together, `release = "posterior"`': ['stop.release="posterior"'],
  'together, `release = "all-right"`': ['stop.release="all-right"'],
  '`by-type`': ['teacher.grouping="by-type"'],
  '`by-type`, `release = "posterior"`': ['teacher.grouping="by-type"', 'stop.release="posterior"'],
};
const CREWS = { NNPP: TEACHERS, LLHH: MIXED };

export const COMMANDS = {
  lessons: study(TEACHERS),
  'two demonstrations': study(TEACHERS, only(...PLANNERS), TWO_DEMONSTRATIONS),
  'six periods': study(TEACHERS, only('joint', 'plan'), 'stop.periods_per_component=2'),
  review: study(TEACHERS, only('joint', 'pick', 'plan'), 'teacher.review=true'),
  'stop of the paper': study(TEACHERS, PAPER_STOP),
  'stop of the paper, two demonstrations': study(TEACHERS, only('plan'), PAPER_STOP, TWO_DEMONSTRATIONS),
  'mixed abilities': study(MIXED),
  'mixed abilities, bank alone': study(MIXED, only('adaptive'), 'strategy.adaptive.answers=0'),
  ...Object.fromEntries([3, 4, 5].map((n) => [`fixed ${n}`, study(TEACHERS, FEW, only('joint'), AT_ONCE, `stop.periods_per_component=${n}`)])),
  ...Object.fromEntries([0.8, 0.9, 0.95].map((p) => [`posterior ${p}`, study(TEACHERS, FEW, only('joint'), AT_ONCE, ...POSTERIOR(p))])),
  known: study(TEACHERS, only('joint', ...PLANNERS), ...KNOWN),
  'known, placement tests': study(TEACHERS, only('adaptive'), ...KNOWN, 'teacher.placement_tests=4'),
  ...Object.fromEntries(
    Object.entries(CREWS).flatMap(([crew, file]) =>
      Object.entries(SESSIONS).map(([label, settings]) => [
        `${crew} ${label.replaceAll('`', '')}`,
        study(file, 'replicates=100', only('joint'), `design.compositions=["${crew}"]`, AT_ONCE, ...POSTERIOR(0.9), ...settings),
      ]),
    ),
  ),
  ...Object.fromEntries(DOMAINS.map((domain) => [`rivals, ${domain}`, study(TEACHERS, FEW, only(...RIVALS), `domain="${domain}"`)])),
  ...Object.fromEntries(
    DOMAINS.map((domain) => [
      `rivals in six periods, ${domain}`,
      study(TEACHERS, FEW, only(...RIVALS.slice(1)), 'stop.periods_per_component=2', `domain="${domain}"`),
    ]),
  ),
  'capacity 2': study(TEACHERS, FEW, only('joint', ...PLANNERS), ...TAKE_IN_TWO),
  'capacity 2, review': study(TEACHERS, FEW, only('joint'), 'teacher.review=true', ...TAKE_IN_TWO),
  'capacity 2, planned for': study(TEACHERS, FEW, only(...PLANNERS), ...TAKE_IN_TWO, ...PLAN_FOR_TWO),
  'planned for capacity 2 in vain': study(TEACHERS, FEW, only('plan'), 'strategy.plan.capacity=2'),
  'capacity 2, stop of the paper': study(TEACHERS, FEW, only('joint', 'plan'), PAPER_STOP, ...TAKE_IN_TWO),
  'capacity 2, stop of the paper, planned for': study(TEACHERS, FEW, only('plan'), PAPER_STOP, ...TAKE_IN_TWO, ...PLAN_FOR_TWO),
  'capacity 2, mixed abilities, planned for': study(MIXED, FEW, only(...PLANNERS), ...MIXED_TAKE_IN_TWO, ...PLAN_FOR_TWO),
};

// What a team is judged by: a number of a row of teams.csv, and its digits.
const MEASURES = {
  periods: [(team) => team.periods, 2],
  regret: [(team) => team.exam_regret, 4],
  'share right': [(team) => team.exam_share_right, 4],
  'of the worst member': [(team) => team.exam_worst_share_right, 4],
  p_BEC: [(team) => team.knowledge, 3],
  'least p_BEC of a team': [(team) => team.knowledge_min, 3],
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
  const compareRivals = (runOf) => ({
    columns: ['domain', 'strategy', 'share right', 'of the worst member', 'regret', 'p_BEC', 'items'],
    rows: DOMAINS.flatMap((domain) =>
      RIVALS.map((strategy) => [
        domain,
        `\`${strategy}\``,
        ...['share right', 'of the worst member', 'regret', 'p_BEC', 'items'].map((measure) => cell(runOf(domain, strategy), strategy, measure)),
      ]),
    ),
  });

  const tables = {
    commands: () => runs.commandTable(),

    lessons: () =>
      table('strategy', ['regret', 'p_BEC', 'least p_BEC of a team', 'items'], [
        ...named('lessons', [...PAPER, 'pick', ...PLANNERS]),
        ...PLANNERS.map((strategy) => [`\`${strategy}\`, two demonstrations per lesson`, 'two demonstrations', strategy]),
        ['`joint` in six periods', 'six periods', 'joint'],
        ['`plan` in six periods', 'six periods', 'plan'],
        ['`joint` with `review`', 'review', 'joint'],
        ['`pick` with `review`', 'review', 'pick'],
      ]),

    stop: () =>
      table('strategy', ['periods', 'regret', 'p_BEC', 'items'], [
        ...named('stop of the paper', [...PAPER, 'pick', ...PLANNERS]),
        ['`plan`, two demonstrations per lesson', 'stop of the paper, two demonstrations', 'plan'],
      ]),

    mixed: () => ({
      columns: ['strategy', ...['LLH', 'LLLHHH'].flatMap((composition) => [`${composition}: regret`, `${composition}: p_BEC`])],
      rows: [
        ...named('mixed abilities', ['joint', ...PLANNERS]),
        ['`adaptive` with the bank alone (`answers = 0`)', 'mixed abilities, bank alone', 'adaptive'],
      ].map(([label, run, strategy]) => [
        label,
        ...['LLH', 'LLLHHH'].flatMap((composition) => ['regret', 'p_BEC'].map((measure) => cell(run, strategy, measure, composition))),
      ]),
    }),

    posterior: () =>
      table('rule', ['periods', 'regret', 'p_BEC'], [
        ...[3, 4, 5].map((n) => [`fixed ${n}`, `fixed ${n}`, 'joint']),
        ...[0.8, 0.9, 0.95].map((p) => [`posterior ${p}`, `posterior ${p}`, 'joint']),
      ]),

    known: () =>
      table('strategy', ['regret', 'p_BEC'], [
        ...named('known', ['joint', ...PLANNERS]),
        ['`adaptive` with four placement tests', 'known, placement tests', 'adaptive'],
      ]),

    sessions: () => ({
      columns: ['sessions', ...Object.keys(CREWS).flatMap((crew) => [`${crew}: periods`, 'person periods', 'p_BEC', 'share right of the worst member'])],
      rows: Object.keys(SESSIONS).map((label) => [
        label,
        ...Object.keys(CREWS).flatMap((crew) =>
          ['periods', 'person periods', 'p_BEC', 'of the worst member'].map((measure) => cell(`${crew} ${label.replaceAll('`', '')}`, 'joint', measure)),
        ),
      ]),
    }),

    rivals: () => compareRivals((domain) => `rivals, ${domain}`),

    'equal-items': () => compareRivals(runOfFewItems),

    capacity: () =>
      table('strategy', ['regret', 'p_BEC', 'items'], [
        ...named('capacity 2', ['joint', ...PLANNERS]),
        ['`joint` with `review`', 'capacity 2, review', 'joint'],
        ...PLANNERS.map((strategy) => [`\`${strategy}\` with \`capacity = 2\``, 'capacity 2, planned for', strategy]),
        ['`plan` with `capacity = 2`, people who take in everything', 'planned for capacity 2 in vain', 'plan'],
      ]),

    'capacity-stop': () =>
      table('strategy', ['periods', 'regret', 'p_BEC', 'items'], [
        ...named('capacity 2, stop of the paper', ['joint', 'plan']),
        ['`plan` with `capacity = 2`', 'capacity 2, stop of the paper, planned for', 'plan'],
      ]),

    'capacity-mixed': () => ({
      columns: ['strategy', ...['LLH', 'LLLHHH'].flatMap((composition) => [`${composition}: regret`, `${composition}: p_BEC`])],
      rows: PLANNERS.map((strategy) => [
        `\`${strategy}\` with \`capacity = 2\``,
        ...['LLH', 'LLLHHH'].flatMap((composition) =>
          ['regret', 'p_BEC'].map((measure) => cell('capacity 2, mixed abilities, planned for', strategy, measure, composition)),
        ),
      ]),
    }),
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
    'adapting-costs-nothing': () =>
      value('lessons', 'adaptive', 'p_BEC') > value('lessons', 'plan', 'p_BEC') - 0.005 &&
      ['LLH', 'LLLHHH'].every((one) => value('mixed abilities', 'adaptive', 'p_BEC', one) > value('mixed abilities', 'plan', 'p_BEC', one) - 0.005),
    'knowing-pays-a-little': () => {
      const gain = (strategy) => value('known', strategy, 'p_BEC') - value('known', 'plan', 'p_BEC');
      return gain('adaptive') > 0 && gain('adaptive') < 0.05 && gain('oracle') < 0.05 && value('known', 'adaptive', 'regret') < 0.9 * value('known', 'plan', 'regret');
    },
    'placement-adds-nothing': () => Math.abs(value('known, placement tests', 'adaptive', 'p_BEC') - value('known', 'adaptive', 'p_BEC')) < 0.01,
    'releasing-costs-knowledge': () =>
      Object.keys(CREWS).every((crew) => {
        const [all, released] = [`${crew} together`, `${crew} together, release = "posterior"`];
        return value(released, 'joint', 'person periods') < 0.67 * value(all, 'joint', 'person periods') && value(released, 'joint', 'p_BEC') < value(all, 'joint', 'p_BEC') - 0.05;
      }),
    'types-apart': () =>
      Object.keys(CREWS).every((crew) => {
        const [all, apart] = [`${crew} together`, `${crew} by-type`];
        return value(apart, 'joint', 'person periods') < value(all, 'joint', 'person periods') && value(apart, 'joint', 'periods') > 1.4 * value(all, 'joint', 'periods');
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
  return { tables, figures: {}, claims };
}
