// The boards of a lesson, one after the other: none twice, and of a long lesson first those that teach most.
import type { Demonstration, Lesson, Test } from './document';

export interface Card {
  name: string; // names what was predicted on it
  kind: 'Example' | 'Test' | 'New board';
  shown: Demonstration | Test;
}

export const isExample = (shown: Card['shown']): shown is Demonstration => 'reason' in shown;

// What a lesson begins with, and what is offered when that is over.
export function cardsOf({ components, fresh }: Lesson): { first: Card[]; more: Card[] } {
  const seen = new Set<string>();
  const isNew = ({ shown: { world, state, frames } }: Card): boolean => {
    const start = JSON.stringify([world, state, frames[0]]);
    return !seen.has(start) && seen.add(start).size > 0;
  };
  const all = components
    .flatMap(({ number, demonstrations, tests }) => [
      ...demonstrations.map((shown, i): Card => ({ name: `example.${number}.${i}`, kind: 'Example', shown })),
      ...tests.map((shown, i): Card => ({ name: `test.${number}.${i}`, kind: 'Test', shown })),
    ])
    .filter(isNew);
  const unseen = fresh.map((shown, i): Card => ({ name: `fresh.${i}`, kind: 'New board', shown })).filter(isNew);
  return { first: all.filter(({ shown }) => shown.first), more: [...all.filter(({ shown }) => !shown.first), ...unseen] };
}

// Mistakes are of one kind if they have too much and too little of the same things.
export const kindOf = (robot: number[], mine: number[]): string => robot.map((n, k) => Math.sign((mine[k] ?? 0) - n)).join();

// Whether the last answer was the second mistake of its kind: time to ask in another way.
export function isSameAgain(kinds: (string | null)[]): boolean {
  const counts = new Map<string | null, number>();
  for (const kind of kinds) counts.set(kind, (counts.get(kind) ?? 0) + 1);
  const last = kinds.at(-1) ?? null;
  return last !== null && (counts.get(last) ?? 0) % 2 === 0;
}
