// What every section and figure is made from.
import { type Report, type Row, type Table, factorKeys, firstVariant, toRows } from './document';
import { type Look, Palette } from './palette';
import { Words } from './words';

interface Panels {
  looks: Look[];
  panels: { title: string; means: Row[] }[];
  strategyOf: (row: Row) => string;
}

export class Study {
  readonly words: Words;
  readonly palette: Palette;
  readonly factors: string[];
  readonly hasFixedPeriods: boolean; // of every team as many: nothing to draw

  constructor(readonly report: Report) {
    this.words = new Words(report);
    this.palette = new Palette(report, this.words);
    this.factors = factorKeys(report);
    this.hasFixedPeriods = report.overview.fixed_periods === true;
  }

  // Null where the run's recording level does not give the table, or it has no rows.
  table(name: string): Table | null {
    const table = this.report.tables[name];
    return table && table.rows.length > 0 ? firstVariant(table, this.factors) : null;
  }

  // The distinct codes of a column in the order of first appearance, or in `order` where given.
  codes(rows: Row[], column: string, order: string[] = []): string[] {
    const present = new Set(rows.map((row) => String(row[column])));
    return [...order.filter((code) => present.delete(code)), ...present];
  }

  compositions(rows: Row[]): string[] {
    return this.codes(rows, 'composition', this.report.overview.compositions);
  }

  types(rows: Row[]): string[] {
    return this.codes(rows, 'type', Object.keys(this.report.labels?.types ?? {}));
  }

  looks(rows: Row[]): Look[] {
    return this.palette.looksOf(rows.map((row) => String(row.strategy)));
  }

  // Of a figure with one panel per code of a column, a row per strategy in each.
  panelsBy(column: 'composition' | 'kc', rows: Row[]): Panels {
    const codes = column === 'kc' ? this.codes(rows, column) : this.compositions(rows);
    return {
      looks: this.looks(rows),
      panels: codes.map((code) => ({
        title: column === 'kc' ? componentName(code) : code,
        means: rows.filter((row) => String(row[column]) === code),
      })),
      strategyOf: (row) => this.words.strategy(row.strategy),
    };
  }
}

export const rowsOf = (table: Table): Row[] => toRows(table);

// Components are numbered; the number alone would not say what it counts.
export const componentName = (code: string): string => `Component ${code}`;
