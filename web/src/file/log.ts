// What has happened in a lesson file. It survives a reload where the browser lets pages keep things.
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

const kOfVisit = 'kith.visit.'; // what belongs to a visit to a learning system, which goes on
const tab = uuid(); // of this page, not of the tab: a duplicated tab has the same storage

/** From now on this tab keeps the lesson; those that have it open, too, do not any more. */
export function holdLog(file: LessonFile, learner: string): void {
  try {
    localStorage.setItem(`${place(file, learner)}.tab`, tab);
  } catch {
    // nothing is kept
  }
}

export function holdsLog(file: LessonFile, learner: string): boolean {
  try {
    return (localStorage.getItem(`${place(file, learner)}.tab`) ?? tab) === tab;
  } catch {
    return true;
  }
}

export function emptyLog(file: LessonFile): Log {
  const setup = { ...file.setup, id: uuid() };
  return { schema: 'kith.lesson-log/1', kith: file.kith, study: file.digest, setup, events: [], lessons: [], messages: [] };
}

// Nothing if there is none, or it is one that cannot be gone on with.
export function recalledLog(file: LessonFile, learner: string): Log | null {
  try {
    const log = JSON.parse(localStorage.getItem(place(file, learner)) ?? 'null') as Log | null;
    return log?.schema === 'kith.lesson-log/1' && log.study === file.digest && Array.isArray(log.events) ? log : null;
  } catch {
    return null;
  }
}

/** Whether the browser has kept it. */
export function keepLog(file: LessonFile, learner: string, log: Log): boolean {
  try {
    localStorage.setItem(place(file, learner), JSON.stringify(log));
    return true;
  } catch {
    return false;
  }
}

export function eraseLog(file: LessonFile, learner: string): void {
  try {
    localStorage.removeItem(place(file, learner));
    for (const key of Object.keys(sessionStorage)) if (!key.startsWith(kOfVisit)) sessionStorage.removeItem(key);
  } catch {
    // nothing was kept
  }
}
