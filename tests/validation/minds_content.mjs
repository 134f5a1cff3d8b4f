// The tables and claims of docs/minds.md.
import { study } from './runs.mjs';
import { errorOfMean, groupBy, mean } from './statistics.mjs';
import { figure, fixed, percent, withError } from './format.mjs';

const MINDS = 'studies/minds.toml';
const KINDS = ['bayesian', 'slipping', 'noisy-rational', 'imitating', 'misconceived', 'decaying'];
const STRATEGIES = ['baseline', 'individual-low', 'individual-high', 'common', 'joint', 'plan', 'adaptive', 'set-cover', 'random'];
const PAPER = STRATEGIES.slice(0, 5);
// {domain: [its file, the items after which strategies are compared]}
const DOMAINS = {
  'item-delivery': ['item-delivery', 26],
  'colored-tiles': ['colored-tiles', 32],
  'frozen-lake': ['domains/gallery/frozen_lake.toml', 15],
};
// Teachers who plan for less regret, and what they take people for: "usual" is "bayesian", "any" any of the kinds.
const ONE_KIND = KINDS.slice(1);
const assuming = (domain, kind) => `${domain} ${kind}`;
const planning = (domain, strategies, ...settings) =>
  study(MINDS, `domain="${DOMAINS[domain][0]}"`, `design.strategies=${JSON.stringify(strategies)}`, 'teacher.objective="regret"', ...settings);
const ASK = 'teacher.hypotheses="kinds"';
// How groups talk, and the order in which strategies took real groups the fewest rounds, with their number of groups.
const TALKS = ['none', 'degroot', 'majority', 'truth-wins'];
const ORDER = { common: 5, joint: 5, 'individual-high': 4, 'individual-low': 4 };
const HUMAN_RANGE = 8.97 - 6.84;

export const COMMANDS = {
  ...Object.fromEntries(Object.entries(DOMAINS).map(([name, [file]]) => [name, study(MINDS, `domain="${file}"`)])),
  ...Object.fromEntries(
    Object.keys(DOMAINS).flatMap((domain) => [
      [assuming(domain, 'usual'), planning(domain, ['plan'], 'replicates=50')],
      [assuming(domain, 'any'), planning(domain, ['plan', 'adaptive'], ASK, 'replicates=50')],
    ]),
  ),
  ...Object.fromEntries(
    ONE_KIND.map((kind) => [assuming('item-delivery', kind), planning('item-delivery', ['plan'], ASK, `teacher.kinds=["${kind}"]`, 'replicates=25')]),
  ),
  ...Object.fromEntries(
    TALKS.map((talk) => [
      `talk ${talk}`,
      study(
        MINDS,
        `design.strategies=${JSON.stringify(Object.keys(ORDER))}`,
        'stop.mastery="all-right"',
        'record.exam="none"',
        'record.level="team"',
        `group.discussion.model="${talk}"`,
      ),
    ]),
  ),
};

// Numbers in [0, 1) from a seed, the same everywhere: SplitMix with 32 bits.
function* uniforms(seed) {
  const mixed = (x, shift, factor) => Math.imul(x ^ (x >>> shift), factor);
  for (let state = seed >>> 0; ; ) {
    state = (state + 0x9e3779b9) >>> 0;
    const mix = mixed(mixed(state, 16, 0x21f0aaad), 15, 0x735a2d97);
    yield ((mix ^ (mix >>> 15)) >>> 0) / 2 ** 32;
  }
}

// Linear between the points of a path [[items, value], ...], level after the last.
function valueAt(path, items) {
  let [x, y] = path[0];
  for (const [nextX, nextY] of path.slice(1)) {
    if (nextX >= items) return nextX > x ? y + ((nextY - y) * (items - x)) / (nextX - x) : nextY;
    [x, y] = [nextX, nextY];
  }
  return y;
}

