// What every section and figure is made from.
import { type Report, type Row, type Table, toRows } from './document';
import { type Look, Palette } from './palette';
import { baseOf, Words } from './words';

interface Facet {
  title: string;
  rows: Row[];
}

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
    this.factors = report.overview.factors ?? [];
    this.hasFixedPeriods = report.overview.fixed_periods === true;
  }

  // Null where the run's recording level does not give the table, or it has no rows.
  table(name: string): Table | null {
    const table = this.report.tables[name];
    return table && table.rows.length > 0 ? table : null;
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

  // Strategies without the setting of what the study varies, which stands beside them.
  rows(table: Table): Row[] {
    return toRows(table).map((row) => ({ ...row, strategy: baseOf(String(row.strategy)), setting: this.words.setting(row.strategy) }));
  }

  // A panel per code of a column, and per setting of what the study varies.
  facets(rows: Row[], column: 'composition' | 'type' | 'kc'): Facet[] {
    const codes = { composition: this.compositions(rows), type: this.types(rows), kc: this.codes(rows, 'kc') }[column];
    const name = (code: string): string => (column === 'type' ? this.words.type(code) : column === 'kc' ? componentName(code) : code);
    const settings = [...new Set(rows.map(({ setting }) => setting ?? ''))];
    const isOne = codes.length === 1 && settings.length > 1;
    return codes
      .flatMap((code) =>
        settings.map((setting) => ({
          title: [isOne ? '' : name(code), setting].filter(Boolean).join(', '),
          rows: rows.filter((row) => String(row[column]) === code && (row.setting ?? '') === setting),
        })),
      )
      .filter((facet) => facet.rows.length > 0);
  }

  // Of a figure with a row per strategy in every panel.
  panelsBy(column: 'composition' | 'kc', rows: Row[]): Panels {
    return {
      looks: this.looks(rows),
      panels: this.facets(rows, column).map(({ title, rows: means }) => ({ title, means })),
      strategyOf: (row) => this.words.strategy(row.strategy),
    };
  }
}

export const rowsOf = (table: Table): Row[] => toRows(table);

// Components are numbered; the number alone would not say what it counts.
export const componentName = (code: string): string => `Component ${code}`;
