// Writes the table of libs/analysis/tests/README.md, or checks that it is what the tests compute.
//
//   node tests/validation/error_rates.mjs KITH_ANALYSIS_TESTS --write
//   node tests/validation/error_rates.mjs KITH_ANALYSIS_TESTS --check
//
// The rates are the property "rates" of the tests FalsePositivesSlow, a line each: analysis|percent|why it is outside 3
// to 7 %.
import { updateTestTable } from './test_table.mjs';

// One row for all tests of an analysis.
function tableOf(lines) {
  const rates = lines.map((line) => {
    const [name, percent, reason] = line.split('|');
    const at = name.lastIndexOf(': ');
    return { analysis: at < 0 ? name : name.slice(0, at), of: at < 0 ? '' : name.slice(at + 2), percent, reason };
  });
  const analyses = [...new Set(rates.map((rate) => rate.analysis))];
  return {
    columns: ['analysis', 'studies in which p < .05, %', 'why fewer or more'],
    rows: analyses.map((analysis) => {
      const own = rates.filter((rate) => rate.analysis === analysis);
      const reasons = [...new Set(own.filter((rate) => Number(rate.percent) < 3 || Number(rate.percent) > 7).map((rate) => rate.reason))];
      return [analysis, own.map((rate) => `${rate.of} ${rate.percent}`.trim()).join('; '), reasons.join('; ')];
    }),
  };
}

updateTestTable({ name: 'false-positives', file: 'libs/analysis/tests/README.md', filter: 'FalsePositivesSlow.*', property: 'rates', tableOf });
