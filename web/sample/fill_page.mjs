// Puts a document into the template, as kith does: for development and tests without kith.
//
//   node sample/fill_page.mjs TEMPLATE DOCUMENT OUT
import { readFileSync, writeFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';

const escapeHtml = (text) => text.replace(/&/g, '&amp;').replace(/</g, '&lt;');

// Replacements are functions: in a string, `$&` and the like would be expanded.
export function fillPage(template, document) {
  return template
    .replace('/*KITH_REPORT_TITLE*/', () => escapeHtml(String(JSON.parse(document).title)))
    .replace('/*KITH_REPORT_JSON*/', () => document.trim().replaceAll('<', '\\u003c'));
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  const [template, document, out] = process.argv.slice(2);
  if (!out) {
    console.error('usage: node sample/fill_page.mjs TEMPLATE DOCUMENT OUT');
    process.exit(2);
  }
  writeFileSync(out, fillPage(readFileSync(template, 'utf8'), readFileSync(document, 'utf8')));
}
