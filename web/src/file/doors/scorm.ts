// A learning system that speaks SCORM 1.2 or 2004: an object of functions in a page around this one.
import { forget, keep, recall } from '../../live/storage';
import { isLearned, isLoadedAgain, scoreOf, VisitIsOver, type Door, type Opening, type Progress } from './door';

type Api = Record<string, (...words: string[]) => unknown>;
const kStatuses = ['incomplete', 'completed', 'passed']; // the later, the better

// What the two versions call the same things.
interface Version {
  object: string;
  prefix: string; // of functions
  finish: string;
  core: string; // prefix of values
  learner: string;
  mode: string;
  statuses: string[]; // where a status is read: the best one counts
  statusOf: (status: string) => Record<string, string>;
  timeOf: (ms: number) => string;
  room: number; // characters that every system keeps
}

function clock(ms: number): string {
  const two = (n: number): string => String(n).padStart(2, '0');
  const hundredths = Math.floor(ms / 10);
  const seconds = Math.floor(hundredths / 100);
  return `${String(Math.min(9999, Math.floor(seconds / 3600))).padStart(4, '0')}:${two(Math.floor(seconds / 60) % 60)}:${two(seconds % 60)}.${two(hundredths % 100)}`;
}

const kVersions: Version[] = [
  {
    ...{ object: 'API', prefix: 'LMS', finish: 'LMSFinish', core: 'cmi.core.', learner: 'cmi.core.student_id', mode: 'cmi.core.lesson_mode' },
    statuses: ['cmi.core.lesson_status'],
    statusOf: (status) => ({ 'cmi.core.lesson_status': status }),
    timeOf: clock,
    room: 4096,
  },
  {
    ...{ object: 'API_1484_11', prefix: '', finish: 'Terminate', core: 'cmi.', learner: 'cmi.learner_id', mode: 'cmi.mode' },
    statuses: ['cmi.success_status', 'cmi.completion_status'],
    statusOf: (status) => ({ 'cmi.completion_status': status === 'incomplete' ? status : 'completed', ...(status === 'passed' ? { 'cmi.success_status': status } : {}) }),
    timeOf: (ms) => `PT${(ms / 1000).toFixed(2)}S`,
    room: 64000,
  },
];
const kMostWindows = 500;

// Windows around this one and those that opened one of them, nearer ones first.
function windowsAround(): Window[] {
  const all: Window[] = [window];
  for (const place of all) {
    for (const next of [place.parent, place.opener as Window | null]) {
      if (next && !all.includes(next) && all.length < kMostWindows) all.push(next);
    }
  }
  return all;
}

function findApi(): { api: Api; version: Version } | null {
  for (const version of kVersions) {
    for (const place of windowsAround()) {
      try {
        const api = (place as unknown as Record<string, Api | undefined>)[version.object];
        if (api) return { api, version };
      } catch {
        // another site's page
      }
    }
  }
  return null;
}

const isTrue = (reply: unknown): boolean => /^(true|1)$/i.test(String(reply));
const kLearner = 'visit.learner'; // for a system that does not answer a page that is loaded again
const kOpen = 'visit.open'; // the visit goes on over the next load

export function openScorm(): Door | null {
  const found = findApi();
  if (!found) return null;
  const { api, version } = found;
  const { prefix, core } = version;
  const begun = Date.now();
  const call = (name: string, ...words: string[]): unknown => api[name]?.(...words); // as methods: some need `this`
  const ask = (name: string): string => String(call(`${prefix}GetValue`, name) ?? '');
  const lastError = (): string => String(call(`${prefix}GetLastError`) ?? '');
  const begin = (): boolean => isTrue(call(`${prefix}Initialize`, ''));
  const remembered = isLoadedAgain() ? recall<string>(kLearner) : null;
  let hasBegun = (remembered !== null && recall<boolean>(kOpen) === true) || begin();
  forget(kOpen);
  const value = (name: string): string => (hasBegun ? ask(name) : '');
  const setAll = (values: Record<string, string>): void => {
    hasBegun ||= begin();
    if (!hasBegun) throw remembered === null ? new Error(`${prefix}Initialize`) : new VisitIsOver(version.finish);
    for (const [name, text] of Object.entries(values)) {
      if (!isTrue(call(`${prefix}SetValue`, name, text))) throw new Error(`${name}: ${String(call(`${prefix}GetErrorString`, lastError()))}`);
    }
    if (!isTrue(call(`${prefix}Commit`, ''))) throw new Error(`${prefix}Commit`);
  };
  const timeAndExit = (): Record<string, string> => ({ [`${core}session_time`]: version.timeOf(Date.now() - begun), [`${core}exit`]: isFinished ? '' : 'suspend' });
  const mayTell = !['browse', 'review'].includes(value(version.mode));
  // What was reached is never lowered, whatever a later visit does.
  let best = Math.max(0, ...version.statuses.map((name) => kStatuses.indexOf(value(name))));
  let score = best > 0 ? Number(value(`${core}score.raw`)) || 0 : 0;
  let isFinished = false;
  let isRestarting = false;
  const learner = hasBegun ? value(version.learner) : (remembered ?? '');
  if (hasBegun) keep(kLearner, learner);
  const finish = (): void => {
    if (!hasBegun || isRestarting) return;
    for (const [name, text] of Object.entries(timeAndExit())) call(`${prefix}SetValue`, name, text);
    call(version.finish, '');
    hasBegun = false;
  };
  return {
    learner,
    recalled: value('cmi.suspend_data'),
    room: version.room,
    report: async (progress: Progress, kept: string | null) => {
      if (!mayTell) return;
      isFinished = progress.isFinished;
      const reached = isLearned(progress) ? 2 : 1;
      const now = scoreOf(progress);
      const percent = now === null ? score : Math.round(10000 * now) / 100;
      score = best > 0 ? Math.max(score, percent) : percent;
      best = Math.max(best, isFinished ? reached : 0);
      setAll({
        ...(kept === null ? {} : { 'cmi.suspend_data': kept }),
        ...(now === null ? {} : { [`${core}score.min`]: '0', [`${core}score.max`]: '100', [`${core}score.raw`]: String(score), ...(prefix ? {} : { 'cmi.score.scaled': String(score / 100) }) }),
        ...version.statusOf(kStatuses[best] ?? ''),
        ...timeAndExit(),
      });
    },
    restart: async () => {
      isFinished = false;
      if (mayTell) setAll({ 'cmi.suspend_data': '', ...timeAndExit() });
      isRestarting = true;
      keep(kOpen, true);
    },
    leave: finish,
    close: async () => {
      finish();
      return '';
    },
  };
}

export const findScorm = (): Opening | null => (findApi() ? { system: 'scorm', open: async () => openScorm() as Door } : null);
