// Regenerates the pages of docs/ whose figures are computed, or checks them. Results with a date, in research/, only if named.
//
//   node tests/validation/validation.mjs KITH --write
//   node tests/validation/validation.mjs KITH --check
//
//   --page FILE   only this page, or a copy of one by the same name (all of docs/)
//   --only NAMES  only these tables, figures, claims and files that quote figures, separated by commas
//   --keep DIR    keep the runs, and use those of the same program that are there
//
// Exits with 0 if the pages agree, 1 if one does not, 2 for a wrong command line. Results are
// deterministic, so any difference fails; each is printed with its size in Monte-Carlo standard errors.
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { basename, dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { parseArgs } from 'node:util';
import { compareTables, describe, findTypedFigures, parsePage, printPage, printTable } from './page.mjs';
import { Runs } from './runs.mjs';
import * as gallery from './gallery_content.mjs';
import * as minds from '../../research/teachers/minds_content.mjs';
import * as teachers from '../../research/teachers/teachers_content.mjs';
import * as validation from './validation_content.mjs';

const source = resolve(dirname(fileURLToPath(import.meta.url)), '../..');

// What fills in a page: {COMMANDS, makeContent}.
const CONTENT = { 'validation.md': validation, 'gallery.md': gallery };
const DATED = { 'teachers.md': teachers, 'minds.md': minds };

function readArguments() {
  const { values, positionals } = parseArgs({
    allowPositionals: true,
    options: {
      write: { type: 'boolean' }, check: { type: 'boolean' }, page: { type: 'string' }, only: { type: 'string' }, keep: { type: 'string' },
    },
  });
  if (positionals.length !== 1 || Boolean(values.write) === Boolean(values.check)) {
    throw new Error('give the program kith, and either --write or --check');
  }
  return { kith: resolve(positionals[0]), ...values };
}

function lookUp(list, what, name) {
  if (!Object.hasOwn(list, name)) throw new Error(`the page has a ${what} '${name}', which its content does not define`);
  return list[name]();
}

// Fills the parts of a page anew; returns them with what differs, a list of lines.
function regenerate(parts, content, wanted) {
  const differences = [];
  const fresh = parts.map((part) => {
    if (!wanted(part.name)) return part;
    if (part.kind === 'table') {
      const table = lookUp(content.tables, 'table', part.name);
      differences.push(...compareTables(part.name, part.text, table).map(describe));
      return { ...part, text: printTable(table) };
    }
    if (part.kind === 'figure') {
      const made = lookUp(content.figures, 'figure', part.name);
      const { text, ...rest } = typeof made === 'string' ? { text: made } : made;
      if (text !== part.text) differences.push(describe({ figure: part.name, printed: part.text, now: text, ...rest }));
      return { ...part, text };
    }
    if (part.kind === 'claim' && !lookUp(content.claims, 'claim', part.name)) part.broken = true;
    return part;
  });
  return { fresh, differences, broken: fresh.filter((part) => part.broken).map((part) => part.name) };
}

// Other files quote figures of this program: what is missing of the sentences {file: [text]} that their comments must
// have, whatever their line breaks.
function missingQuotes(quotes, wanted) {
  const problems = [];
  for (const [file, sentencesOf] of Object.entries(quotes)) {
    if (!wanted(file)) continue;
    const comments = readFileSync(join(source, file), 'utf8').replace(/^[^#\n]*#?/gm, ' ').replace(/\s+/g, ' ');
    for (const sentence of sentencesOf()) {
      if (!comments.includes(sentence)) problems.push(`${file} does not say, but should: ${sentence}`);
    }
  }
  return problems;
}

function update(page, folder, { kith, write, only }) {
  const content = { ...CONTENT, ...DATED }[basename(page)];
  if (!content) throw new Error(`no content is known for a page '${basename(page)}'`);
  const before = readFileSync(page, 'utf8');
  const names = only?.split(',');
  const wanted = (name) => !names || names.includes(name);
  const runs = new Runs(content.COMMANDS, kith, source, folder, (line) => console.error(line));
  const made = content.makeContent(runs, source);
  const { fresh, differences, broken } = regenerate(parsePage(before), made, wanted);
  const problems = [
    ...findTypedFigures(before),
    ...broken.map((name) => `the sentence before 'holds ${name}' is no longer true`),
    ...missingQuotes(made.quotes ?? {}, wanted),
  ];
  const today = new Date().toLocaleDateString('en-GB', { day: 'numeric', month: 'long', year: 'numeric' });
  if (write) writeFileSync(page, printPage(fresh).replace(/^Computed on .*$/m, `Computed on ${today}.`));
  for (const line of [...differences.map((one) => one.line), ...problems]) console.log(line);
  const beyond = differences.filter((one) => one.beyond).length;
  console.log(`${page}: ${differences.length} figures ${write ? 'changed' : 'differ'}, ${beyond} of them beyond chance`);
  return problems.length + (write ? 0 : differences.length);
}

function main({ page, keep, ...options }) {
  const pages = page ? [resolve(page)] : Object.keys(CONTENT).map((name) => join(source, 'docs', name));
  const folder = keep ? resolve(keep) : mkdtempSync(join(tmpdir(), 'validation-'));
  try {
    const problems = pages.map((one) => update(one, folder, options)).reduce((sum, count) => sum + count, 0);
    if (problems && !options.write) console.log('After an intended change: node tests/validation/validation.mjs KITH --write');
    return problems ? 1 : 0;
  } finally {
    if (!keep) rmSync(folder, { recursive: true, force: true });
  }
}

let options;
try {
  options = readArguments();
} catch (error) {
  console.error(`${error.message}\nusage: node validation.mjs KITH --write|--check [--page FILE] [--only NAMES] [--keep DIR]`);
  process.exit(2);
}
try {
  process.exitCode = main(options);
} catch (error) {
  console.error(error.message);
  process.exitCode = 1;
}
