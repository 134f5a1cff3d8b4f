// A learning system that speaks SCORM 1.2: an object of functions in a page around this one.
import { isLearned, scoreOf, type Door, type Progress } from './door';

interface Api {
  LMSInitialize: (nothing: '') => unknown;
  LMSFinish: (nothing: '') => unknown;
  LMSGetValue: (name: string) => unknown;
  LMSSetValue: (name: string, value: string) => unknown;
  LMSCommit: (nothing: '') => unknown;
  LMSGetLastError: () => unknown;
  LMSGetErrorString: (code: string) => unknown;
}

const kRoom = 4096; // characters that every system keeps
const kMostFrames = 100;

// In the windows around this one, then around the one that opened this one.
function findApi(): Api | null {
  const above = (from: Window | null): Api | null => {
    let place = from;
    for (let i = 0; place && i < kMostFrames; ++i) {
      try {
        const api = (place as { API?: Api }).API;
        if (api) return api;
      } catch {
        return null; // another site's page
      }
      if (place.parent === place) return null;
      place = place.parent;
    }
    return null;
  };
  return above(window) ?? above(window.opener as Window | null);
}

function time(ms: number): string {
  const two = (n: number): string => String(n).padStart(2, '0');
  const hundredths = Math.floor(ms / 10);
  const seconds = Math.floor(hundredths / 100);
  return `${String(Math.min(9999, Math.floor(seconds / 3600))).padStart(4, '0')}:${two(Math.floor(seconds / 60) % 60)}:${two(seconds % 60)}.${two(hundredths % 100)}`;
}

const isTrue = (reply: unknown): boolean => reply === true || String(reply) === 'true';

export function openScorm(): Door | null {
  const api = findApi();
  if (!api) return null;
  const begun = Date.now();
  let hasBegun = isTrue(api.LMSInitialize(''));
  const value = (name: string): string => (hasBegun ? String(api.LMSGetValue(name) ?? '') : '');
  const status = value('cmi.core.lesson_status');
  const setAll = (values: Record<string, string>): void => {
    if (!hasBegun) hasBegun = isTrue(api.LMSInitialize(''));
    for (const [name, text] of Object.entries(values)) {
      if (!isTrue(api.LMSSetValue(name, text))) {
        throw new Error(`${name}: ${String(api.LMSGetErrorString(String(api.LMSGetLastError())))}`);
      }
    }
    if (!isTrue(api.LMSCommit(''))) throw new Error('LMSCommit');
  };
  let isFinished = status === 'passed' || status === 'completed';
  if (hasBegun && !isFinished) api.LMSSetValue('cmi.core.lesson_status', 'incomplete');
  return {
    learner: value('cmi.core.student_id'),
    recalled: value('cmi.suspend_data'),
    room: kRoom,
    report: async (progress: Progress, kept: string | null) => {
      const score = scoreOf(progress);
      isFinished = isFinished || progress.isFinished;
      setAll({
        ...(kept === null ? {} : { 'cmi.suspend_data': kept }),
        ...(score === null ? {} : { 'cmi.core.score.min': '0', 'cmi.core.score.max': '100', 'cmi.core.score.raw': String(Math.round(10000 * score) / 100) }),
        'cmi.core.lesson_status': progress.isFinished ? (isLearned(progress) ? 'passed' : 'completed') : 'incomplete',
        'cmi.core.session_time': time(Date.now() - begun),
        'cmi.core.exit': progress.isFinished ? '' : 'suspend',
      });
    },
    leave: () => {
      if (!hasBegun) return;
      api.LMSSetValue('cmi.core.session_time', time(Date.now() - begun));
      api.LMSSetValue('cmi.core.exit', isFinished ? '' : 'suspend');
      api.LMSFinish('');
      hasBegun = false;
    },
  };
}
