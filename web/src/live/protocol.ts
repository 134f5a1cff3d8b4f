// Printed by the tests of libs/live from the members of its events and views: do not edit (docs/live-protocol.md).
import type { Frame, Path, PlayBoard } from '../shared/board/types';
import type { KeyPress } from '../shared/play/drive';
import type { Bracket } from '../shared/play/brackets';
import type { Runs } from '../shared/play/runs';
import type { Stores } from '../shared/stores';

export type { Frame };

export interface Update {
  now: string[];
  still: string[];
  news: string[];
}

export interface Pause {
  why: 'someone-away' | 'facilitator';
  since_ms: number;
  until_ms?: number;
  missing: number;
}

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
  robot: Frame[];
  differs_at: number | null;
  why: string[];
  chance?: { world: string; state: number; spared: number[] };
  mine_repeats_from?: number;
  robot_repeats_from?: number;
  robot_repeats_text?: string;
  unfinished: boolean;
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

export type Explored = {
  impossible?: boolean;
} & Partial<{ board: PlayBoard; other: Path | null; differs_at: number | null; tie: boolean; reason?: string; path: Path }>;

export interface ParticipantView {
  stage: 'consent' | 'check' | 'screening' | 'lobby' | 'watch' | 'predict' | 'discuss' | 'wait' | 'feedback' | 'exam' | 'questions' | 'debrief' | 'declined' | 'full' | 'ended' | 'replaced';
  lang: string;
  study: { title: string; story: string[]; goal: string; update?: Update };
  me: { label: string };
  group: { size: number };
  notices: { text: string; at_ms: number }[];
  pause?: Pause;
  progress?: { part: number; round: number; most: number; parts: number };
  consent?: { version: string; paragraphs: string[]; stores: Stores };
  check?: { board: PlayBoard; world: string; start: number; parts: number; most: number; ask_name: boolean };
  lobby?: { present: number; size: number; since_ms: number; leave_after_ms: number; until_ms?: number };
  watch?: { index: number; of: number; board: PlayBoard; world?: string; state?: number; runs?: Runs } & Path;
  predict?: Task;
  discuss?: { index: number; of: number; board: PlayBoard; predictions: ({ own: boolean; n: number } & Path)[] };
  wait?: { for: 'answers' | 'others-watching' | 'discussion' | 'teacher' | 'feedback' | 'joining' | 'rejoining'; missing: number; since_ms: number };
  feedback?: { tests: Judged[]; all_right: boolean; learned: boolean; others_unsure: boolean; brackets?: Bracket[] };
  questions?: { items: Question[] };
  debrief?: { summary: string[]; not_reached: string[]; code: string; rounds: number; right: number; tests: number; redirect?: string };
  end?: { reason: string; text: string; code?: string; redirect?: string };
  explore?: { first: Explored; put: string[]; brackets: Bracket[]; last?: Explored };
  limit_ms?: number;
  server_ms: number;
}

export interface Commands {
  consent: { accept: boolean; version: string; query?: Record<string, string> };
  checked: Record<string, never>;
  name: { name: string };
  screen: { test: number; actions: number[]; ms: number; for_ever?: boolean };
  watched: { demo: number; round?: number };
  draft: { test: number; actions: number[] };
  answer: { test: number; actions: number[]; keys?: KeyPress[]; ms: number; for_ever?: boolean; round?: number };
  continue: { round?: number };
  explore: { start: Frame; world?: number; map?: string[] };
  questions: { answers: Record<string, string | number> };
  leave: Record<string, never>;
  discuss: { test: number; choice?: number | null; ms: number; round?: number };
  examine: { test: number; actions: number[]; ms: number; for_ever?: boolean };
}

export type Stage = ParticipantView['stage'];
export type CommandType = keyof Commands;

export interface Message<T extends CommandType = CommandType> {
  t: T;
  id: string;
  body: Commands[T];
}
