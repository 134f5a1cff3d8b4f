// What has happened in a lesson file. It survives a reload where the browser lets pages keep things.
import { forgetPerson } from '../live/storage';
import { attempt } from '../shared/attempt';
import { uuid } from '../shared/uuid';
import type { LessonFile } from './document';
import type { Lesson } from './engine';

export interface Log {
  schema: 'kith.lesson-log/1';
  kith: string; // the version that made the file
  study: string; // digest of its inputs
  setup: Record<string, unknown>;
  events: unknown[];
  lessons: Lesson[];
  messages: string[]; // of the page that were taken in
}

// Of one learner, where the system around the page says who it is.
const place = (file: LessonFile, learner: string): string => `kith.lesson.${file.digest}${learner && `.${learner}`}`;

const tab = uuid(); // of this page, not of the tab: a duplicated tab has the same storage

/** From now on this tab keeps the lesson; those that have it open, too, do not any more. */
export function holdLog(file: LessonFile, learner: string): void {
  attempt(() => localStorage.setItem(`${place(file, learner)}.tab`, tab));
}

export const holdsLog = (file: LessonFile, learner: string): boolean =>
  (attempt(() => localStorage.getItem(`${place(file, learner)}.tab`)) ?? tab) === tab;

export function emptyLog(file: LessonFile): Log {
  const setup = { ...file.setup, id: uuid() };
  return { schema: 'kith.lesson-log/1', kith: file.kith, study: file.digest, setup, events: [], lessons: [], messages: [] };
}

// Nothing if there is none, or it is one that cannot be gone on with.
export function recalledLog(file: LessonFile, learner: string): Log | null {
  const log = attempt(() => JSON.parse(localStorage.getItem(place(file, learner)) ?? 'null') as Log | null);
  return log?.schema === 'kith.lesson-log/1' && log.study === file.digest && Array.isArray(log.events) ? log : null;
}

/** Whether the browser has kept it. */
export const keepLog = (file: LessonFile, learner: string, log: Log): boolean =>
  attempt(() => localStorage.setItem(place(file, learner), JSON.stringify(log))) !== null;

export function eraseLog(file: LessonFile, learner: string): void {
  attempt(() => localStorage.removeItem(place(file, learner)));
  forgetPerson();
}
