// The figures of the page's section on calibration, made of one document of `kith calibrate --json`.
import { fixed, probability } from './format.mjs';

const short = (value) => String(Number(value.toPrecision(3)));

const nameOf = (target) =>
  target.effect ? `F of ${target.effect}` : `${target.statistic === 'sd' ? 'sd of ' : ''}${target.quantity}, ${target.teams}`;

const listed = (words) => (words.length > 1 ? `${words.slice(0, -1).join(', ')} and ${words.at(-1)}` : words[0]);

// What the comments of a study say of the answer, and of the study as it was. `here` are the means and standard deviations of
// the study itself, by the names of the targets.
export function calibrationQuotes(runs, here) {
  const { parameters, targets, best, candidates } = runs.json('calibration');
  const at = (name) => targets.findIndex((target) => nameOf(target) === name);
  const asked = (name) => targets[at(name)];
  const least = (name) => asked(name).value / (asked(name).within_factor ?? 1) - (asked(name).within_factor ? 0 : asked(name).tolerance);
  const [alone, periods, spread] = ['knowledge, baseline', 'periods, baseline', 'sd of knowledge, group'];
  const before = (name) => candidates.find((one) => one.label === 'the study as it is').targets[at(name)].model;
  const undecided = parameters.filter((one) => one.open_low && one.low <= one.min && one.open_high && one.high >= one.max);
  const parameter = (name) => parameters.find((one) => one.name === name);
  const range = (name) => `${short(parameter(name).min)} to ${short(parameter(name).max)}`;
  return [
    `: ${parameters.map((one) => `${one.name} ${short(one.value)}`).join(', ')}. `,
    `taught alone end with a knowledge of ${fixed(best.targets[at(alone)].model, 2)}, where ${asked(alone).value} within ` +
      `${asked(alone).tolerance} is asked for`,
    `the intervals of ${listed(undecided.map((one) => one.name))} are their whole ranges.`,
    `taught alone take ${fixed(before(periods), 1)} periods (at least ${fixed(least(periods), 2)} are asked for), and the standard ` +
      `deviation of the groups' knowledge is ${fixed(before(spread), 3)} (at least ${fixed(least(spread), 3)}).`,
    `Here they are ${fixed(here(periods), 1)} and ${fixed(here(spread), 3)}, and the groups take ${fixed(here('periods, group'), 2)} ` +
      `periods (published: ${asked('periods, group').value}).`,
    ...[['assumed ability', 'the assumed ability'], ['nu', 'nu']].map(([name, words]) =>
      undecided.includes(parameter(name)) ? `of ${words}, every value from ${range(name)}` : `of ${words}, not every value fits`,
    ),
    `eta has the interval ${short(parameter('eta').low)} to ${fixed(parameter('eta').high, 3)}`,
  ];
}

export function calibrationClaims(runs) {
  return {
    'knowledge-conflicts-most': () => {
      const { targets, conflicts } = runs.json('calibration');
      const pair = [conflicts[0].first, conflicts[0].second].map((target) => nameOf(targets[target]));
      return pair.join('; ') === 'knowledge, group; knowledge, baseline';
    },
    'parameters-undetermined': () => {
      const open = runs.json('calibration').parameters.filter((one) => one.open_low && one.low <= one.min);
      return open.length === 6 && open.every((one) => one.name === 'eta' || (one.open_high && one.high >= one.max));
    },
  };
}

export function calibrationFigures(runs) {
  const document = () => runs.json('calibration');
  const plain = (name, digits) => () => ({ text: fixed(document()[name], digits), value: document()[name] });
  return {
    'calibration.discrepancy': plain('discrepancy', 1),
    'calibration.misfit': plain('least_misfit', 1),
    'calibration.df': plain('degrees_of_freedom', 1),
    'calibration.p': () => ({ text: probability(document().misfit_p), value: document().misfit_p }),
    'calibration.teams': () => ({ text: String(document().teams) }),
    'calibration.conflict': () => ({ text: fixed(document().conflicts[0].closest, 1), value: document().conflicts[0].closest }),
  };
}
