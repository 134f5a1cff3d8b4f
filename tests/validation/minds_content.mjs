// The tables and claims of docs/minds.md.
import { study } from './runs.mjs';
import { errorOfMean, groupBy, mean } from './statistics.mjs';
import { figure, fixed, withError } from './format.mjs';

const MINDS = 'studies/minds.toml';
const KINDS = ['bayesian', 'slipping', 'noisy-rational', 'imitating', 'misconceived', 'decaying'];
const STRATEGIES = ['baseline', 'individual-low', 'individual-high', 'common', 'joint', 'plan', 'adaptive', 'set-cover', 'random'];
const PAPER = STRATEGIES.slice(0, 5);
// {domain: [its file, the items after which strategies are compared]}
const DOMAINS = {
  'item-delivery': ['item-delivery', 26],
  'colored-tiles': ['colored-tiles', 32],
  'frozen-lake': ['domains/gallery/frozen_lake.toml', 15, 'replicates=25'],
};

export const COMMANDS = Object.fromEntries(
  Object.entries(DOMAINS).map(([name, [file, , ...settings]]) => [name, study(MINDS, `domain="${file}"`, ...settings)]),
);

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
    const items = DOMAINS[domain][1];
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
  const bestOfPaper = (domain, kind) =>
    PAPER.reduce((a, b) => (of('regret', domain, kind, b).value < of('regret', domain, kind, a).value ? b : a));

  const matrix = (domain) => () => ({
    columns: ['people', ...STRATEGIES.map((one) => `\`${one}\``)],
    rows: KINDS.map((kind) => [`\`${kind}\``, ...STRATEGIES.map((strategy) => withError(of('regret', domain, kind, strategy), 3))]),
  });

  const tables = Object.fromEntries(Object.keys(DOMAINS).map((domain) => [`regret-${domain}`, matrix(domain)]));
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
    'set-cover-is-safe': () => everywhere(domains, OTHERS, (domain, kind) => PAPER.every((strategy) => !more(domain, kind, 'set-cover', strategy))),
    'plan-is-best-in-item-delivery': () => everywhere(['item-delivery'], OTHERS, (domain, kind) => STRATEGIES.every((strategy) => !more(domain, kind, 'plan', strategy))),
    'plan-fails-on-the-lake': () => everywhere(['frozen-lake'], OTHERS, (domain, kind) => STRATEGIES.every((one) => one === 'plan' || more(domain, kind, 'plan', one))),
    'imitators-turn-it-round': () => everywhere(TABULATED, ['imitating'], (domain, kind) => PAPER.every((strategy) => more(domain, kind, 'plan', strategy))),
    'plan-cures': () => ['misconceived', 'decaying'].every((kind) => regret('item-delivery', kind, 'plan') < 0.5 * regret('item-delivery', kind, bestOfPaper('item-delivery', kind))),
  };
  const figures = {
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
