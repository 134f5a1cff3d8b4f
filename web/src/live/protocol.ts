// What the server sends to participants and what they send to it.
import type { Frame, MapDomain, Path, Place } from '../shared/board/types';

export type { Frame } from '../shared/board/types';

// A world before anybody has moved. Nothing in it tells of the reward.
export interface LiveBoard {
  domain: MapDomain;
  world: number;
  map?: string[];
  fences?: [Place, Place][];
  world_name?: string;
  start: Frame;
}

export type Stage =
  | 'consent'
  | 'check'
  | 'screening'
  | 'lobby'
  | 'watch'
  | 'predict'
  | 'wait'
  | 'feedback'
  | 'questions'
  | 'debrief'
  | 'declined'
  | 'full'
  | 'ended'
  | 'replaced';

// Something to drive: `world` is the key of its table of moves, `start` a state of that table.
export interface Task {
  index: number;
  of: number;
  board: LiveBoard;
  world: string;
  start: number;
  draft: number[];
}

// Where chance has a part: several runs of the robot, and what happened in how many of them, in English.
export interface Runs {
  text: string;
  runs: { frames: Frame[]; ended: boolean }[];
}

export interface Judged {
  board: LiveBoard;
  right: boolean;
  mine: Frame[] | null;
  mine_repeats_from?: number; // as in a Path
  mine_repeats_text?: string;
  robot: Frame[];
  robot_repeats_from?: number;
  robot_repeats_text?: string;
  differs_at: number | null;
  unfinished: boolean; // the prediction ends before the robot has finished
  why: string[];
  cost?: string;
}

export interface Question {
  id: string;
  kind: 'likert' | 'text' | 'choice';
  text: string;
  options?: string[];
  low?: string;
  high?: string;
  required: boolean;
}

export interface Pause {
  why: 'someone-away' | 'facilitator' | 'teacher';
  since_ms: number;
  until_ms?: number;
  missing: number;
}

export interface ParticipantView {
  v: 1;
  stage: Stage;
  lang: string;
  dir: 'ltr' | 'rtl';
  study: { title: string; story: string[]; goal: string };
  me: { seat: number; label: string };
  group: { size: number; active: number };
  notices: { text: string; at_ms: number }[];
  pause?: Pause;
  consent?: { version: string; paragraphs: string[] };
  check?: { board: LiveBoard; world?: string; start?: number; ask_name?: boolean };
  screening?: Task; // or `predict` in the stage screening
  lobby?: {
    present: number;
    size: number;
    since_ms: number;
    leave_after_ms: number; // from when on one may leave
    reserve?: boolean; // the seats are taken; who waits gets one that becomes free
    until_ms?: number;
  };
  progress?: { part: number; round: number; done: number };
  watch?: { index: number; of: number; board: LiveBoard; runs?: Runs } & Path;
  predict?: Task;
  wait?: {
    for: 'answers' | 'others-watching' | 'teacher' | 'feedback' | 'joining' | 'rejoining';
    missing: number;
    since_ms: number;
  };
  // others_unsure: somebody else was not right, which is why the group goes on
  feedback?: { tests: Judged[]; all_right: boolean; learned: boolean; others_unsure: boolean };
  questions?: { items: Question[] };
  // what the robot is like: of the parts that the group had lessons about, and of the others
  debrief?: { summary: string[]; not_reached: string[]; code: string; redirect?: string; rounds: number; right: number; tests: number };
  end?: { reason: string; text: string; code?: string; redirect?: string };
  limit_ms?: number; // when a time limit ends this stage
  server_ms: number;
}

// A key press, as researchers see it: an action's number or what was done to the path, and milliseconds.
export type KeyPress = [number | 'undo' | 'reset', number];

export interface Commands {
  consent: { accept: boolean; version: string };
  checked: Record<string, never>;
  name: { name: string };
  screen: { test: number; actions: number[]; for_ever?: true; ms: number };
  watched: { demo: number };
  draft: { test: number; actions: number[] };
  answer: { test: number; actions: number[]; for_ever?: true; keys: KeyPress[]; ms: number };
  continue: Record<string, never>;
  questions: { answers: Record<string, string | number> };
  leave: Record<string, never>;
}

export type CommandType = keyof Commands;

export interface Message<T extends CommandType = CommandType> {
  t: T;
  id: string;
  body: Commands[T];
}

// GET /api/world/KEY. A compact frame is [column, row, [[column, row, carried], ...], [index into stations, ...]],
// or {state} where the domain has no map.
export type CompactFrame = [number, number, [number, number, number | boolean][], number[]] | { state: string };

export interface WorldDocument {
  key: string;
  actions: { name: string; label: string; dx: number | null; dy: number | null }[];
  items?: string[];
  stations?: [number, number][];
  frames: CompactFrame[];
  next: number[][]; // per state and action; -1: nothing happens
  end: boolean[];
  chance: boolean;
  may_repeat?: boolean; // an answer may be a path that never ends
  max_actions: number; // of an answer
}

export interface TextsDocument {
  lang: string;
  dir: 'ltr' | 'rtl';
  strings: Record<string, string>;
}
