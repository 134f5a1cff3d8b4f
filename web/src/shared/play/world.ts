// The moves of a world: which state follows from which action.
import type { Frame, Place, PlayBoard } from '../board/types';
import type { Legend } from '../board/legend';
import { rememberLabels } from '../texts';

// A compact frame is [column, row, [[column, row, carried], ...], [index into stations, ...]], or {state} where the
// domain has no map.
export type CompactFrame = [number, number, [number, number, number | boolean][], number[]] | { state: string };

// A table of moves.
export interface WorldDocument {
  key: string;
  actions: { name: string; label: string; dx: number | null; dy: number | null }[];
  items?: string[];
  stations?: [number, number][];
  frames: (CompactFrame | null)[]; // null: no board leads there
  next: number[][]; // per state and action; -1: nothing happens
  // where chance has a part: everything that can follow, per state and action
  outcomes?: ([number, number, number[]][] | null)[][];
  end: boolean[];
  counts?: string[]; // per state a character per action: what it counts, '0' the first of `kinds`; '-': nothing happens
  kinds?: number[][];
  chance: boolean;
  may_repeat?: boolean; // an answer may be a path that never ends
  max_actions: number; // of an answer
}

export interface Action {
  index: number;
  name: string;
  shift: [number, number] | null; // columns and rows that it moves the robot, rows downward
}

// Something that can follow from an action, and what it counts.
export interface Branch {
  next: number;
  probability: number;
  counts: number[];
}

export const countsAt = ({ counts, kinds }: WorldDocument, state: number, action: number): number[] | null =>
  kinds?.[(counts?.[state]?.charCodeAt(action) ?? NaN) - '0'.charCodeAt(0)] ?? null;

export class World {
  readonly actions: Action[];

  constructor(private readonly table: WorldDocument) {
    rememberLabels(table.actions);
    this.actions = table.actions.map(({ name, dx, dy }, index) => ({
      index,
      name,
      shift: dx === null || dy === null || (dx === 0 && dy === 0) ? null : [dx, dy],
    }));
  }

  get hasChance(): boolean {
    return this.table.chance;
  }

  get mayRepeat(): boolean {
    return this.table.may_repeat ?? false;
  }

  get maxActions(): number {
    return this.table.max_actions;
  }

  frame(state: number): Frame {
    const compact = this.table.frames[state];
    if (!compact) return {};
    if (!Array.isArray(compact)) return { state: compact.state };
    const [column, row, items, stations] = compact;
    return {
      robot: [column, row],
      items: items.map(([x, y, carried], i) => ({
        name: this.table.items?.[i] ?? '',
        cell: [x, y],
        carried: Boolean(carried),
      })),
      stations: stations.flatMap((index) => {
        const place = this.table.stations?.[index];
        return place ? [place] : [];
      }),
    };
  }

  // Whether an action picks something up or puts it down.
  isHandling(action: number): boolean {
    const name = this.actions[action]?.name;
    return name === 'pickup' || name === 'dropoff';
  }

  // The state after an action; null: nothing happens.
  after(state: number, action: number): number | null {
    if (this.isEnd(state)) return null;
    const next = this.table.next[state]?.[action] ?? -1;
    return next < 0 ? null : next;
  }

  isEnd(state: number): boolean {
    return this.table.end[state] ?? false;
  }

  // Everything that can follow from an action; nothing if the table does not say.
  branches(state: number, action: number): Branch[] {
    const all = this.table.outcomes?.[state]?.[action] ?? [];
    return all.map(([next, probability, counts]) => ({ next, probability, counts }));
  }

  // The action that follows a frame; -1: none.
  actionOf(frame: Frame | undefined): number {
    return this.actions.findIndex(({ name }) => name === frame?.action);
  }

  // What an action counts.
  counts(state: number, action: number): number[] | null {
    return countsAt(this.table, state, action);
  }

  // The states that actions lead to, as far as they do something.
  walk(start: number, actions: number[]): number[] {
    const states = [start];
    for (const action of actions) {
      const next = this.after(states[states.length - 1] ?? start, action);
      if (next === null) break;
      states.push(next);
    }
    return states;
  }

  // The path as frames with the actions that were taken.
  frames(states: number[], actions: number[]): Frame[] {
    return states.map((state, i) => ({
      ...this.frame(state),
      ...(i < states.length - 1
        ? { action: this.actions[actions[i] ?? -1]?.name ?? null, counts: this.counts(state, actions[i] ?? -1) }
        : { action: null }),
    }));
  }

  // The shortest way of moves to a cell, going straight on where ways are equally long; null: none.
  route(from: number, [column, row]: Place): number[] | null {
    const isThere = (state: number): boolean => {
      const [x, y] = this.frame(state).robot ?? [0, 0];
      return x === column && y === row;
    };
    return this.shortest(from, isThere, this.actions.filter(({ shift }) => shift !== null));
  }

  // The fewest actions to such a state.
  shortest(from: number, isIt: (state: number) => boolean, actions: Action[] = this.actions): number[] | null {
    const before = new Map<number, { state: number; action: number } | null>([[from, null]]);
    const all = actions.map(({ index }) => index);
    let edge = [from];
    while (edge.length > 0) {
      const next: number[] = [];
      for (const state of edge) {
        if (isIt(state)) return this.back(before, state);
        const last = before.get(state)?.action;
        const order = last === undefined ? all : [last, ...all.filter((action) => action !== last)];
        for (const action of order) {
          const to = this.after(state, action);
          if (to === null || before.has(to)) continue;
          before.set(to, { state, action });
          next.push(to);
        }
      }
      edge = next;
    }
    return null;
  }

  private back(before: Map<number, { state: number; action: number } | null>, to: number): number[] {
    const actions: number[] = [];
    for (let at = before.get(to); at; at = before.get(at.state)) actions.unshift(at.action);
    return actions;
  }
}

// A table of moves without items, for a map on which nothing but walls matters.
export function plainWorld(board: PlayBoard, legend: Legend): { world: World; start: number } {
  const { width = 0, height = 0 } = board.domain;
  const isFree = (x: number, y: number): boolean =>
    x >= 1 && y >= 1 && x <= width && y <= height &&
    !legend.parts(board.map?.[y - 1]?.charAt(x - 1) ?? '').some(({ kind }) => kind === 'wall');
  const number = (x: number, y: number): number => (y - 1) * width + x - 1;
  const shifts = { up: [0, -1], down: [0, 1], left: [-1, 0], right: [1, 0] } as const;
  const cells = Array.from({ length: width * height }, (_, i): Place => [(i % width) + 1, Math.floor(i / width) + 1]);
  const [x, y] = board.start.robot ?? [1, 1];
  const table: WorldDocument = {
    key: 'plain',
    actions: Object.entries(shifts).map(([name, [dx, dy]]) => ({ name, label: name, dx, dy })),
    stations: board.start.stations ?? [],
    frames: cells.map(([column, row]) => [column, row, [], (board.start.stations ?? []).map((_, i) => i)]),
    next: cells.map(([column, row]) =>
      Object.values(shifts).map(([dx, dy]) => (isFree(column + dx, row + dy) ? number(column + dx, row + dy) : -1)),
    ),
    end: cells.map(() => false),
    chance: false,
    max_actions: Infinity,
  };
  return { world: new World(table), start: number(x, y) };
}
