// The tables and figures of the page's section on calibration, made of one document of `kith calibrate --json`.
import { figure, fixed, percent, probability, signed, withError } from './format.mjs';

const short = (value) => String(Number(value.toPrecision(3)));

const nameOf = (target) =>
  target.effect ? `F of ${target.effect}` : `${target.statistic === 'sd' ? 'sd of ' : ''}${target.quantity}, ${target.teams}`;

const digitsOf = (target) => (target.effect ? 1 : target.quantity === 'periods' ? 2 : 3);

// Values of a setting and its simulated figures, the first four of the targets, which are means.
const MEANS = 4;
const simulated = (document, point) =>
  document.targets.slice(0, MEANS).map((target, i) =>
    withError({ value: point.targets[i].model, se: point.targets[i].standard_error }, digitsOf(target)),
  );

function rangeOf({ low, high, min, max, open_low: openLow, open_high: openHigh }) {
  const [noLow, noHigh] = [openLow && low <= min, openHigh && high >= max];
  const end = noLow && noHigh ? ', the whole range' : noLow ? ', no lower limit' : noHigh ? ', no upper limit' : '';
  return `${openLow && !noLow ? '<= ' : ''}${short(low)} .. ${openHigh && !noHigh ? '>= ' : ''}${short(high)}${end}`;
}

export function calibrationTables(runs) {
  const document = () => runs.json('calibration');
  return {
    'calibration-parameters': () => ({
      columns: ['parameter', 'default', 'searched', 'calibrated', '95 % interval, the others adjusted'],
      rows: document().parameters.map((one) => [
        one.name,
        short(one.present),
        `${short(one.min)} .. ${short(one.max)}`,
        { text: short(one.value), value: one.value, se: (one.high - one.low) / (2 * 1.96) },
        { text: rangeOf(one) },
      ]),
    }),

    'calibration-targets': () => ({
      columns: ['target', 'published', 'its standard error', 'calibrated', 'off by, in standard errors of the difference'],
      rows: document().targets.map((target, i) => {
        const { model, standard_error: se, misfit } = document().best.targets[i];
        return [
          nameOf(target),
          String(target.value),
          target.standard_error === null ? '' : fixed(target.standard_error, digitsOf(target) + 1),
          withError({ value: model, se }, digitsOf(target)),
          figure({ value: misfit, se: target.standard_error > 0 ? se / target.standard_error : undefined }, 1, signed),
        ];
      }),
    }),

    'calibration-candidates': () => {
      const { candidates, parameters, targets } = document();
      return {
        columns: ['candidate', 'misfit', ...parameters.map((one) => one.name), ...targets.slice(0, MEANS).map(nameOf)],
        rows: candidates.map((one) => [
          one.label,
          { text: fixed(one.misfit, 2), value: one.misfit },
          ...parameters.map(({ name }) => short(one.values[name])),
          ...simulated(document(), one),
        ]),
      };
    },

    'calibration-shares': () => {
      const { parameters, targets } = document();
      return {
        columns: ['share of variance (change over the whole range)', ...parameters.map((one) => one.name), 'predicted'],
        rows: targets.map((target) => [
          nameOf(target),
          ...parameters.map(({ name }) => {
            const { total_share: share, slope } = target.sensitivity[name];
            return { text: `${percent(share)} (${signed(slope, digitsOf(target))})`, value: 100 * share };
          }),
          { text: percent(target.sensitivity_explained), value: 100 * target.sensitivity_explained },
        ]),
      };
    },

    'calibration-conflicts': () => ({
      columns: ['pair', 'one of both misses by at least, in standard errors'],
      rows: document().conflicts.map(({ first, second, closest }) => [
        `${nameOf(document().targets[first])}; ${nameOf(document().targets[second])}`,
        { text: fixed(closest, 1), value: closest },
      ]),
    }),

    'calibration-frontier': () => {
      const { frontier, targets } = document();
      const quantities = Object.keys(frontier[0]?.errors ?? {}).sort((a) => (a === targets[0].quantity ? -1 : 1));
      return {
        columns: [...quantities.map((one) => `error of ${one}`), ...targets.slice(0, MEANS).map(nameOf)],
        rows: frontier.map((one) => [
          ...quantities.map((quantity) => ({ text: fixed(one.errors[quantity], 2), value: one.errors[quantity] })),
          ...simulated(document(), one),
        ]),
      };
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
  };
}
