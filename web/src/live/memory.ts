// What this tab remembers of feedback for the last page: a board for every sentence, and the first and last prediction.
import type { Judged } from './protocol';
import { keep, recall } from './storage';

export interface Memory {
  boards: Record<string, Judged>; // by sentence
  first: Judged | null;
  last: Judged | null;
}

export const remembered = (): Memory => recall<Memory>('shown') ?? { boards: {}, first: null, last: null };

export function remember(test: Judged): void {
  const memory = remembered();
  for (const text of test.why) memory.boards[text] ??= test;
  if (test.mine) {
    memory.first ??= test;
    memory.last = test;
  }
  keep('shown', memory);
}
