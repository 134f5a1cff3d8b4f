// Writes the table of false-positive rates into docs/analysis.md, or checks that it is what the tests compute.
//
//   node tests/validation/error_rates.mjs KITH_ANALYSIS_TESTS --write
//   node tests/validation/error_rates.mjs KITH_ANALYSIS_TESTS --check
//
// The rates are the property "rates" of the tests FalsePositivesSlow, a line each: analysis|percent|why it is low.
// Exits with 0 if the page agrees, 1 if it does not or a test fails, 2 for a wrong command line.
import { spawnSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { compareTables, parsePage, printPage, printTable } from './page.mjs';

const source = resolve(dirname(fileURLToPath(import.meta.url)), '../..');
const NAME = 'false-positives';

function ratesOf(program) {
  const folder = mkdtempSync(join(tmpdir(), 'error-rates-'));
  try {
    const file = join(folder, 'tests.json');
    const { status, stdout } = spawnSync(program, ['--gtest_filter=FalsePositivesSlow.*', `--gtest_output=json:${file}`], { encoding: 'utf8' });
    if (status !== 0) throw new Error(`the tests fail:\n${stdout}`);
    const tests = JSON.parse(readFileSync(file, 'utf8')).testsuites.flatMap((suite) => suite.testsuite);
    return tests.flatMap((test) => test.rates.trimEnd().split('\n')).map((line) => {
      const [name, percent, reason] = line.split('|');
      const at = name.lastIndexOf(': ');
      return { analysis: at < 0 ? name : name.slice(0, at), of: at < 0 ? '' : name.slice(at + 2), percent, reason };
    });
  } finally {
    rmSync(folder, { recursive: true, force: true });
  }
}

// One row for all tests of an analysis.
function tableOf(rates) {
  const analyses = [...new Set(rates.map((rate) => rate.analysis))];
  return {
    columns: ['analysis', 'studies in which p < .05, %', 'why fewer'],
    rows: analyses.map((analysis) => {
      const own = rates.filter((rate) => rate.analysis === analysis);
      const reasons = [...new Set(own.filter((rate) => Number(rate.percent) < 3).map((rate) => rate.reason))];
      return [analysis, own.map((rate) => `${rate.of} ${rate.percent}`.trim()).join('; '), reasons.join('; ')];
    }),
  };
}

const [program, mode] = process.argv.slice(2);
if (!program || !['--write', '--check'].includes(mode)) {
  console.error('usage: node error_rates.mjs KITH_ANALYSIS_TESTS --write|--check');
  process.exit(2);
}
const page = join(source, 'docs/analysis.md');
const parts = parsePage(readFileSync(page, 'utf8'));
const part = parts.find((one) => one.name === NAME);
const table = tableOf(ratesOf(resolve(program)));
const differences = compareTables(NAME, part.text, table);
if (mode === '--write') {
  part.text = printTable(table);
  writeFileSync(page, printPage(parts));
}
for (const { figure, printed, now } of differences) console.log(`${figure}: the page has ${printed}, now ${now}`);
process.exitCode = mode === '--check' && differences.length > 0 ? 1 : 0;
