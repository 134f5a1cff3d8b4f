// One team: what it was shown, how it answered, and what it came to believe.
import type { JSX } from 'preact';
import { BoardView } from '../../shared/board/board';
import { Patterns } from '../../shared/board/glyphs';
import { Legend } from '../../shared/board/legend';
import { closedAt, played } from '../../shared/board/repeats';
import { worldText } from '../../shared/board/types';
import { Lines } from '../../shared/lines';
import type { Words } from '../words';
import { amountText, bracketsOf, type Bracket, type Lessons, type PeriodRow, type TeamRow } from './lessons';

const kWide = 16; // columns; larger maps get more room

interface Props {
  lessons: Lessons;
  legend: Legend;
  team: TeamRow;
  words: Words;
}

export function titleOf({ team, strategy, composition, replicate }: TeamRow, words: Words): string {
  return `Team ${team}: ${words.strategy(strategy)}, ${composition}, replicate ${replicate}`;
}

export function TeamView({ lessons, legend, team, words }: Props): JSX.Element {
  const meanings = [words.plainStrategy(team.strategy), words.plainComposition(team.composition)].filter(Boolean);
  const sessions = [...new Set(team.periods.map(([, , session]) => session))];
  return (
    <>
      <Patterns surfaces={legend.surfaces} />
      <h3>{titleOf(team, words)}</h3>
      <p class="about">
        {meanings.length > 0 ? `${meanings.join('; ')}. ` : ''}Ticks are the members{'\u2019'} answers, in their order. Boards show the
        robot{'\u2019'}s path to its end.
      </p>
      {sessions.map((session) => (
        <SessionView
          lessons={lessons}
          legend={legend}
          periods={team.periods.filter(([, , of]) => of === session)}
          names={memberNames(team, session, words)}
          title={session === 0 ? null : `Member ${session}, taught alone`}
        />
      ))}
    </>
  );
}

function memberNames(team: TeamRow, session: number, words: Words): string[] {
  const all = [...team.composition].map((letter, i) => `member ${i + 1} (${words.type(letter).toLowerCase()})`);
  return session === 0 ? all : all.slice(session - 1, session);
}

interface SessionProps {
  lessons: Lessons;
  legend: Legend;
  periods: PeriodRow[];
  names: string[];
  title: string | null;
}

function SessionView({ lessons, legend, periods, names, title }: SessionProps): JSX.Element {
  const numbers = periods.map(([period]) => period);
  return (
    <div class="session">
      {title && <h4>{title}</h4>}
      <div class="smalls">
        <figure class="small">
          <Lines
            what="Knowledge over periods"
            width={250}
            height={120}
            lines={names.map((name, m) => ({
              name,
              label: name.replace(/^member (\d+).*/, '$1'),
              kind: 'own',
              points: periods.flatMap(({ 0: period, 6: known }) => (typeof known[m] === 'number' ? [{ period, share: known[m] / 100 }] : [])),
            }))}
          />
          <figcaption>Their own knowledge over periods</figcaption>
        </figure>
        <ul class="says">
          {bracketsOf(lessons, periods).map((bracket) => (
            <li>{narrowed(bracket, numbers)}</li>
          ))}
        </ul>
      </div>
      <ol class="periods">
        {periods.map((row) => (
          <Period lessons={lessons} legend={legend} row={row} names={names} />
        ))}
      </ol>
    </div>
  );
}

// "rubble costs 2 to 4 steps, as shown by period 3".
function narrowed({ feature, unit, isCost, ends }: Bracket, periods: number[]): string {
  const texts = ends.map((end) => amountText(end, unit));
  const last = texts[texts.length - 1] ?? '';
  return `${feature} ${isCost ? 'costs' : 'is worth'} ${last}, as shown by period ${periods[texts.indexOf(last)]}`;
}

function Period({ lessons, legend, row, names }: Omit<SessionProps, 'periods' | 'title'> & { row: PeriodRow }): JSX.Element {
  const [period, component, , shown, says, tests] = row;
  return (
    <li>
      <p class="when">
        Period {period} <span class="muted">component {component}</span>
      </p>
      <div class="boards">
        {shown.map((board, i) => (
          <Thumb lessons={lessons} legend={legend} board={board} caption={shown.length > 1 ? `Shown ${i + 1}` : 'Shown'} />
        ))}
        {tests.map(([board, right], i) => (
          <Thumb
            lessons={lessons}
            legend={legend}
            board={board}
            caption={tests.length > 1 ? `Test ${i + 1}` : 'Test'}
            ticks={<Ticks right={right} names={names} />}
          />
        ))}
      </div>
      <ul class="says">
        {[...new Set(says.map((i) => lessons.sentences[i]?.text ?? ''))].filter(Boolean).map((text) => (
          <li>{text}</li>
        ))}
      </ul>
    </li>
  );
}

function Ticks({ right, names }: { right: string; names: string[] }): JSX.Element {
  const words = { '1': 'right', '0': 'wrong', '-': 'absent' };
  return (
    <span class="ticks">
      {[...right].map((mark, i) => {
        const text = `${names[i] ?? ''}: ${words[mark as '1'] ?? 'absent'}`;
        return (
          <span class={mark === '1' ? 'right' : mark === '0' ? 'wrong' : 'absent'} title={text}>
            <span aria-hidden="true">{mark === '1' ? '\u2713' : mark === '0' ? '\u2717' : '\u2013'}</span>
            <span class="visually-hidden">{text}. </span>
          </span>
        );
      })}
    </span>
  );
}

function Thumb(props: { lessons: Lessons; legend: Legend; board: number; caption: string; ticks?: JSX.Element }): JSX.Element {
  const board = props.lessons.boards[props.board];
  if (!board) return <span />;
  const frames = played(board);
  const label = `${worldText(board)}: ${board.text}`;
  return (
    <figure class={(props.lessons.domain.width ?? 0) > kWide ? 'thumb wide' : 'thumb'}>
      <figcaption>
        {props.caption} {props.ticks}
      </figcaption>
      {board.map ? (
        <BoardView
          domain={props.lessons.domain}
          legend={props.legend}
          board={{ ...board, frames }}
          closedAt={closedAt(board)}
          step={frames.length - 1}
          label={label}
          path
        />
      ) : (
        <p class="about">{label}</p>
      )}
    </figure>
  );
}
