// Driving the robot through a world: the path so far, what was pressed and when.
import { useLayoutEffect, useRef, useState } from 'preact/hooks';
import type { Frame, Place } from '../board/types';
import type { World } from './world';

// A key press, as researchers see it: an action's number or what was done to the path, and milliseconds.
export type KeyPress = [number | 'undo' | 'reset', number];

const kDraftMs = 2000; // at most one draft per
const kMostKeys = 800; // a message has at most 16 KiB

export type Outcome = 'done' | 'undone' | 'blocked' | 'end' | 'full';

export interface Kept {
  key: string;
  actions: number[];
  keys: KeyPress[];
  ms: number;
  told: number[]; // the last draft that was sent
}

interface Options {
  world: World;
  start: number;
  draft: number[];
  key: string; // names this task; what was done here survives a reload
  onDraft?: (actions: number[]) => void;
  store?: DriveStore;
}

// Where a page keeps what was done; without one, a reload forgets it.
export interface DriveStore {
  recall: () => Kept | null;
  keep: (kept: Kept) => void;
}

export interface Drive {
  actions: number[];
  frames: Frame[];
  state: number;
  isAtEnd: boolean;
  left: number; // how many more actions the server accepts
  repeatsFrom: number | null; // when the path was last in the state in which it is now, where it may go on for ever
  act: (action: number) => Outcome;
  goTo: (cell: Place) => Outcome | 'none';
  undo: () => void;
  reset: () => void;
  keys: () => KeyPress[];
  ms: () => number;
}

export function useDrive({ world, start, draft, key, onDraft, store }: Options): Drive {
  const first = useRef<Kept | null>(null);
  first.current ??= beginning(key, draft, store);
  const kept = first.current;
  const [actions, setActions] = useState(() => kept.actions.slice(0, world.walk(start, kept.actions).length - 1));
  const clock = useRef({ begun: performance.now() - kept.ms });
  const keys = useRef<KeyPress[]>(kept.keys);
  const latest = useRef(actions); // several steps of a click come before the next rendering
  const ms = (): number => Math.round(performance.now() - clock.current.begun);

  const told = useDrafts(actions, kept.told, onDraft);

  const change = (next: number[], pressed: KeyPress[0][]): void => {
    latest.current = next;
    for (const press of pressed) if (keys.current.length < kMostKeys) keys.current.push([press, ms()]);
    store?.keep({ key, actions: next, keys: keys.current, ms: ms(), told: told.current });
    setActions(next);
  };
  const states = world.walk(start, actions);
  const now = (): number => world.walk(start, latest.current).at(-1) ?? start;

  const take = (taken: number[]): Outcome => {
    let state = now();
    const done: number[] = [];
    for (const action of taken) {
      const next = world.after(state, action);
      if (next === null || latest.current.length + done.length >= world.maxActions) break;
      done.push(action);
      state = next;
    }
    if (done.length > 0) change([...latest.current, ...done], done);
    if (done.length === taken.length) return 'done';
    if (latest.current.length >= world.maxActions) return 'full';
    return world.isEnd(state) ? 'end' : 'blocked';
  };
  // Picking up and putting down again at once, as a double click does, leaves no trace: whoever means it, or could mean
  // it because the robot may do so for ever, says it in more than one way.
  const isTakenBack = (action: number): boolean => {
    const last = latest.current.at(-1);
    if (last === undefined || world.mayRepeat || !world.isHandling(last) || !world.isHandling(action)) return false;
    return world.after(now(), action) === world.walk(start, latest.current).at(-2);
  };
  const undo = (): void => {
    if (latest.current.length > 0) change(latest.current.slice(0, -1), ['undo']);
  };

  return {
    actions,
    frames: world.frames(states, actions),
    state: states.at(-1) ?? start,
    isAtEnd: world.isEnd(states.at(-1) ?? start),
    left: world.maxActions - actions.length,
    repeatsFrom: world.mayRepeat ? earlier(states) : null,
    act: (action) => {
      if (!isTakenBack(action)) return take([action]);
      undo();
      return 'undone';
    },
    goTo: (cell) => {
      const route = world.isEnd(now()) ? null : world.route(now(), cell);
      return route === null ? 'none' : take(route);
    },
    undo,
    reset: () => {
      if (latest.current.length > 0) change([], ['reset']);
    },
    keys: () => keys.current,
    ms,
  };
}

// When a path was last in its present state; null: never.
function earlier(states: number[]): number | null {
  const found = states.slice(0, -1).lastIndexOf(states.at(-1) ?? -1);
  return found < 0 ? null : found;
}

// What this tab remembers of the task. The server's draft counts if it comes from another tab or computer, where
// somebody has driven on.
function beginning(key: string, draft: number[], store: DriveStore | undefined): Kept {
  const kept = store?.recall();
  if (kept?.key !== key || !Array.isArray(kept.actions) || !Array.isArray(kept.keys)) {
    return { key, actions: draft, keys: [], ms: 0, told: draft };
  }
  const isOwn = String(draft) === String(kept.told) || draft.every((action, i) => action === kept.actions[i]);
  return isOwn ? { ...kept, told: draft } : { ...kept, actions: draft, told: draft };
}

// Tells the server about changes, but not about every one. Gives what it was told last.
function useDrafts(actions: number[], known: number[], onDraft: Options['onDraft']): { current: number[] } {
  const told = useRef(known);
  const at = useRef(-Infinity);
  useLayoutEffect(() => {
    if (!onDraft || String(told.current) === String(actions)) return;
    const tell = (): void => {
      told.current = actions;
      at.current = performance.now();
      onDraft(actions);
    };
    const timer = setTimeout(tell, Math.max(0, at.current + kDraftMs - performance.now()));
    return () => clearTimeout(timer);
  }, [actions]);
  return told;
}
