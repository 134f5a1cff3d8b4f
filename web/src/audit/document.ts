// The document that kith writes (schema kith.audit/1), as far as the page uses it.
import type { Board, MapDomain } from '../shared/board/types';

export type Understanding = 'misconception' | 'cannot-tell' | 'not-taught' | 'understands';

export interface Misconception {
  probability: number;
  thinks: string;
  fact: string;
  answers: { period: number; test: number; text: string }[];
  show: Board | null; // with the robot's path
  reason: string | null;
}

// What one person understands of one component.
export interface Judged {
  component: number; // from 1
  understanding: Understanding;
  verdict: string; // in words
  doubt: string | null; // why nothing can be told
  level: { mean: number; low: number; high: number };
  periods: number;
  tests: number;
  correct: number;
  misconception: Misconception | null;
  test: Omit<Board, 'frames'> | null;
  advice: string | null;
}

export interface Person {
  title: string;
  group: string;
  caution: string | null;
  knows: number | null;
  believes_older?: number;
  kind?: string;
  kinds?: Record<string, number>;
  components: Judged[];
}

export interface Audit {
  schema: string;
  name: string; // of the folder with the answers
  program: string;
  domain: MapDomain;
  enough: number;
  sure: number;
  coverage: number;
  forgetting: number;
  says: string;
  groups: { group: string; says: string }[];
  components: { number: number; name: string; understand: number; cannot_tell: number; misconception: number; not_taught: number }[];
  misconceptions: { component: number; fact: string; thinks: string[]; people: number }[];
  people: Person[];
}
