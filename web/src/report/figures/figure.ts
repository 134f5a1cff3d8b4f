// What a figure is: its words, its data and how it is drawn at a given width.
import type { Spec } from '../chart';
import type { Table } from '../document';

export interface Figure {
  id: string; // also the name of saved files
  title: string;
  reading: string; // one sentence: how to read it
  gist: string; // the text alternative
  table: Table;
  spec(width: number): Spec;
}
