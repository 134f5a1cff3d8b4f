// The page around this one, if the author named its origin: it is told in messages how far the learner is.
import { isLearned, scoreOf, type Progress } from './door';

export function tellFrame(origins: string[], progress: Progress, log: unknown): void {
  post(origins, { type: 'kith-lesson', event: progress.isFinished ? 'finished' : 'progress', score: scoreOf(progress), learned: isLearned(progress), ...progress, ...(log ? { log } : {}) });
}

/** Somebody did not agree to take part: that, and nothing else. */
export const tellDeclined = (origins: string[]): void => post(origins, { type: 'kith-lesson', event: 'declined' });

function post(origins: string[], message: object): void {
  for (const origin of origins) window.parent.postMessage(message, origin); // browsers deliver it to that origin only
}
