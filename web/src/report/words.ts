// How codes and numbers are written.
import type { Cell, Report, ResultKind } from './document';

const kMinus = '\u2212';

// At most four significant digits, and no trailing zeros that say nothing.
export function formatNumber(value: number): string {
  if (Number.isInteger(value) && Math.abs(value) < 1e15) return String(value).replace('-', kMinus);
  const size = Math.abs(value);
  if (size < 1e-4 || size >= 1e6) return value.toExponential(2).replace('e', ' e').replaceAll('-', kMinus);
  const digits = size >= 1000 ? 1 : size >= 100 ? 1 : size >= 10 ? 2 : size >= 0.1 ? 3 : 4;
  return value.toFixed(digits).replace('-', kMinus);
}

export function formatFixed(value: number | null | undefined, digits: number): string {
  return value === null || value === undefined ? 'unknown' : value.toFixed(digits).replace('-', kMinus);
}

// Probabilities by name of column, so that a tiny one is not shown as 0.
export function formatP(value: number): string {
  return value < 0.001 ? '< 0.001' : value.toFixed(3);
}

// A number of a test's table as `kith analyze` prints it: three decimals, or four significant digits if those are fewer.
function formatStatistic(value: number): string {
  const size = Math.abs(value);
  if (size === 0) return '0';
  if (size < 1e-4 || size >= 1e7) return value.toExponential(2);
  const magnitude = Math.floor(Math.log10(size));
  return value.toFixed(magnitude < -2 ? 1 - magnitude : Math.min(3, Math.max(0, 3 - magnitude)));
}

export function formatResult(value: Cell | undefined, kind: ResultKind): string {
  if (value === undefined) return ''; // does not apply to this row
  if (value === null) return 'not estimable';
  if (typeof value === 'boolean') return value ? 'yes' : 'no';
  if (typeof value === 'string') return value;
  const text =
    kind === 'count'
      ? String(value)
      : kind === 'p'
        ? value < 0.0005
          ? '< 0.001'
          : value.toFixed(3)
        : kind === 'fraction'
          ? value.toFixed(3)
          : formatStatistic(value);
  return text.replaceAll('-', kMinus);
}

// "joint [teacher.process_noise=0.5]": joint.
export const baseOf = (code: string): string => code.replace(/ \[.*$/, '');

const isP = (column: string): boolean => /^p(\b|_)|_p$/i.test(column);

export class Words {
  private readonly strategies: Record<string, string>;
  private readonly types: Record<string, string>;
  private readonly columns: Record<string, string>;
  private readonly meanings: { strategies?: Record<string, string>; compositions?: Record<string, string> };

  constructor(report: Report) {
    this.strategies = { ...report.labels?.strategies };
    for (const [code, label] of Object.entries(this.strategies)) this.strategies[baseOf(code)] ??= label.split(', ')[0] ?? label;
    this.types = report.labels?.types ?? {};
    this.columns = report.labels?.columns ?? {};
    this.meanings = report.labels?.meanings ?? {};
  }

  strategy(code: Cell | undefined): string {
    const name = String(code ?? '');
    return this.strategies[name] ?? name;
  }

  // "process noise 0.5"; empty unless the study varies something.
  setting(code: Cell | undefined): string {
    const name = String(code ?? '');
    return baseOf(name) === name ? '' : this.strategy(name).slice(this.strategy(baseOf(name)).length + 2);
  }

  // What a strategy does: "for the member who knows least"; empty if the document does not say it.
  plainStrategy(code: string): string {
    return (this.meanings.strategies?.[code] ?? '').replace(/^teach (for )/, '$1');
  }

  // Who is in a team: "2 novice, 1 proficient".
  plainComposition(code: string): string {
    return this.meanings.compositions?.[code] ?? '';
  }

  // What the letters of compositions stand for, for captions: "N: novice, P: proficient."
  letters(): string {
    const named = Object.entries(this.types).filter(([letter, name]) => letter !== name);
    return named.length > 0 ? `${named.map(([letter, name]) => `${letter}: ${name}`).join(', ')}.` : '';
  }

  // Capitalised, since it stands alone as a heading of a panel.
  type(code: Cell | undefined): string {
    const name = this.types[String(code ?? '')] ?? String(code ?? '');
    return name.charAt(0).toUpperCase() + name.slice(1);
  }

  column(name: string): string {
    return this.columns[name] ?? name.replaceAll('_', ' ').replace(/^./, (letter) => letter.toUpperCase());
  }

  cell(column: string, value: Cell): string {
    if (value === null) return '\u2013';
    if (column === 'strategy') return this.strategy(value);
    if (column === 'type') return this.type(value);
    if (typeof value === 'boolean') return value ? 'yes' : 'no';
    if (typeof value === 'number') return isP(column) ? formatP(value) : formatNumber(value);
    return value;
  }
}

export const plural = (count: number, one: string): string => `${count} ${one}${count === 1 ? '' : 's'}`;

export function listOf(items: string[]): string {
  return items.length < 2 ? items.join('') : `${items.slice(0, -1).join(', ')} and ${items[items.length - 1]}`;
}
