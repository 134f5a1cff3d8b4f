// Accessible tables that scroll inside their own box.
import type { ResultTable, Table } from './document';
import { el } from '../shared/dom';
import { type Words, formatResult } from './words';

interface Shown {
  caption: string;
  heads: string[];
  isNumber: boolean[]; // per column
  rows: string[][];
}

function view({ caption, heads, isNumber, rows }: Shown): HTMLElement {
  const align = (i: number): string | undefined => (isNumber[i] ? 'number' : undefined);
  const head = el('tr', {}, ...heads.map((name, i) => el('th', { scope: 'col', class: align(i) }, name)));
  const body = rows.map((row) =>
    el(
      'tr',
      {},
      ...row.map((text, i) =>
        i === 0 ? el('th', { scope: 'row', class: align(i) }, text) : el('td', { class: align(i) }, text),
      ),
    ),
  );
  // Focusable, so that the keyboard can scroll it; a focusable region needs a name.
  return el(
    'div',
    { class: 'scroll', tabindex: 0, role: 'region', 'aria-label': `Table: ${caption}` },
    el('table', {}, el('caption', {}, caption), el('thead', {}, head), el('tbody', {}, ...body)),
  );
}

// A table of the document.
export function tableView(table: Table, caption: string, words: Words): HTMLElement {
  return view({
    caption,
    heads: table.columns.map((name) => words.column(name)),
    isNumber: table.columns.map((_, i) => table.rows.some((row) => typeof row[i] === 'number')),
    rows: table.rows.map((row) => row.map((cell, i) => words.cell(table.columns[i] ?? '', cell))),
  });
}

// A table of tests; its heads are words already.
export function resultTableView({ caption, columns, rows }: ResultTable): HTMLElement {
  return view({
    caption,
    heads: columns.map(({ name }) => name),
    isNumber: columns.map(({ kind }) => kind !== 'text'),
    rows: rows.map((row) => columns.map(({ field, kind }) => formatResult(row[field], kind))),
  });
}
