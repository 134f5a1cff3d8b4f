// The tables and claims of research/teachers/minds.md.
import { study } from '../../tests/validation/runs.mjs';
import { errorOfMean, groupBy, mean } from '../../tests/validation/statistics.mjs';
import { teamsAfter } from './items.mjs';
import { figure, percent, withError } from '../../tests/validation/format.mjs';

const MINDS = 'studies/minds.toml';
const KINDS = ['bayesian', 'slipping', 'noisy-rational', 'imitating', 'misconceived', 'decaying'];
const PAPER = ['baseline', 'individual-low', 'individual-high', 'common', 'joint'];
const RIVALS = ['set-cover', 'random'];
const OTHERS = [...PAPER, ...RIVALS];
const DOMAINS = { 'item-delivery': 'item-delivery', 'colored-tiles': 'colored-tiles', 'frozen-lake': 'domains/gallery/frozen_lake.toml' };
const ITEMS = 15;
// What is run: the strategies of the paper one component after the other, all others at once.
const MANY = ['teacher.scaffold="none"', 'stop.periods_per_component=12'];
const RUNS = {
  paper: [PAPER],
  rivals: [RIVALS, ...MANY],
  plan: [['plan'], ...MANY],
  asking: [['plan'], ...MANY, 'teacher.hypotheses="kinds"'],
};
const runFor = (domain, run) => study(MINDS, `domain="${DOMAINS[domain]}"`, `design.strategies=${JSON.stringify(RUNS[run][0])}`, 'replicates=25', ...RUNS[run].slice(1));
// How groups talk, and the order in which strategies took real groups the fewest rounds, with their number of groups.
const TALKS = ['none', 'degroot', 'majority', 'truth-wins'];
const ORDER = { common: 5, joint: 5, 'individual-high': 4, 'individual-low': 4 };

export const COMMANDS = {
  ...Object.fromEntries(Object.keys(DOMAINS).flatMap((domain) => Object.keys(RUNS).map((run) => [`${domain}, ${run}`, runFor(domain, run)]))),
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

export function makeContent(runs) {
  const cells = new Map();
  // Of every team of a cell, in the order of replicates: {row, before, regret}.
  function cell(domain, run, kind, strategy) {
    const name = `${domain}, ${run}`;
    if (!cells.has(name)) cells.set(name, groupBy(teamsAfter(runs, name, ITEMS), ({ row }) => `${row['learner.N.kind']}/${row.strategy}`));
    return cells.get(name).get(`${kind}/${strategy}`);
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
  // How often 18 groups of such people show the order of real groups in their mean rounds.
  function chanceOfOrder(talk, kind) {
    const rounds = Object.keys(ORDER).map((strategy) =>
      runs.table(`talk ${talk}`, 'teams').filter((row) => row.strategy === strategy && row['learner.N.kind'] === kind).map((row) => row.periods),
    );
    const random = uniforms(1);
    const kDraws = 20000;
    let ordered = 0;
    for (let draw = 0; draw < kDraws; ++draw) {
      const means = Object.values(ORDER).map((n, s) => {
        let sum = 0;
        for (let i = 0; i < n; ++i) sum += rounds[s][Math.floor(random.next().value * rounds[s].length)];
        return sum / n;
      });
      if (means.every((one, i) => i === 0 || means[i - 1] < one)) ++ordered;
    }
    return ordered / kDraws;
  }
  const chances = new Map();
  const chance = (talk, kind) => {
    const key = `${talk}/${kind}`;
    if (!chances.has(key)) chances.set(key, chanceOfOrder(talk, kind));
    return chances.get(key);
  };
  const allChances = () => TALKS.flatMap((talk) => KINDS.map((kind) => chance(talk, kind)));
  const COLUMNS = [...RIVALS.map((strategy) => ['rivals', strategy, `\`${strategy}\``]), ['plan', 'plan', '`plan`'], ['asking', 'plan', '`plan`, any kind']];
  const bestOfThePaper = (domain, kind) => {
    const [best] = PAPER.map((strategy) => ({ strategy, ...of('regret', domain, 'paper', kind, strategy) })).sort((a, b) => a.value - b.value);
    return { ...withError(best, 3), text: `${withError(best, 3).text}, \`${best.strategy}\`` };
  };
  const matrix = (domain) => () => ({
    columns: ['people', "best of the paper's", ...COLUMNS.map(([, , title]) => title)],
    rows: KINDS.map((kind) => [
      `\`${kind}\``,
      bestOfThePaper(domain, kind),
      ...COLUMNS.map(([run, strategy]) => withError(of('regret', domain, run, kind, strategy), 3)),
    ]),
  });

  const tables = Object.fromEntries(Object.keys(DOMAINS).map((domain) => [`regret-${domain}`, matrix(domain)]));
  const domains = Object.keys(DOMAINS);
  const runOf = (strategy) => (PAPER.includes(strategy) ? 'paper' : 'rivals');
  const everywhere = (kinds, test) => domains.every((domain) => kinds.every((kind) => test(domain, kind)));
  // Whether a cell has at most 1.1 times the regret of each other strategy, or no more beyond two standard errors.
  const isFirst = (run) => (domain, kind) =>
    OTHERS.every((strategy) => {
      const others = [domain, runOf(strategy), kind, strategy];
      const { value, se } = difference('regret', [domain, run, kind, 'plan'], others);
      return value <= 2 * se || of('regret', domain, run, kind, 'plan').value <= 1.1 * of('regret', ...others).value;
    });
  const lessBy = (domain, kind) => less('regret', [domain, 'asking', kind, 'plan'], [domain, 'plan', kind, 'plan']);
  const claims = {
    'plan-is-first': () => everywhere(KINDS.filter((kind) => kind !== 'imitating'), isFirst('plan')),
    'asking-is-first': () => everywhere(KINDS, isFirst('asking')),
    'asking-helps-imitators': () => ['item-delivery', 'colored-tiles'].every((domain) => lessBy(domain, 'imitating').value > 0.25),
  };
  const figures = {
    ...Object.fromEntries(['item-delivery', 'colored-tiles'].map((domain) => [`asking-${domain}`, () => percent(lessBy(domain, 'imitating').value)])),
    'order-least': () => percent(Math.min(...allChances()), 1),
    'order-most': () => percent(Math.max(...allChances()), 1),
    'slip-cost': () => figure(difference('regret', ['item-delivery', 'plan', 'slipping', 'plan'], ['item-delivery', 'plan', 'bayesian', 'plan']), 2),
  };
  return { tables, figures, claims };
}
