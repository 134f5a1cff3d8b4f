// What all parts of the lesson share: the robot's world, and what the reader has predicted so far.
import { useLayoutEffect, useState } from 'preact/hooks';
import type { Legend } from '../shared/board/legend';
import type { Board, Path, PlayBoard } from '../shared/board/types';
import { World } from '../shared/play/world';
import { tableOf, type Domain, type Driven, type Lesson } from './document';
import { judgeMove, judgePath, type JudgedWorld, type Verdict } from './judge';

export interface Guess {
  mine: Path | null; // nothing: the reader wanted to see it at once
  verdict: Verdict | null;
}

export interface Context {
  lesson: Lesson;
  domain: Domain;
  legend: Legend;
  worlds: Worlds;
}

// Worlds to drive in, made when they are first needed.
export class Worlds {
  private readonly known = new Map<number, { table: JudgedWorld; world: World } | null>();

  constructor(private readonly lesson: Lesson) {}

  private of(number: number): { table: JudgedWorld; world: World } | null {
    if (!this.known.has(number)) {
      const table = tableOf(this.lesson, number);
      this.known.set(number, table && { table, world: new World(table) });
    }
    return this.known.get(number) ?? null;
  }

  world(number: number): World | null {
    return this.of(number)?.world ?? null;
  }

  table(number: number): JudgedWorld | null {
    return this.of(number)?.table ?? null;
  }

  judge(shown: Driven, actions: number[], repeatsFrom: number | null): Verdict {
    const table = this.table(shown.world);
    if (!table) return { isFinished: false, counts: null, isRight: false };
    return judgePath(this.lesson.judge, table, shown.counts, shown.state, actions, repeatsFrom);
  }

  judgeMove(shown: Driven, action: number): Verdict | null {
    const table = this.table(shown.world);
    return table?.ahead ? judgeMove(this.lesson.judge, table, shown.counts, shown.state, action) : null;
  }

  // Whether the robot's own way can be entered: the likeliest steps may lead round in a circle, and there may be none
  // that is likelier than others.
  canBeDrawn(shown: Driven): boolean {
    const table = this.table(shown.world);
    if (!table) return false;
    if (!table.robot) return shown.frames.length - 1 <= table.max_actions;
    let state = shown.state;
    for (let t = 0; t < table.max_actions; t += 1) {
      if (table.end[state]) return true;
      const action = table.robot[state] ?? -1;
      const elsewhere = (table.outcomes?.[state]?.[action] ?? []).filter(([next]) => next !== state).map(([, probability]) => probability);
      const most = Math.max(...elsewhere);
      if (elsewhere.filter((probability) => probability > most - 1e-9).length > 1) return false;
      state = table.next[state]?.[action] ?? -1;
      if (state < 0) return false;
    }
    return table.end[state] ?? false;
  }

  // The robot's path beside one that somebody might take for it, where the two can be told apart; the first moves of the
  // two where chance has a part.
  choice(shown: Driven & { runs: unknown; alternative?: Path | null }): [Path, Path] | null {
    const world = this.world(shown.world);
    if (!world || shown.repeats_from !== undefined || this.asked(shown) === 'nothing') return null;
    const along = (actions: number[]): Path => ({ frames: world.frames(world.walk(shown.state, actions), actions) });
    const shortest = world.shortest(shown.state, (state) => world.isEnd(state));
    const both = [shown, shown.alternative ?? (shortest && along(shortest))].map((path) => path && (shown.runs ? along([world.actionOf(path.frames[0])]) : path));
    const [own, other] = both;
    if (!own || !other || other.repeats_from !== undefined || (this.judgeFrames(shown, other)?.isRight ?? true)) return null;
    return shown.state % 2 === 0 ? [own, other] : [other, own];
  }

  judgeFrames(shown: Driven & { runs: unknown }, { frames }: Path): Verdict | null {
    const actions = frames.slice(0, -1).map((frame) => this.world(shown.world)?.actionOf(frame) ?? -1);
    return shown.runs ? this.judgeMove(shown, actions[0] ?? -1) : this.judge(shown, actions, null);
  }

  // What a reader is asked for: the whole path, or failing that the first move.
  asked(shown: Driven): 'path' | 'move' | 'nothing' {
    if (this.canBeDrawn(shown)) return 'path';
    return this.table(shown.world)?.ahead ? 'move' : 'nothing';
  }

  // What the robot avoids.
  costs(): number[] {
    return this.lesson.domain.features.flatMap(({ weight }, k) => (weight < 0 ? [k] : []));
  }
}

// A board with what its domain says about drawing it.
export function playBoard(domain: Domain, { world, map, fences, world_name, start }: Board): PlayBoard {
  return {
    domain,
    world,
    start,
    ...(map ? { map } : {}),
    ...(fences ? { fences } : {}),
    ...(world_name ? { world_name } : {}),
  };
}

// The first step that two paths do not have in common.
export function partingOf(a: Path, b: Path): number | null {
  const at = a.frames.findIndex((frame, i) => frame.action !== b.frames[i]?.action);
  return at < 0 ? null : at;
}

// Whether the page is on its way to paper, where there is nothing to press.
export function usePrinting(): boolean {
  const [isPrinting, setPrinting] = useState(() => window.matchMedia('print').matches);
  useLayoutEffect(() => {
    const query = window.matchMedia('print');
    const changed = (): void => setPrinting(query.matches);
    const begins = (): void => setPrinting(true);
    const ends = (): void => setPrinting(false);
    query.addEventListener('change', changed);
    window.addEventListener('beforeprint', begins);
    window.addEventListener('afterprint', ends);
    return () => {
      query.removeEventListener('change', changed);
      window.removeEventListener('beforeprint', begins);
      window.removeEventListener('afterprint', ends);
    };
  }, []);
  return isPrinting;
}
