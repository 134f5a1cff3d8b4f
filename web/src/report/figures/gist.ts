// Text alternatives: what a reader would take from a figure at a glance.
import { type Row, num } from '../document';
import { formatNumber } from '../words';

export function range(rows: Row[], column: string, name: (row: Row) => string): string {
  const known = rows.filter((row) => num(row[column]) !== null);
  if (known.length === 0) return 'No values.';
  const sorted = [...known].sort((a, b) => Number(a[column]) - Number(b[column]));
  const say = (row: Row | undefined): string => (row ? `${formatNumber(Number(row[column]))} (${name(row)})` : '');
  return `Lowest: ${say(sorted[0])}. Highest: ${say(sorted[sorted.length - 1])}.`;
}

// How many there are behind every row, for captions: "n = 15 teams in a cell.", "n = 12 to 15 teams in a cell."
export function counted(rows: Row[], column: string, what: string): string {
  const counts = rows.map((row) => num(row[column])).filter((count): count is number => count !== null);
  if (counts.length === 0) return '';
  const [least, most] = [Math.min(...counts), Math.max(...counts)];
  return `n = ${least === most ? String(least) : `${least} to ${most}`} ${what}.`;
}

// The last value of every series.
export function ends(rows: Row[], x: string, y: string, series: (row: Row) => string): string {
  const last = new Map<string, Row>();
  for (const row of rows) {
    const before = last.get(series(row));
    if (!before || Number(row[x]) >= Number(before[x])) last.set(series(row), row);
  }
  const parts = [...last].map(([name, row]) => `${name} ${formatNumber(Number(row[y]))} at ${String(row[x])}`);
  return `Last values: ${parts.join('; ')}.`;
}
