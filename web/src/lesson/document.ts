// The document that kith writes (schema kith.curriculum/1), as far as the page uses it.
import type { Board, Frame, MapDomain, Path, Place } from '../shared/board/types';

export interface Sentence {
  normal: number[];
  text: string;
}

export interface Flip extends Board {
  text: string;
}

// Several runs of the robot, with outcomes as they fell, and what happened in how many of them.
export interface Runs {
  text: string;
  runs: { frames: Frame[]; ended: boolean }[];
}

export interface Demonstration extends Board {
  runs: Runs | null; // nothing where chance has no part
  reason: string;
  conveys: Sentence[];
  alternative: Path | null;
  decisive: { frame: number; cell?: Place } | null;
  flip: Flip | null;
}

export interface Test extends Board {
  runs: Runs | null;
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

export interface Domain extends MapDomain {
  title: string;
  features: { name: string; words: string; weight: number }[];
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
