// The document that kith writes (schema kith.report/1), as far as the page uses it.
import type { Vector } from '../shared/sphere';
import type { TaughtAgain } from '../file/again';
import type { Lessons } from './team/lessons';

export type Cell = string | number | boolean | null;
export type Row = Record<string, Cell>;

export interface Table {
  columns: string[];
  rows: Cell[][];
}

// A table of a test: rows have a value for the field of every column.
export interface ResultTable {
  caption: string;
  columns: { field: string; name: string; kind: ResultKind }[];
  rows: Row[];
}
export type ResultKind = 'text' | 'count' | 'number' | 'fraction' | 'p';

// A question of the study: the size of an effect with its 95 % interval, or what any two levels differ by at most.
export interface Answer {
  question: string;
  outcome: string;
  means?: string;
  compared?: string;
  estimate: number | null;
  low: number | null;
  high: number | null;
  bound: number | null;
  digits: number;
  p: number | null;
  answer: string;
  finding?: string; // the id of the test
}

export interface Difference {
  estimate: number | null;
  low: number | null;
  high: number | null;
  n: number;
}

// Strategies, and compositions, against one of them.
export interface Differences {
  interval: string;
  outcomes: { name: string; digits: number }[];
  groups: {
    factor: 'strategy' | 'composition';
    against: string;
    rows: { code: string; differences: Difference[] }[]; // one difference per outcome
  }[];
}

export interface Finding {
  id: string;
  title: string;
  question?: string;
  sentence: string;
  results?: string; // as a results section of a paper reports it
  warnings?: string[];
  tables?: ResultTable[];
}

// What is measured about a team: a column of the tables of teams and, with _mean, _low and _high, of cells.
export interface Outcome {
  column: string;
  name: string;
  axis: string;
  better: string; // what a better way of teaching leads to
  meaning: string;
  digits: number;
  less_is_better: boolean;
  of_exam: boolean;
  high: number | null; // null: as large as may be
}

// Two things that a study varies against each other: a row of the table per combination.
export interface Matrix {
  factors: [string, string];
  outcomes: Outcome[];
  table: Table;
}

export interface Reference {
  key: string;
  text: string;
  bibtex?: string;
}


export interface BeliefTeam {
  title: string;
  team?: number;
  why?: string;
  strategy?: string;
  composition?: string;
  periods: number;
  components: number[];
  beliefs: { name: string; kind: string }[];
  mass: (number | null)[][]; // [frame][belief]
  particles: { bits: number; count: number; data: string };
}

export interface Beliefs {
  features: string[];
  truth: Vector;
  regions: { label: string; outline: Vector[] }[];
  teams: BeliefTeam[];
}

export interface Report {
  schema: string;
  title: string;
  study: string;
  domain: string;
  version?: string;
  created?: string;
  labels?: {
    strategies?: Record<string, string>;
    types?: Record<string, string>;
    meanings?: { strategies?: Record<string, string>; compositions?: Record<string, string> };
    columns?: Record<string, string>;
    figures?: Record<string, { title?: string; reading?: string }>; // in place of the page's own, by figure
  };
  overview: {
    simulated?: boolean;
    teams?: number;
    people?: number;
    completed?: number;
    done?: string; // what those have come to: "passed all tests"
    fixed_periods?: boolean; // every team had as many
    skipped?: number;
    replicates?: number;
    seed?: string | number;
    strategies: string[];
    compositions: string[];
    factors?: string[]; // keys that the study varies: every setting makes a strategy of its own
    finding?: string; // what was found, in one sentence
    summary?: string[]; // what was done, in plain sentences
    answers?: Answer[];
    differences?: Differences;
    limits?: string[]; // what the study cannot say
    leads?: 'exam'; // its figures come first: knowledge says little with more than three features
  };
  notes?: string[];
  outcomes: Outcome[];
  tables: Record<string, Table | undefined>;
  matrices?: Matrix[];
  findings?: Finding[];
  methods?: { paragraph: string; references?: Reference[] };
  reproduce?: {
    command?: string;
    version?: string;
    study_toml?: string;
    domain_toml?: string;
    hashes?: Record<string, string>;
  };
  beliefs?: Beliefs;
  lessons?: Lessons;
  again?: TaughtAgain; // with the engine of lesson files in the page
}

export const kSchema = 'kith.report/1';

// The document inside the page; throws where there is none or of another schema.
export function readReport(): Report {
  const text = document.getElementById('kith-document')?.textContent ?? '';
  const report = JSON.parse(text) as Report;
  if (report.schema !== kSchema) {
    throw new Error(`this page draws documents of schema ${kSchema}, not ${String(report.schema)}`);
  }
  return report;
}

export function toRows(table: Table): Row[] {
  return table.rows.map((row) => Object.fromEntries(table.columns.map((name, i) => [name, row[i] ?? null])));
}

export const num = (cell: Cell | undefined): number | null =>
  typeof cell === 'number' && Number.isFinite(cell) ? cell : null;
