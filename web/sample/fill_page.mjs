// Puts a document into the template, as kith does: for development and tests without kith.
//
//   node sample/fill_page.mjs TEMPLATE DOCUMENT OUT
import { readFileSync, writeFileSync } from 'node:fs';

const [template, document, out] = process.argv.slice(2);
if (!out) {
  console.error('usage: node sample/fill_page.mjs TEMPLATE DOCUMENT OUT');
  process.exit(2);
}
const escapeHtml = (text) => text.replace(/&/g, '&amp;').replace(/</g, '&lt;');
const text = readFileSync(document, 'utf8').trim();
const page = readFileSync(template, 'utf8')
  .replace('/*KITH_REPORT_TITLE*/', () => escapeHtml(JSON.parse(text).title))
  .replace('/*KITH_REPORT_JSON*/', () => text.replaceAll('<', '\\u003c'));
writeFileSync(out, page);