export function makeContent(runs) {
  const cells = new Map();
  // Of every team of a cell, in the order of replicates: {regret, seen} when each member had seen so many items.
  function cell(domain, kind, strategy) {
    if (!cells.has(domain)) cells.set(domain, cellsOf(domain));
    return cells.get(domain).get(`${kind}/${strategy}`);
  }
  function cellsOf(domain) {
    const items = DOMAINS[domain.split(' ')[0]][1];
    const kindOf = (row) => row['learner.N.kind'];
    const periods = groupBy(runs.table(domain, 'periods'), (row) => row.team);
    const exams = groupBy(runs.table(domain, 'exam').filter((row) => row.kc === ''), (row) => row.team);
    const result = new Map();
    for (const [team, rows] of exams) {
      const members = [...groupBy(rows, (row) => row.member)].map(([member, exam]) => {
        let seen = 0;
        const itemsAfter = new Map([[0, 0]]);
        for (const row of periods.get(team)) {
          if (row.strategy === 'baseline' && row.source !== `member ${member}`) continue;  // taught alone
          seen += row.demonstrations + row.tests;
          itemsAfter.set(row.period, seen);
        }
        return { regret: valueAt(exam.map((row) => [itemsAfter.get(row.period) ?? seen, row.regret]), items), seen };
      });
      const key = `${kindOf(rows[0])}/${rows[0].strategy}`;
      if (!result.has(key)) result.set(key, []);
      const average = (measure) => mean(members.map((one) => one[measure]));
      result.get(key).push({ regret: average('regret'), seen: average('seen') });
    }
    return result;
  }
  const values = (measure, ...where) => cell(...where).map((team) => team[measure]);
  const of = (measure, ...where) => ({ value: mean(values(measure, ...where)), se: errorOfMean(values(measure, ...where)) });
  // The mean over teams of the difference between two cells with the same people.
  const difference = (measure, a, b) => {
    const others = values(measure, ...b);
    const differences = values(measure, ...a).map((value, i) => value - others[i]);
    return { value: mean(differences), se: errorOfMean(differences) };
  };
  // The share by which a is less than b, of the same people, with its standard error.
  const less = (measure, a, b) => {
    const [of_a, of_b] = [values(measure, ...a), values(measure, ...b)];
    const ratio = mean(of_a) / mean(of_b);
    return { value: 1 - ratio, se: errorOfMean(of_a.map((one, i) => one - ratio * of_b[i])) / mean(of_b) };
  };
  // How often 18 groups of such people show the order of real groups in their mean rounds, and also as wide a range.
  function chanceOfOrder(talk, kind) {
    const rounds = Object.keys(ORDER).map((strategy) =>
      runs.table(`talk ${talk}`, 'teams').filter((row) => row.strategy === strategy && row['learner.N.kind'] === kind).map((row) => row.periods),
    );
    const random = uniforms(1);
    const kDraws = 20000;
    let [ordered, wide] = [0, 0];
    for (let draw = 0; draw < kDraws; ++draw) {
      const means = Object.values(ORDER).map((n, s) => {
        let sum = 0;
        for (let i = 0; i < n; ++i) sum += rounds[s][Math.floor(random.next().value * rounds[s].length)];
        return sum / n;
      });
      if (!means.every((one, i) => i === 0 || means[i - 1] < one)) continue;
      ++ordered;
      if (means.at(-1) - means[0] >= HUMAN_RANGE) ++wide;
    }
    return { ordered: ordered / kDraws, wide: wide / kDraws, means: rounds.map(mean) };
  }
  const chances = new Map();
  const chance = (talk, kind) => {
    const key = `${talk}/${kind}`;
    if (!chances.has(key)) chances.set(key, chanceOfOrder(talk, kind));
    return chances.get(key);
  };
  const allChances = () => TALKS.flatMap((talk) => KINDS.map((kind) => chance(talk, kind)));
  const best = (domain, kind, among = STRATEGIES) =>
    among.reduce((a, b) => (of('regret', domain, kind, b).value < of('regret', domain, kind, a).value ? b : a));

  const matrix = (domain) => () => ({
    columns: ['people', ...STRATEGIES.map((one) => `\`${one}\``)],
    rows: KINDS.map((kind) => [`\`${kind}\``, ...STRATEGIES.map((strategy) => withError(of('regret', domain, kind, strategy), 3))]),
  });

  const tables = {
    ...Object.fromEntries(Object.keys(DOMAINS).map((domain) => [`regret-${domain}`, matrix(domain)])),
    assumed: () => ({
      columns: ['people', ...KINDS.map((kind) => `\`${kind}\``), 'any kind'],
      rows: KINDS.map((kind) => [
        `\`${kind}\``,
        ...['usual', ...ONE_KIND, 'any'].map((assumed) => withError(of('regret', assuming('item-delivery', assumed), kind, 'plan'), 3)),
      ]),
    }),
    asking: () => ({
      columns: ['domain', 'people', '`plan` for `bayesian`', '`plan`, any kind', '`adaptive`, any kind', 'less regret by `adaptive`'],
      rows: Object.keys(DOMAINS).flatMap((domain) =>
        KINDS.map((kind) => {
          const [usual, any] = [assuming(domain, 'usual'), assuming(domain, 'any')];
          const { value, se } = less('regret', [any, kind, 'adaptive'], [usual, kind, 'plan']);
          return [
            domain,
            `\`${kind}\``,
            withError(of('regret', usual, kind, 'plan'), 3),
            withError(of('regret', any, kind, 'plan'), 3),
            withError(of('regret', any, kind, 'adaptive'), 3),
            `${percent(value)} (${percent(se)})`,
          ];
        }),
      ),
    }),
    order: () => ({
      columns: ['people', ...TALKS.map((talk) => `\`${talk}\``)],
      rows: KINDS.map((kind) => [`\`${kind}\``, ...TALKS.map((talk) => percent(chance(talk, kind).ordered, 1))]),
    }),
  };
  const domains = Object.keys(DOMAINS);
  const TABULATED = ['item-delivery', 'colored-tiles'];
  const OTHERS = KINDS.filter((kind) => kind !== 'imitating');
  // Of the regrets of two strategies for the same people: whether the first is larger, or not smaller, beyond chance.
  const more = (domain, kind, a, b) => {
    const { value, se } = difference('regret', [domain, kind, a], [domain, kind, b]);
    return value > 2 * se;
  };
  const everywhere = (among, kinds, test) => among.every((domain) => kinds.every((kind) => test(domain, kind)));
  const regret = (...where) => of('regret', ...where).value;
  const claims = {
    'set-cover-is-safe': () =>
      everywhere(domains, OTHERS, (domain, kind) =>
        PAPER.every((strategy) => !more(domain, kind, 'set-cover', strategy) || regret(domain, kind, 'set-cover') < 1.15 * regret(domain, kind, strategy)),
      ),
    'plan-is-best-in-item-delivery': () => everywhere(['item-delivery'], OTHERS, (domain, kind) => STRATEGIES.every((strategy) => !more(domain, kind, 'plan', strategy))),
    'plan-fails-on-the-lake': () => everywhere(['frozen-lake'], OTHERS, (domain, kind) => STRATEGIES.every((one) => one === 'plan' || more(domain, kind, 'plan', one))),
    'imitators-turn-it-round': () => everywhere(TABULATED, ['imitating'], (domain, kind) => PAPER.every((strategy) => more(domain, kind, 'plan', strategy))),
    'asking-helps-imitators': () => TABULATED.every((domain) => less('regret', [assuming(domain, 'any'), 'imitating', 'adaptive'], [assuming(domain, 'usual'), 'imitating', 'plan']).value > 0.25),
    'asking-is-best': () =>
      everywhere(TABULATED, KINDS, (domain, kind) =>
        STRATEGIES.every((strategy) => {
          const { value, se } = difference('regret', [assuming(domain, 'any'), kind, 'adaptive'], [domain, kind, strategy]);
          return value <= 2 * se;
        }),
      ),
    'asking-costs-little': () =>
      everywhere(TABULATED, OTHERS, (domain, kind) => {
        const { value, se } = lessBy(domain, kind);
        return value > (kind === 'bayesian' ? -0.05 : -2 * se);
      }),
    'lessons-for-imitators-harm': () => OTHERS.filter((kind) => kind !== 'slipping').every((kind) => regret(assuming('item-delivery', 'imitating'), kind, 'plan') > 2 * regret(assuming('item-delivery', 'usual'), kind, 'plan')),
    'plan-cures': () => ['misconceived', 'decaying'].every((kind) => regret('item-delivery', kind, 'plan') < 0.5 * regret('item-delivery', kind, best('item-delivery', kind, PAPER))),
  };
  const lessBy = (domain, kind) => less('regret', [assuming(domain, 'any'), kind, 'adaptive'], [assuming(domain, 'usual'), kind, 'plan']);
  const spread = ({ means }) => Math.max(...means) - Math.min(...means);
  const figures = {
    ...Object.fromEntries(['item-delivery', 'colored-tiles'].map((domain) => [`asking-${domain}`, () => percent(lessBy(domain, 'imitating').value)])),
    'usual-decaying': () => figure(of('regret', assuming('item-delivery', 'usual'), 'decaying', 'plan'), 3),
    'order-least': () => percent(Math.min(...allChances().map((one) => one.ordered)), 1),
    'order-most': () => percent(Math.max(...allChances().map((one) => one.ordered)), 1),
    'order-wide': () => percent(Math.max(...TALKS.flatMap((talk) => KINDS.filter((kind) => kind !== 'imitating').map((kind) => chance(talk, kind).wide))), 1),
    'order-wide-imitating': () => percent(Math.max(...TALKS.map((talk) => chance(talk, 'imitating').wide)), 1),
    'order-spread': () => fixed(Math.max(...TALKS.flatMap((talk) => KINDS.filter((kind) => kind !== 'imitating').map((kind) => spread(chance(talk, kind))))), 1),
    'slip-cost': () => figure(difference('regret', ['item-delivery', 'slipping', 'plan'], ['item-delivery', 'bayesian', 'plan']), 2),
    ...Object.fromEntries(domains.map((domain) => [`items-${domain}`, () => String(DOMAINS[domain][1])])),
    ...Object.fromEntries(
      domains.map((domain) => [
        `most-${domain}`,
        () => {
          const means = KINDS.flatMap((kind) => STRATEGIES.map((strategy) => of('seen', domain, kind, strategy).value));
          return fixed(Math.max(...means), 0);
        },
      ]),
    ),
  };
  return { tables, figures, claims };
}
