// A team of a report, taught again from its inputs, with what it came to believe after every period.
import type { JSX } from 'preact';
import { useEffect, useState } from 'preact/hooks';
import type { Lessons, PeriodRow } from '../report/team/lessons';
import { Engine, type State } from './engine';
import { TeacherView, type Teacher } from './teacher';

export interface TaughtAgain {
  inputs: Record<string, string>;
  teams: Record<string, Record<string, unknown>>; // setups of rooms, by the number of the team
}

let engine: Engine | null = null; // one for the page

interface Props {
  again: TaughtAgain;
  lessons: Lessons;
  team: number;
}

export function Again({ again, lessons, team }: Props): JSX.Element {
  const [teacher, setTeacher] = useState<Teacher | null>(null);
  const [period, setPeriod] = useState(Infinity);
  const [said, setSaid] = useState('The team is being taught...');
  useEffect(() => {
    let isCurrent = true;
    const teach = async (): Promise<void> => {
      engine ??= Engine.start();
      let state = await engine.ask<State>({ do: 'open', inputs: again.inputs, setup: again.teams[String(team)] });
      while (state.teaching && isCurrent) {
        state = await engine.ask<State>({ do: 'teach' });
        const now = await engine.ask<Teacher>({ do: 'teacher' });
        if (!isCurrent) return;
        setTeacher(now);
        if (!state.teaching) setSaid(compared(now, lessons, team));
      }
    };
    teach().catch((error: unknown) => isCurrent && setSaid(`This team cannot be taught in a page: ${error instanceof Error ? error.message : String(error)}`));
    return () => {
      isCurrent = false;
    };
  }, [team]);
  return (
    <div>
      <p role="status">{said}</p>
      {teacher && <TeacherView teacher={teacher} period={period} onPeriod={setPeriod} />}
    </div>
  );
}

// Whether the lessons are those that the tables of the run have.
function compared({ periods }: Teacher, { boards, teams }: Lessons, team: number): string {
  const recorded = teams.find((row) => row.team === team)?.periods ?? [];
  const placeOf = (world: number, start: unknown): string => JSON.stringify([world, start]);
  const same = (row: PeriodRow, i: number): boolean => {
    const lesson = periods[i]?.room.lesson;
    const [, , , shown, , tests] = row;
    const old = [...shown, ...tests.map(([board]) => board)].map((at) => placeOf(boards[at]?.world ?? -1, boards[at]?.start));
    const now = [...(lesson?.demonstrations ?? []), ...(lesson?.tests ?? [])].map(({ board }) => placeOf(board.world, board.start));
    return JSON.stringify(old) === JSON.stringify(now);
  };
  const taught = periods[periods.length - 1]?.row.period ?? 0;
  const first = recorded.findIndex((row, i) => !same(row, i));
  if (first < 0 && recorded.length === taught) return `Taught again: all ${taught} lessons are those of the run.`;
  const other = (first < 0 ? Math.min(recorded.length, taught) : first) + 1;
  return `Taught again: from period ${other} on the lessons differ from those of the run. Pages round the last digits differently.`;
}
