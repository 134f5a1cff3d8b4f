// Writes sample/report.json: a document of the schema kith.report/1 whose numbers come from simple
// formulas and a small generator. They are no results; they exist so that every part of the page
// can be drawn and tested without a study.
//
//   node sample/make_sample.mjs [FILE]
import { mkdirSync, writeFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { sampleBeliefs } from './sample_beliefs.mjs';
import { sampleTexts } from './sample_texts.mjs';
import { makeRandom } from './random.mjs';

const out = process.argv[2] ?? join(dirname(fileURLToPath(import.meta.url)), 'report.json');
const random = makeRandom(20240424);
const round = (value, digits = 4) => (value === null ? null : Number(value.toFixed(digits)));

const strategies = {
  baseline: 'Baseline',
  'individual-low': 'Individual low',
  'individual-high': 'Individual high',
  common: 'Common',
  joint: 'Joint',
};
const types = { N: 'novice', P: 'proficient' };
const compositions = ['NNN', 'NNP', 'NPP', 'PPP'];
const components = [1, 2, 3];
const replicates = 15;
const names = Object.keys(strategies);
const numP = (composition) => [...composition].filter((letter) => letter === 'P').length;
const table = (columns, rows) => ({ columns, rows });
const each = (...lists) =>
  lists.reduce((acc, list) => acc.flatMap((head) => list.map((item) => [...head, item])), [[]]);

function meanInterval(values) {
  const n = values.length;
  const mean = values.reduce((a, b) => a + b, 0) / n;
  const sd = Math.sqrt(values.reduce((a, b) => a + (b - mean) ** 2, 0) / (n - 1));
  const half = (2.14 * sd) / Math.sqrt(n);
  return { mean, sd, low: mean - half, high: mean + half };
}

const teams = each(names, compositions, [...Array(replicates).keys()]).map(
  ([strategy, composition, replicate], team) => {
    const p = numP(composition);
    const base = strategy === 'baseline' ? 18.5 : 8.6;
    const tilt = strategy === 'joint' ? 0.5 * (1.5 - p) : strategy === 'individual-high' ? 0.4 : 0;
    const periods = Math.max(3, Math.round(base - 0.6 * p + tilt + 1.5 * random.normal()));
    const knowledge = Math.min(
      0.99,
      Math.max(0.1, 0.5 + 0.05 * p + (strategy === 'common' ? 0.05 : 0) + 0.12 * random.normal()),
    );
    return {
      strategy,
      composition,
      replicate: replicate + 1,
      team,
      periods,
      knowledge: round(knowledge),
      completed: true,
    };
  },
);
teams[42].completed = false;
const cellOf = (strategy, composition) => teams.filter((t) => t.strategy === strategy && t.composition === composition);

const cells = each(names, compositions).map(([strategy, composition]) => {
  const members = cellOf(strategy, composition);
  const k = names.indexOf(strategy);
  const columns = [
    members.map((t) => t.periods),
    members.map((t) => t.knowledge),
    members.map(() => 0.5 + 0.1 * k + 0.05 * random.normal()),
  ];
  const stats = columns
    .map(meanInterval)
    .flatMap(({ mean, sd, low, high }) => [mean, sd, low, high].map((v) => round(v)));
  return [strategy, composition, members.length, members.filter((t) => t.completed).length, ...stats];
});

const completion = each(names, compositions).flatMap(([strategy, composition]) => {
  const members = cellOf(strategy, composition);
  const rows = [[strategy, composition, 0, 0, 0, 0, members.length]];
  const last = Math.max(...members.map((t) => t.periods));
  for (let period = 1; period <= last; ++period) {
    const done = members.filter((t) => t.completed && t.periods <= period).length / members.length;
    const half = 1.96 * Math.sqrt((done * (1 - done)) / members.length);
    const atRisk = members.filter((t) => t.periods >= period).length;
    rows.push([
      strategy,
      composition,
      period,
      round(done),
      round(Math.max(0, done - half)),
      round(Math.min(1, done + half)),
      atRisk,
    ]);
  }
  return rows;
});

// A quantity that rises towards a ceiling, with an interval which widens as people finish.
function rising(start, ceiling, rate, period, people) {
  const mean = ceiling - (ceiling - start) * Math.exp(-rate * period) + 0.006 * random.normal();
  const half = 0.35 / Math.sqrt(people);
  return [round(mean), round(Math.max(0, mean - half)), round(Math.min(1, mean + half)), people];
}
const peopleLeft = (period) => Math.max(10, Math.round(90 - 6 * period));
const typeNames = Object.keys(types);
const knowledgeByPeriod = each(names, typeNames, [...Array(10).keys()]).map(([s, t, period]) => [
  s,
  t,
  period,
  ...rising(0.08, (t === 'P' ? 0.75 : 0.6) + 0.02 * names.indexOf(s), 0.22, period, peopleLeft(period)),
]);
const correctByPeriod = each(names, typeNames, [...Array(9).keys()]).map(([s, t, period]) => {
  const [share, low, high, answers] = rising(
    t === 'P' ? 0.72 : 0.6,
    0.93,
    0.3,
    period + 0.3 * names.indexOf(s),
    2 * peopleLeft(period),
  );
  return [s, t, period + 1, share, low, high, answers];
});
const area = each(names, components).map(([strategy, kc]) => {
  const mean = -0.2 - 0.35 * kc - 0.09 * names.indexOf(strategy) + 0.02 * random.normal();
  return [strategy, kc, round(mean), round(mean - 0.06), round(mean + 0.06), round(Math.exp(mean)), 60 + 5 * kc];
});
const periodsByComponent = each(names, compositions, components).map(([strategy, composition, kc]) => {
  const total = meanInterval(cellOf(strategy, composition).map((t) => t.periods)).mean;
  const mean = total * [0.22, 0.33, 0.45][kc - 1];
  return [strategy, composition, kc, round(mean), round(mean - 0.3), round(mean + 0.3)];
});
// An exam after every period, and forecasts. Chance of their own, so that the numbers above stay.
const other = makeRandom(7);
const around = (value, half) => [round(value), round(value - half), round(value + half)];
const examByPeriod = each(names, [...Array(10).keys()]).map(([strategy, period]) => {
  const k = names.indexOf(strategy);
  const left = Math.exp(-(0.25 + 0.05 * k) * period);
  return [
    strategy,
    period,
    60,
    round(3.1 * period, 1),
    round(1.1 * period, 2),
    round(3.3 * period, 2),
    ...around(0.9 * left, 0.03),
    ...around(1 - 0.7 * left, 0.02),
    ...around(1 - 0.8 * left, 0.03),
    ...around(0.95 - 0.85 * left, 0.03),
  ];
});
const efficiency = each(names, compositions).map(([strategy, composition]) => {
  const k = names.indexOf(strategy);
  const items = 24 + 2 * k + other.normal();
  const knowledge = 0.6 + 0.06 * k - (k === 2 ? 0.1 : 0) + 0.02 * numP(composition);
  const onFront = k !== 2;
  return [
    strategy,
    composition,
    replicates,
    ...around(items, 0.8),
    ...around(0.35 * items, 0.3),
    ...around(items, 0.9),
    ...around(knowledge, 0.03),
    ...around(0.9, 0.02),
    ...around(0.04 - 0.006 * k, 0.004),
    onFront,
    onFront ? 0.9 : 0.1,
  ];
});
const forecasts = each(names, compositions).map(([strategy, composition]) => {
  const { mean, low, high } = meanInterval(cellOf(strategy, composition).map((t) => t.periods));
  return [strategy, composition, replicates, round(mean), round(mean - 2), round(mean + 2), ...[mean, low, high].map((v) => round(v)), 0.8, 0.55, 0.93];
});
const calibration = each([1, 2, 3], [0.05, 0.15, 0.25, 0.35, 0.45, 0.55, 0.65, 0.75, 0.85, 0.95]).map(([within, p]) => {
  const share = Math.min(1, Math.max(0, p + 0.04 * other.normal()));
  return [within, p, round(share), round(Math.max(0, share - 0.1)), round(Math.min(1, share + 0.1)), 80];
});
const triple = (name) => [name, `${name}_low`, `${name}_high`];
// What people of other minds are left with: the best of a row, and one that is hardly worse.
const minds = ['bayesian', 'noisy-rational', 'imitating', 'decaying'];
const matrixNames = [...names, 'plan', 'adaptive', 'set-cover', 'random'];
const matrix = each(minds, matrixNames).map(([mind, strategy]) => {
  const k = matrixNames.indexOf(strategy);
  const best = minds.indexOf(mind) + 3;
  const standing = k === best ? 'best' : k === best + 1 ? 'not clearly worse' : '';
  const regret = 0.03 * 4 ** minds.indexOf(mind) * (1 + 0.1 * Math.abs(k - best));
  return [mind, strategy, 60, ...around(regret, 0.05 * regret), standing, ...around(0.9 - 0.02 * Math.abs(k - best), 0.02), standing];
});
const timings = [
  ['planning', 0.041],
  ['teaching', 0.196],
  ['responses', 0.027],
  ['tables', 0.035],
];
const parameters = [
  ['study', 'seed', '20240424', 'the only source of randomness'],
  ['study', 'replicates', '15', 'teams per cell'],
  ['design', 'strategies', names.join(', '), 'whose belief a lesson is made for'],
  ['design', 'compositions', compositions.join(', '), 'letters name the learner types'],
  ['learner.N', 'ability.mean', '0.703', 'probability that an answer expresses the own belief'],
  ['learner.N', 'ability.sd', '0.034', 'spread of ability between people'],
  ['learner.P', 'ability.mean', '0.809', 'probability that an answer expresses the own belief'],
  ['learner.P', 'ability.sd', '0.025', 'spread of ability between people'],
  ['teacher', 'particles', '1000', 'particles per belief'],
  ['teacher', 'counterfactuals', '8', 'counterfactual learners per choice'],
  ['stop', 'max_periods', '50', 'teaching stops here at the latest'],
];

const pick = (of, group) => teams.filter((t) => (t.strategy !== 'baseline') === group).map(of);
const meanOf = (values) => values.reduce((a, b) => a + b, 0) / values.length;
const difference = (estimate, half, n) => ({
  estimate: round(estimate),
  low: round(estimate - half),
  high: round(estimate + half),
  n,
});
const outcomes = [
  { name: 'Periods', digits: 1, of: (t) => t.periods, half: 0.6 },
  { name: 'Person-periods', digits: 1, of: (t) => (t.strategy === 'baseline' ? 1 : 3) * t.periods, half: 1.2 },
  { name: 'Knowledge at the end', digits: 2, of: (t) => t.knowledge, half: 0.04 },
];
const outcome = (column, name, better, digits, high) => ({
  column,
  name,
  axis: name,
  better,
  meaning: '',
  digits,
  less_is_better: high === null,
  of_exam: column.startsWith('exam'),
  high,
});
const against = (factor, first, codes) => ({
  factor,
  against: first,
  rows: codes.map((code) => {
    const group = (level) =>
      teams.filter((t) => t[factor] === level && (factor === 'strategy' || t.strategy !== 'baseline'));
    const differences = outcomes.map(({ of, half }) =>
      difference(meanOf(group(code).map(of)) - meanOf(group(first).map(of)), half, factor === 'strategy' ? 60 : 15),
    );
    return { code, differences };
  }),
});
const answer = (question, { name, digits }, rest) => ({
  question,
  outcome: name.toLowerCase(),
  means: '1 and 2',
  compared: '',
  estimate: null,
  low: null,
  high: null,
  bound: null,
  ratio: false,
  digits,
  p: 0.5,
  answer: 'no difference found',
  finding: 'periods',
  ...rest,
});

const report = {
  schema: 'kith.report/1',
  title: 'Group strategies and team compositions (synthetic sample)',
  study: 'sample',
  domain: 'item-delivery',
  version: '0.0.0',
  created: '2000-01-01T00:00:00Z',
  labels: {
    strategies,
    types,
    meanings: {
      strategies: {
        baseline: 'teach the members one after the other, each alone',
        'individual-low': 'teach for the member who knows least',
        'individual-high': 'teach for the member who knows most',
        common: 'teach for what all members know',
        joint: 'teach for what at least one member knows',
      },
      compositions: Object.fromEntries(
        compositions.map((code) => [code, `${3 - numP(code)} novice, ${numP(code)} proficient`]),
      ),
    },
    columns: {
      periods_mean: 'Periods, mean',
      periods_sd: 'Periods, sd',
      knowledge_mean: 'Knowledge, mean',
      mean_area_sr: 'Mean area (sr)',
      kc: 'Component',
    },
  },
  overview: {
    teams: teams.length,
    people: 3 * teams.length,
    completed: teams.filter((t) => t.completed).length,
    replicates,
    seed: '20240424',
    strategies: names,
    compositions,
    factors: [],
    simulated: true,
    finding: 'These numbers are synthetic: teaching a team together takes fewer periods than one after the other',
    summary: ['These numbers are synthetic: 300 teams of 3 people, taught in 5 ways.'],
    answers: [
      ...outcomes.map((outcome) =>
        answer('Together compared with one after the other', outcome, {
          means: `${round(meanOf(pick(outcome.of, true)), 2)} and ${round(meanOf(pick(outcome.of, false)), 2)}`,
          ...difference(meanOf(pick(outcome.of, true)) - meanOf(pick(outcome.of, false)), outcome.half, 60),
          p: 1e-9,
          answer: 'they differ',
        }),
      ),
      answer('Among the 4 strategies for a team', outcomes[0], { bound: 0.77 }),
      answer('Who is in the team', outcomes[0], { compared: 'PPP - NNN', ...difference(-1.4, 1, 15), p: 0.005 }),
    ],
    differences: {
      interval: 't intervals of differences within the same people',
      outcomes: outcomes.map(({ name, digits }) => ({ name, digits })),
      groups: [
        against('strategy', 'baseline', names.slice(1)),
        against('composition', compositions[0], compositions.slice(1)),
      ],
    },
    limits: ['These numbers are synthetic and say nothing.', 'Passing all tests is not knowing everything.'],
  },
  lessons: {
    domain: {
      id: 'item-delivery',
      features: [
        { name: 'rubble', weight: -3 },
        { name: 'step', weight: -1 },
      ],
      legend: [
        { symbol: '#', kind: 'wall', name: 'wall', parts: [{ kind: 'wall', name: 'wall' }] },
        { symbol: 'r', kind: 'terrain', name: 'rubble', parts: [{ kind: 'terrain', name: 'rubble' }] },
      ],
      surfaces: [{ name: 'rubble', tint: 'brown', pattern: 'dots' }],
      width: 3,
      height: 2,
    },
    features: ['rubble', 'step'],
    boards: [['right', [2, 1]], ['down', [1, 2]]].map(([action, cell], world) => ({
      world,
      map: ['.r.', '..#'],
      start: { robot: [1, 1] },
      frames: [
        { robot: [1, 1], action },
        { robot: cell, action: null },
      ],
      text: action,
    })),
    sentences: [
      { normal: [-1, 2], text: 'crossing rubble costs more than 2 steps' },
      { normal: [1, -4], text: '4 steps cost more than crossing rubble' },
    ],
    teams: teams.map(({ strategy, composition, replicate, team }) => ({
      team,
      strategy,
      composition,
      replicate,
      periods: [
        [1, 1, 0, [0], [0], [[1, '10-']], [20, 30, 40]],
        [2, 1, 0, [1], [1], [[0, '111']], [50, 60, 70]],
      ],
    })),
  },
  notes: [
    'These numbers are synthetic: they come from formulas, not from a study.',
    'One team of 300 reached the limit of 50 periods and is censored.',
  ],
  tables: {
    cells: table(
      [
        'strategy',
        'composition',
        'teams',
        'completed',
        ...['periods', 'knowledge', 'area'].flatMap((q) => ['mean', 'sd', 'low', 'high'].map((s) => `${q}_${s}`)),
      ],
      cells,
    ),
    teams: table(
      ['strategy', 'composition', 'replicate', 'team', 'periods', 'knowledge', 'completed'],
      teams.map((t) => [t.strategy, t.composition, t.replicate, t.team, t.periods, t.knowledge, t.completed]),
    ),
    completion: table(['strategy', 'composition', 'period', 'done', 'low', 'high', 'at_risk'], completion),
    area: table(['strategy', 'kc', 'mean_log_area', 'low', 'high', 'mean_area_sr', 'n'], area),
    knowledge_by_period: table(['strategy', 'type', 'period', 'mean', 'low', 'high', 'people'], knowledgeByPeriod),
    correct_by_period: table(['strategy', 'type', 'period', 'share', 'low', 'high', 'answers'], correctByPeriod),
    periods_by_component: table(['strategy', 'composition', 'kc', 'mean_periods', 'low', 'high'], periodsByComponent),
    exam_by_period: table(
      [
        'strategy',
        'period',
        'teams',
        'items',
        'minutes',
        'person_minutes',
        ...['regret', 'share_right', 'worst_share_right', 'knowledge'].flatMap(triple),
      ],
      examByPeriod,
    ),
    efficiency: table(
      [
        'strategy',
        'composition',
        'teams',
        ...['items', 'minutes', 'person_minutes', 'knowledge', 'share_right', 'regret'].flatMap(triple),
        'on_front',
        'front_share',
      ],
      efficiency,
    ),
    forecasts: table(
      [
        'strategy',
        'composition',
        'teams',
        'forecast_mean',
        'forecast_low',
        'forecast_high',
        'mean',
        'low',
        'high',
        'within',
        'within_low',
        'within_high',
      ],
      forecasts,
    ),
    forecast_calibration: table(['within', 'forecast', 'share', 'low', 'high', 'n'], calibration),
    timings: table(['phase', 'seconds'], timings),
    parameters: table(['group', 'key', 'value', 'meaning'], parameters),
  },
  ...sampleTexts(),
  outcomes: [
    outcome('periods', 'Periods', 'fewer periods', 1, null),
    outcome('knowledge', 'Knowledge at the end', 'more knowledge', 2, 1),
  ],
  matrices: [
    {
      factors: ['learner.N.kind', 'strategy'],
      outcomes: [
        outcome('exam_regret', 'Regret in the exam', 'less regret in the exam', 3, null),
        outcome('exam_share_right', 'Share right in the exam', 'a larger share right in the exam', 2, 1),
      ],
      table: table(
        [
          'learner.N.kind',
          'strategy',
          'teams',
          ...['exam_regret', 'exam_share_right'].flatMap((q) => ['mean', 'low', 'high', 'standing'].map((s) => `${q}_${s}`)),
        ],
        matrix,
      ),
    },
  ],
  beliefs: sampleBeliefs(random),
};

mkdirSync(dirname(out), { recursive: true });
writeFileSync(out, `${JSON.stringify(report, (_, value) => value)}\n`);
