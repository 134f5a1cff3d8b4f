// What the server sends to participants and what they send to it.
import type { Frame, Path, PlayBoard } from '../shared/board/types';
import type { KeyPress } from '../shared/play/drive';
import type { Bracket } from '../shared/play/brackets';
import type { Runs } from '../shared/play/runs';
import type { Stores } from '../shared/stores';

export type { Frame } from '../shared/board/types';

export type Stage =
  | 'consent'
  | 'check'
  | 'screening'
  | 'lobby'
  | 'watch'
  | 'predict'
  | 'discuss'
  | 'wait'
  | 'feedback'
  | 'exam'
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
  board: PlayBoard;
  world: string;
  start: number;
  draft: number[];
}

export interface Judged {
  board: PlayBoard;
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
  chance?: { world: string; state: number; spared: number[] }; // the start in its table of moves, and what the robot's move at the fork avoids
}

// Where the robot goes from `board.start`, and what else it could do; `tie`: that is worth the same to it.
export interface Explored {
  impossible?: true; // the robot cannot do its job there; nothing else is said then
  board?: PlayBoard;
  path?: Path;
  other?: Path | null;
  differs_at?: number | null;
  reason?: string; // in English
  tie?: boolean;
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

// What is new about a robot, and what is not, for those who know it as it was.
export interface Update {
  now: string[];
  still: string[];
  news: string[]; // all that is new, also what weighs many things
}

export interface ParticipantView {
  v: 1;
  stage: Stage;
  lang: string;
  dir: 'ltr' | 'rtl';
  study: { title: string; story: string[]; goal: string; update?: Update };
  me: { seat: number; label: string };
  group: { size: number; active: number };
  notices: { text: string; at_ms: number }[];
  pause?: Pause;
  consent?: { version: string; paragraphs: string[]; stores?: Stores };
  check?: { board: PlayBoard; world?: string; start?: number; parts?: number; most?: number; ask_name?: boolean };
  screening?: Task; // or `predict` in the stage screening
  lobby?: {
    present: number;
    size: number;
    since_ms: number;
    leave_after_ms: number; // from when on one may leave
    until_ms?: number;
  };
  progress?: { part: number; parts: number; round: number; most: number; done: number };
  // world and state: the table of moves and the start in it, if people sketch the path first
  watch?: { index: number; of: number; board: PlayBoard; runs?: Runs; world?: string; state?: number } & Path;
  predict?: Task; // in the stage exam `of` is how many there are at most
  // what the group predicted for a test, every path once, without names; n: how many predicted it
  discuss?: { index: number; of: number; board: PlayBoard; predictions: ({ own: boolean; n: number } & Path)[] };
  wait?: {
    for: 'answers' | 'others-watching' | 'discussion' | 'teacher' | 'feedback' | 'joining' | 'rejoining';
    missing: number;
    since_ms: number;
  };
  // others_unsure: somebody else was not right, which is why the group goes on
  // brackets: where the study shows them
  feedback?: { tests: Judged[]; all_right: boolean; learned: boolean; others_unsure: boolean; brackets?: Bracket[] };
  // where the study lets people change the world; `put` are symbols that may stand anywhere on the map
  explore?: { first: Explored; last?: Explored; put: string[]; brackets: Bracket[] };
  questions?: { items: Question[] };
  // what the robot is like: of the parts that the group had lessons about, and of the others
  debrief?: { summary: string[]; not_reached: string[]; code: string; redirect?: string; rounds: number; right: number; tests: number };
  end?: { reason: string; text: string; code?: string; redirect?: string };
  limit_ms?: number; // when a time limit ends this stage
  server_ms: number;
}

export interface Commands {
  consent: { accept: boolean; version: string };
  checked: Record<string, never>;
  name: { name: string };
  screen: { test: number; actions: number[]; for_ever?: true; ms: number };
  examine: { test: number; actions: number[]; for_ever?: true; ms: number };
  watched: { demo: number };
  draft: { test: number; actions: number[] };
  answer: { test: number; actions: number[]; for_ever?: true; keys: KeyPress[]; ms: number };
  discuss: { test: number; choice: number | null; ms: number }; // null: keeps the own one
  continue: Record<string, never>;
  explore: { world?: number; map?: string[]; start: Frame };
  questions: { answers: Record<string, string | number> };
  leave: Record<string, never>;
}

export type CommandType = keyof Commands;

export interface Message<T extends CommandType = CommandType> {
  t: T;
  id: string;
  body: Commands[T];
}
