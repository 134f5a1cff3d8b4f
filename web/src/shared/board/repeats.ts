// Paths that never end: a way in, and a cycle that is gone round for ever.
import type { Frame, Path } from './types';

// As it is played: the cycle twice, and then it stops.
export function played({ frames, repeats_from }: Path): Frame[] {
  return repeats_from === undefined ? frames : [...frames.slice(0, -1), ...frames.slice(repeats_from)];
}

// The step with which the cycle is closed for the first time: as far as the path is drawn.
export function closedAt({ frames, repeats_from }: Path): number | undefined {
  return repeats_from === undefined ? undefined : frames.length - 1;
}
