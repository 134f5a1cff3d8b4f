// The document that kith writes (schema kith.curriculum/1), as far as the page uses it.
import type { Board, MapDomain, Path, Place } from '../shared/board/types';
import type { Bracket } from '../shared/play/brackets';
import type { Runs } from '../shared/play/runs';
import { World } from '../shared/play/world';
import type { Judge, JudgedWorld } from './judge';

export interface Sentence {
  normal: number[];
  text: string;
}

// A board on which somebody drives the robot: its start in the table of moves, and what the robot's own path counts.
export interface Driven extends Board {
  state: number;
  counts: number[];
  first: boolean; // one of those that a lesson begins with
}

export interface Demonstration extends Driven {
  brackets: Bracket[]; // what is known when it has been seen
  runs: Runs | null; // nothing where chance has no part
  reason: string;
  conveys: Sentence[];
  alternative: Path | null;
  decisive: { frame: number; cell?: Place } | null;
}

export interface Test extends Driven {
  runs: Runs | null;
  covers: Sentence[];
  is_shortest_wrong: boolean; // else a right answer tells nothing
}

export interface Component {
  number: number;
  name: string;
  sentences: Sentence[];
  demonstrations: Demonstration[];
  tests: Test[];
}

export interface Domain extends MapDomain {
  title: string;
  features: { name: string; words: string; weight: number; many: string; do: string; do_many: string }[];
}

export interface Lesson {
  schema: string;
  title: string;
  program: string;
  seed?: number;
  domain: Domain;
  update?: { text: string; now: string[]; still: string[] }; // for those who know the robot as it was
  explained?: string; // how much of what the robot does the lesson explains, where it is not all
  judge: Judge;
  tables: { moves: JudgedWorld[]; worlds: Record<string, { moves: number; counts: string[]; kinds: number[][] }> };
  max_actions: number;
  components: Component[];
  fresh: Test[];
  endless: (Board & Path) | null; // from where the robot never arrives
}

export const kSchema = 'kith.curriculum/1';

// The table of moves of a world, put together.
export function tableOf({ tables, max_actions }: Lesson, world: number): JudgedWorld | null {
  const own = tables.worlds[String(world)];
  const moves = own && tables.moves[own.moves];
  return moves ? { ...moves, key: String(world), counts: own.counts, kinds: own.kinds, max_actions } : null;
}

// The document inside the page; throws where there is none or of another schema.
export function readLesson(): Lesson {
  const text = document.getElementById('kith-document')?.textContent ?? '';
  const lesson = JSON.parse(text) as Lesson;
  if (lesson.schema !== kSchema) {
    throw new Error(`this page draws documents of schema ${kSchema}, not ${String(lesson.schema)}`);
  }
  for (const { demonstrations, tests } of lesson.components) [...demonstrations, ...tests].forEach((shown) => complete(lesson, shown));
  lesson.fresh.forEach((shown) => complete(lesson, shown));
  return lesson;
}

// Paths that the document has by their actions get their frames.
function complete(lesson: Lesson, shown: Driven & { alternative?: Path | null }): void {
  const table = tableOf(lesson, shown.world);
  const world = table && new World(table);
  for (const path of [shown, shown.alternative] as (Partial<Path> & { actions?: string[] })[]) {
    if (!world || !path?.actions) continue;
    const actions = path.actions.map((name) => world.actions.findIndex((action) => action.name === name));
    path.frames = world.frames(world.walk(shown.state, actions), actions);
  }
}
