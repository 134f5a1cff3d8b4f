// What a lesson tells the system that it is shown in: a learning system or the page around it.

export interface Prediction {
  period: number;
  test: number;
  right: boolean;
  regret: number; // what the path loses against the robot's, in units of the robot's reward
  ms: number;
}

export interface Component {
  name: string; // what there is to learn, in English
  status: 'open' | 'learned' | 'skipped';
}

export interface Progress {
  predictions: Prediction[];
  components: Component[];
  isFinished: boolean;
}

/** The share of the last tests that was predicted right; null before the first. */
export function scoreOf({ predictions }: Progress): number | null {
  const last = Math.max(...predictions.map(({ period }) => period));
  const tests = predictions.filter(({ period }) => period === last);
  return tests.length === 0 ? null : tests.filter(({ right }) => right).length / tests.length;
}

/** Whether everything there is to learn was learned; what the teacher skips is learned with the rest. */
export const isLearned = ({ components }: Progress): boolean =>
  components.some(({ status }) => status === 'learned') && components.every(({ status }) => status === 'learned' || status === 'skipped');

export interface Door {
  /** Tells learners apart who use the same browser. */
  learner: string;
  /** What was kept of a lesson that was left; empty: nothing. */
  recalled: string;
  /** The longest text that is kept. */
  room: number;
  /** Tells how far the learner is and keeps what a later visit goes on from, unless that is null. Rejects if it was not taken. */
  report: (progress: Progress, kept: string | null) => Promise<void>;
  /** Forgets what was kept of the lesson: the learner starts again, on this page. */
  restart: () => Promise<void>;
  /** The page is left or loaded again. */
  leave: () => void;
  /** The learner leaves for good. Gives the address of where to go then, or nothing. */
  close: () => Promise<string>;
}

/** A learning system that was found. Nothing was read from it or told to it. */
export interface Opening {
  system: 'scorm' | 'cmi5';
  open: () => Promise<Door>;
}

/** The system has ended this visit: what happens now is told in the next one. */
export class VisitIsOver extends Error {}

/** Whether the page that was here before in this tab is here again. */
export const isLoadedAgain = (): boolean => (performance.getEntriesByType('navigation')[0] as PerformanceNavigationTiming | undefined)?.type === 'reload';
