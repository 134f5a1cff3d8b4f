// The document that kith writes (schema kith.curriculum/1), as far as the page uses it.

// Column and row from the top left, from 1.
export type Place = [number, number];

export interface Part {
  kind: 'wall' | 'terrain' | 'station' | 'destination' | 'goal' | 'start' | 'item';
  name: string;
}

export interface LegendEntry extends Part {
  symbol: string;
  parts?: Part[]; // all that the symbol puts on a cell; `kind` and `name` are the first
}

export interface Item {
  name: string;
  cell: Place;
  carried: boolean;
}

// A state. On a map: where the robot and the things are. Without one: a name.
export interface Frame {
  robot?: Place;
  items?: Item[];
  stations?: Place[];
  state?: string;
  action?: string | null; // that follows; null in the last frame
}

export interface Sentence {
  normal: number[];
  text: string;
}

export interface Board {
  world: number;
  map?: string[]; // absent where the domain has none
  start: Frame;
  frames: Frame[];
}

export interface Flip extends Board {
  text: string;
}

export interface Demonstration extends Board {
  reason: string;
  conveys: Sentence[];
  alternative: { frames: Frame[] } | null;
  decisive: { frame: number; cell?: Place } | null;
  flip: Flip | null;
}

export interface Test extends Board {
  difficulty: 'easy' | 'medium' | 'hard';
  share_right: number;
  covers: Sentence[];
}

export interface Component {
  number: number;
  name: string;
  sentences: Sentence[];
  demonstrations: Demonstration[];
  tests: Test[];
}

export interface Domain {
  id: string;
  title: string;
  features: { name: string; words: string; weight: number }[];
  legend?: LegendEntry[];
  width?: number;
  height?: number;
}

export interface Lesson {
  schema: string;
  title: string;
  program: string;
  seed?: number;
  domain: Domain;
  components: Component[];
  skipped: { name: string; why: string }[];
}

export const kSchema = 'kith.curriculum/1';

// The document inside the page; throws where there is none or of another schema.
export function readLesson(): Lesson {
  const text = document.getElementById('kith-document')?.textContent ?? '';
  const lesson = JSON.parse(text) as Lesson;
  if (lesson.schema !== kSchema) {
    throw new Error(`this page draws documents of schema ${kSchema}, not ${String(lesson.schema)}`);
  }
  return lesson;
}
