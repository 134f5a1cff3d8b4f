// What the server sends to facilitators and observers, and what it takes from facilitators.
import type { Frame, MapDomain, Path, Place } from '../shared/board/types';
import type { Stores } from '../shared/stores';
import type { RoomCommands } from './room';

export type { Frame };
export type Role = 'facilitator' | 'observer';
export type Presence = 'here' | 'away' | 'left' | 'empty';
export type RoomStage = 'lobby' | 'running' | 'paused' | 'questions' | 'ended';

export interface Named {
  name: string;
  description: string;
}

export interface StudyInfo {
  id: string;
  title: string;
  domain: string;
  strategies: Named[];
  compositions?: string[];
  types: { letter: string; label: string }[];
  dropout: string;
  grace_s: number;
  stores: Stores;
  time: Record<string, number>;
  size?: number; // seats of a room unless said otherwise
}

// Share of screening tests that a person is expected to answer right: a number, or a number with its interval.
export type Estimate = number | { value: number; low?: number; high?: number };

export interface SeatRow {
  seat: number;
  member?: number; // of the session, from 1, if it is not the seat: who takes over gets a new seat
  label: string;
  name?: string;
  kind: 'person' | 'simulated';
  type?: string;
  presence: Presence;
  since_ms: number; // of the presence; 0: nobody has come yet
  stage_since_ms?: number;
  stage: string;
  dropped?: boolean; // the group goes on without them
  status?: 'empty' | 'active' | 'finished' | 'left' | 'dropped' | 'replaced' | 'withdrawn' | 'ended' | 'declined' | 'full' | 'moved' | 'simulated';
  needs_help?: string; // why, by what kith audit says of their answers
  why?: string;
  latency_ms?: number;
  estimate?: Estimate;
  link?: string;
  code?: string;
}

export interface Forecast {
  periods: number;
  minutes_low: number;
  minutes_high: number;
  done_within?: number[]; // probability that everything is learned after 1, 2, 3 more periods
}

export interface RoomRow {
  id: string;
  code?: string; // observers get none
  stage: RoomStage;
  strategy: string;
  seats: SeatRow[];
  period: number;
  component: number | string;
  started_ms?: number;
  ended?: string;
  composition?: string;
  next_strategy?: string;
  forecast?: Forecast;
}

export interface BoardView {
  domain: MapDomain;
  world: number;
  map?: string[];
  fences?: [Place, Place][];
  world_name?: string;
  start: Frame;
}

export type Sentence = string | { text: string };

export interface ShownBoard extends Path {
  board: BoardView;
  sentences: Sentence[];
  gain?: number;
}

export interface RunnerUp {
  board: BoardView;
  gain: number;
  sentences: Sentence[];
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
  changed?: boolean; // where groups talk: whether another prediction was taken instead
  right_in_the_end?: boolean;
}

export interface CurvePoint {
  period: number;
  p_bec: Record<string, number>;
  right: Record<string, number>;
}

export interface ComponentState {
  name: string;
  status: 'open' | 'learned' | 'skipped';
}

export interface Timer {
  name: string;
  since_ms: number;
  until_ms?: number;
}

// Who understands what: what `kith audit` says of a person's answers in the periods so far.
export interface PersonAudit {
  seat: number;
  member: number;
  tests: number;
  right: number;
  exam?: 'understands' | 'does-not-understand' | 'cannot-tell'; // what the exam came to, once it has begun
  knows: number; // how often they are expected to get all of a component right: the mean over those taught
  components: { name: string; understanding: string; verdict: string; level: number | null }[];
  needs_help?: string; // why
  thinks?: string; // the misconception that is most probable
  probability?: number; // of it
  kind?: string; // the kind of learner, or that it cannot be told yet; if the study asks for kinds
  kinds?: Record<string, number>; // the probability of each
}

export interface Truth {
  weights: number[];
  bec: number[][];
  prior: number[][];
  features?: string[];
}

export interface Belief {
  name: string;
  points: string;
}

export interface RoomDetail {
  id: string;
  session: { period: number; component: number | string | null; components: ComponentState[]; phase: string };
  lesson?: LessonNow;
  answers: Answer[];
  curves: CurvePoint[];
  people?: PersonAudit[];
  beliefs: Belief[];
  truth?: Truth;
  timers: Timer[];
}

export interface LogEntry {
  at_ms: number;
  room?: string;
  actor: string;
  what: string;
  reason?: string;
}

export interface Integrity {
  events: number;
  stored: number;
  unsaved: number;
  free_mb: number;
  last_commit_ms: number;
  problems: string[];
}

export interface FacilitatorView {
  v: number;
  role: Role;
  server_ms: number;
  study: StudyInfo;
  links?: { facilitator: string; observer: string; join: string; code?: string }; // empty: not known any more
  rooms: RoomRow[];
  room?: RoomDetail;
  log: LogEntry[];
  integrity: Integrity;
}

export interface Commands extends RoomCommands {
  'room-make': { strategy?: string; seats: string[]; count: number };
  'room-select': object;
  'link-revoke': { token: string };
}
export type CommandName = keyof Commands;

export const isObject = (value: unknown): value is Record<string, unknown> => typeof value === 'object' && value !== null;
