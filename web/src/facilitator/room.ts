// Printed by the tests of libs/live from the members of its events and views: do not edit (docs/live-protocol.md).
import type { Path, PlayBoard } from '../shared/board/types';

export interface SeatRow {
  seat: number;
  label: string;
  name?: string;
  kind: 'person' | 'simulated';
  type: string;
  presence: 'here' | 'away' | 'left' | 'empty';
  status: 'empty' | 'active' | 'finished' | 'left' | 'dropped' | 'replaced' | 'withdrawn' | 'ended' | 'declined' | 'full' | 'moved' | 'simulated';
  dropped: boolean;
  since_ms: number;
  member?: number;
  stage: string;
  stage_since_ms?: number;
  right?: number;
  tests?: number;
  estimate?: number;
  estimate_is_high?: boolean;
  code?: string;
  latency_ms?: number;
  link?: string;
  needs_help?: string;
}

export interface Forecast {
  periods: number;
  minutes_low: number;
  minutes_high: number;
  done_within?: number[];
}

export interface RoomRow {
  id: string;
  code?: string;
  stage: 'lobby' | 'running' | 'paused' | 'questions' | 'ended';
  strategy: string;
  composition: string;
  waiting_list?: boolean;
  seats: SeatRow[];
  period: number;
  component: number;
  started_ms?: number;
  ended?: string;
  forecast?: Forecast;
  next_strategy?: string;
}

export type ShownBoard = {
  board: PlayBoard;
  gain?: number;
  sentences: string[];
} & Path;

export interface RunnerUp {
  board: PlayBoard;
  gain: number;
  sentences: string[];
}

export interface LessonNow {
  source: string;
  why: string;
  demonstrations: ShownBoard[];
  tests: ShownBoard[];
  runners_up: RunnerUp[];
}

export interface Answer {
  seat: number;
  period: number;
  test: number;
  right: boolean;
  regret: number;
  ms: number;
  stopped_short: boolean;
  changed?: boolean;
  right_in_the_end?: boolean;
}

export interface Belief {
  name: string;
  points: string;
}

export interface Truth {
  weights: number[];
  features: string[];
  bec: number[][];
  prior: number[][];
}

export interface Timer {
  name: string;
  since_ms: number;
  until_ms?: number;
}

export interface PersonAudit {
  seat: number;
  tests: number;
  right: number;
  knows: number;
  components: { name: string; verdict: string; level: number | null }[];
  exam?: 'understands' | 'does-not-understand' | 'cannot-tell';
  needs_help?: string;
  thinks?: string;
  probability?: number;
  kind?: string;
  kinds?: Record<string, number>;
}

export interface RoomDetail {
  id: string;
  session: { component: number | null; components: { name: string; status: 'open' | 'learned' | 'skipped' }[]; phase: string };
  lesson?: LessonNow;
  answers: Answer[];
  curves: { period: number; p_bec: Record<string, number>; right: Record<string, number> }[];
  beliefs: Belief[];
  truth: Truth;
  timers: Timer[];
  people?: PersonAudit[];
}

export interface RoomCommands {
  start: Record<string, never>;
  pause: Record<string, never>;
  resume: Record<string, never>;
  extend: { seconds: number };
  message: { text: string; seat?: number | null };
  readmit: { seat: number };
  simulate: { seat: number; type?: string };
  strategy: { name: string };
  end: Record<string, never>;
}

