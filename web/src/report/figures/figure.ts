// What a figure is: its words, its data and how it is drawn at a given width.
import type { Spec } from '../chart';
import type { Table } from '../document';

export interface Figure {
  id: string; // also the name of saved files
  title: string;
  reading: string; // one sentence: how to read it
  gist: string; // the text alternative
  table: Table;
  raw?: { what: string; table: Table } | undefined; // single observations behind the table, to save only
  spec(width: number): Spec;
}
