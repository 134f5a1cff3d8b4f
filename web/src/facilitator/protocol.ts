// What the server sends to facilitators and observers beside the rooms, and what it takes from facilitators.
import type { Stores } from '../shared/stores';
import type { RoomCommands, RoomDetail, RoomRow, SeatRow } from './room';

export * from './room';
export type Role = 'facilitator' | 'observer';
export type Presence = SeatRow['presence'];
export type RoomStage = RoomRow['stage'];

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
