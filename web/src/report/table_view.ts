// A document's table as an accessible table that scrolls inside its own box.
import type { Table } from './document';
import { el } from '../shared/dom';
import type { Words } from './words';

export function tableView(table: Table, caption: string, words: Words): HTMLElement {
  const isNumber = table.columns.map((_, i) => table.rows.some((row) => typeof row[i] === 'number'));
  const align = (i: number): string | undefined => (isNumber[i] ? 'number' : undefined);
  const head = el(
    'tr',
    {},
    ...table.columns.map((name, i) => el('th', { scope: 'col', class: align(i) }, words.column(name))),
  );
  const body = table.rows.map((row) =>
    el(
      'tr',
      {},
      ...row.map((cell, i) => {
        const text = words.cell(table.columns[i] ?? '', cell);
        return i === 0 ? el('th', { scope: 'row', class: align(i) }, text) : el('td', { class: align(i) }, text);
      }),
    ),
  );
  // Focusable, so that the keyboard can scroll it; a focusable region needs a name.
  return el(
    'div',
    { class: 'scroll', tabindex: 0, role: 'region', 'aria-label': `Table: ${caption}` },
    el('table', {}, el('caption', {}, caption), el('thead', {}, head), el('tbody', {}, ...body)),
  );
}
