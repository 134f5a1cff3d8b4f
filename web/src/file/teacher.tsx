// What the teacher showed and why, and what it took people to believe, period by period: as facilitators see a room, in
// a tree of its own, so that its style sheet and that of the page around it leave each other alone.
import { render, type JSX } from 'preact';
import { useLayoutEffect, useRef, useState } from 'preact/hooks';
import { RoomPicture } from '../facilitator/live/picture';
import type { RoomDetail, RoomRow, StudyInfo } from '../facilitator/protocol';
import { Tips } from '../facilitator/tip';
import sheet from './teacher.css?text';

export interface Teacher {
  study: StudyInfo;
  periods: { row: RoomRow; room: RoomDetail }[]; // after each of them, and now
}

export function TeacherView({ teacher, period, onPeriod }: { teacher: Teacher; period: number; onPeriod: (period: number) => void }): JSX.Element {
  const host = useRef<HTMLDivElement>(null);
  const last = teacher.periods.length - 1;
  const at = Math.min(period, last);
  useLayoutEffect(() => {
    const picture = teacher.periods[at];
    if (!host.current || !picture) return;
    const tree = host.current.shadowRoot ?? host.current.attachShadow({ mode: 'open' });
    if (tree.adoptedStyleSheets.length === 0) {
      const own = new CSSStyleSheet();
      own.replaceSync(sheet);
      tree.adoptedStyleSheets = [own];
    }
    render(
      <>
        <RoomPicture study={teacher.study} room={picture.row} detail={picture.room} />
        <Tips />
      </>,
      tree,
    );
  });
  return (
    <div lang="en" dir="ltr">
      <p class="teacher-steps">
        <label>
          Period{' '}
          <input
            type="range"
            min={0}
            max={last}
            value={at}
            aria-valuetext={momentOf(teacher, at)}
            onInput={(event) => onPeriod(event.currentTarget.valueAsNumber)}
          />
        </label>{' '}
        <span aria-live="polite">{momentOf(teacher, at)}</span>
      </p>
      <div ref={host} class="teacher-picture" />
    </div>
  );
}

function momentOf({ periods }: Teacher, at: number): string {
  const { row, room } = periods[at] ?? {};
  if (!row || !room) return '';
  if (row.stage === 'ended' || row.stage === 'questions') return `at the end, after period ${row.period}`;
  if (row.period === 0) return 'before the first period';
  return room.session.phase === 'teacher' || room.session.phase === 'feedback' ? `after period ${row.period - (room.session.phase === 'teacher' ? 1 : 0)}` : `in period ${row.period}`;
}

// In the lesson's place, for those who study it.
export function Researcher({ load, back }: { load: () => Promise<Teacher>; back: () => void }): JSX.Element {
  const [teacher, setTeacher] = useState<Teacher | null>(null);
  const [period, setPeriod] = useState(Infinity);
  const heading = useRef<HTMLHeadingElement>(null);
  useLayoutEffect(() => {
    void load().then(setTeacher);
    heading.current?.focus({ preventScroll: true });
    window.scrollTo(0, 0);
  }, []);
  return (
    <main id="main" tabIndex={-1}>
      <h1 tabIndex={-1} ref={heading} lang="en" dir="ltr">
        How this lesson was chosen
      </h1>
      <div lang="en" dir="ltr">
        <p class="lead">
          This page is for researchers. It shows how the program chose its examples, and what it took the learner to
          think. Learners do not need it.
        </p>
        <p>
          <button type="button" onClick={back}>
            Back to the lesson
          </button>
        </p>
      </div>
      {teacher && <TeacherView teacher={teacher} period={period} onPeriod={setPeriod} />}
    </main>
  );
}
