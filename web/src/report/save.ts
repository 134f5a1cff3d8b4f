// Tables as CSV files.
import type { Cell, Table } from './document';

function csvCell(cell: Cell): string {
  const text = cell === null ? '' : String(cell);
  return /[",\n\r]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
}

// Codes and full precision as in the document; an empty field is a missing value.
export function toCsv(table: Table): Blob {
  const lines = [table.columns, ...table.rows].map((row) => row.map(csvCell).join(','));
  return new Blob([`${lines.join('\n')}\n`], { type: 'text/csv' });
}
