// Writes the table of libs/analysis/tests/reference/README.md, or checks that it is what the tests compute.
//
//   node tests/validation/agreement.mjs KITH_STATS_TESTS --write
//   node tests/validation/agreement.mjs KITH_STATS_TESTS --check
//
// The lines are the property "agreement" of the tests Agreement: procedure|data sets|of each kind|largest differences.
// Differences are rounding errors, which depend on compiler and processor: the page has powers of ten that they stay
// below, with a factor of at least two to spare, and none below 1e-10.
import { updateTestTable } from './test_table.mjs';

const KINDS = ['unbalanced', 'confounded', 'empty cell', 'one row', 'no variance', 'three factors'];

const powerAbove = (difference) => Math.max(-10, Math.ceil(Math.log10(2 * difference)));

// The printed power of ten, while the difference is below it.
const boundOf = (difference, printed) => {
  const power = /^1e(-\d+)$/.exec(printed ?? '');
  return power && difference <= 10 ** Number(power[1]) ? printed : `1e${powerAbove(difference)}`;
};

function tableOf(lines, printed) {
  const before = new Map(
    printed.split('\n').filter((line) => line.startsWith('| ')).map((line) => {
      const cells = line.slice(2, -2).split(' | ');
      return [cells[0], cells];
    }),
  );
  return {
    columns: ['procedure', 'data sets', ...KINDS, 'estimates differ by less than', 'tests differ by less than'],
    rows: lines.map((line) => {
      const [procedure, ...cells] = line.split('|');
      const [estimates, tests] = cells.splice(-2).map(Number);
      const [oldEstimates, oldTests] = before.get(procedure)?.slice(-2) ?? [];
      return [procedure, ...cells.map((count) => (count === '0' ? '' : count)), boundOf(estimates, oldEstimates), boundOf(tests, oldTests)];
    }),
  };
}

updateTestTable({ name: 'agreement', file: 'libs/analysis/tests/reference/README.md', filter: 'Agreement.*', property: 'agreement', tableOf });
