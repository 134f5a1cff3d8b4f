// A table of a page that a test program computes: the lines of a property of its tests.
//
// The programs that use it take TEST_PROGRAM --write|--check and exit with 0 if the page agrees, 1 if it does not or a
// test fails, 2 for a wrong command line. `--page FILE` takes a copy of the page instead.
import { spawnSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { basename, dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { parseArgs } from 'node:util';
import { compareTables, parsePage, printPage, printTable } from './page.mjs';

const source = resolve(dirname(fileURLToPath(import.meta.url)), '../..');

// The lines of a property of all tests that the filter names.
function linesOf(program, filter, property) {
  const folder = mkdtempSync(join(tmpdir(), 'test-table-'));
  try {
    const file = join(folder, 'tests.json');
    const { status, stdout } = spawnSync(program, [`--gtest_filter=${filter}`, `--gtest_output=json:${file}`], { encoding: 'utf8' });
    if (status !== 0) throw new Error(`the tests fail:\n${stdout}`);
    const tests = JSON.parse(readFileSync(file, 'utf8')).testsuites.flatMap((suite) => suite.testsuite);
    return tests.flatMap((test) => test[property].trimEnd().split('\n'));
  } finally {
    rmSync(folder, { recursive: true, force: true });
  }
}

// `file` is the page; `tableOf` makes the table of the lines and gets the printed one, too: rows of texts.
export function updateTestTable({ name, file, filter, property, tableOf }) {
  let values, positionals;
  try {
    ({ values, positionals } = parseArgs({
      allowPositionals: true,
      options: { write: { type: 'boolean' }, check: { type: 'boolean' }, page: { type: 'string' } },
    }));
    if (positionals.length !== 1 || Boolean(values.write) === Boolean(values.check)) throw new Error('give the tests, and either --write or --check');
  } catch (error) {
    console.error(`${error.message}\nusage: node ${basename(process.argv[1])} TEST_PROGRAM --write|--check [--page FILE]`);
    process.exitCode = 2;
    return;
  }
  const page = values.page ? resolve(values.page) : join(source, file);
  const parts = parsePage(readFileSync(page, 'utf8'));
  const part = parts.find((one) => one.kind === 'table' && one.name === name);
  if (!part) throw new Error(`${page} has no table '${name}'`);
  const table = tableOf(linesOf(resolve(positionals[0]), filter, property), values.check ? part.text : '');
  const differences = compareTables(name, part.text, table);
  if (values.write) {
    part.text = printTable(table);
    writeFileSync(page, printPage(parts));
  }
  for (const { figure, printed, now } of differences) console.log(`${figure}: the page has ${printed}, now ${now}`);
  process.exitCode = values.check && differences.length > 0 ? 1 : 0;
}
