// Files from inside the page: blob addresses work from file:// too.
import type { Cell, Table } from './document';

export function download(blob: Blob, name: string): void {
  const address = URL.createObjectURL(blob);
  const link = document.createElement('a');
  link.href = address;
  link.download = name;
  link.click();
  // Some browsers read the blob only after this task.
  setTimeout(() => URL.revokeObjectURL(address), 10_000);
}

function csvCell(cell: Cell): string {
  const text = cell === null ? '' : String(cell);
  return /[",\n\r]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
}

// Codes and full precision as in the document; an empty field is a missing value.
export function toCsv(table: Table): Blob {
  const lines = [table.columns, ...table.rows].map((row) => row.map(csvCell).join(','));
  return new Blob([`${lines.join('\n')}\n`], { type: 'text/csv' });
}
