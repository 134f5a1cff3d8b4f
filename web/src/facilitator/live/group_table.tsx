// Everybody in the room, one row each: who is there, what they are doing, and all their answers.
import type { ComponentChildren, JSX } from 'preact';
import { useLayoutEffect, useRef } from 'preact/hooks';
import { duration } from '../../shared/duration';
import { secondsText, useNow } from '../clock';
import type { Answer, PersonAudit, RoomDetail, RoomRow, SeatRow, StudyInfo } from '../protocol';
import { Explained } from '../tip';
import { memberOfSeat } from './beliefs';
import { isOver, kPresence, personStage, seatTitle, statusOf, statusText, typeLabel } from '../words';

interface Column {
  period: number;
  test: number;
  isFirst: boolean; // of its period
}

function columnsOf(answers: Answer[]): Column[] {
  const seen = new Map<string, Column>();
  for (const { period, test } of answers) seen.set(`${period}/${test}`, { period, test, isFirst: false });
  const sorted = [...seen.values()].sort((a, b) => a.period - b.period || a.test - b.test);
  return sorted.map((column, i) => ({ ...column, isFirst: sorted[i - 1]?.period !== column.period }));
}

export const answerText = ({ right, regret, ms, stopped_short, changed, right_in_the_end }: Answer): string =>
  `${right ? 'right' : 'wrong'}${stopped_short ? ', stopped before the end' : ''}, regret ${regret.toFixed(2)}, ${secondsText(ms)}` +
  (changed ? `, then changed to ${right_in_the_end ? 'a right' : 'a wrong'} one` : '');

interface GroupTableProps {
  study: StudyInfo;
  room: RoomRow;
  detail: RoomDetail;
  marked: number | null;
  onMark: (member: number | null) => void;
  onOpen?: ((seat: SeatRow) => void) | undefined;
}

export function GroupTable({ study, room, detail, marked, onMark, onOpen }: GroupTableProps): JSX.Element {
  const now = useNow();
  const columns = columnsOf(detail.answers);
  const byPlace = new Map(detail.answers.map((answer) => [`${answer.seat}/${answer.period}/${answer.test}`, answer]));
  const hasStageTimes = room.seats.some(({ stage_since_ms }) => stage_since_ms !== undefined);
  const audits = new Map((detail.people ?? []).map((one) => [one.seat, one]));
  const hasKinds = [...audits.values()].some(({ kind }) => kind !== undefined);
  const longest = Math.max(1, ...detail.answers.map(({ ms }) => ms));
  // The latest answers are at the right end, which has to be seen.
  const box = useRef<HTMLDivElement>(null);
  useLayoutEffect(() => {
    if (box.current && box.current.clientWidth > kWide) box.current.scrollLeft = box.current.scrollWidth;
  }, [columns.length, hasKinds]);
  const periods = [...new Set(columns.map(({ period }) => period))];
  return (
    <div class="group" ref={box} role="region" aria-label="Group" tabIndex={0}>
      <table>
        <thead>
          <tr>
            <th scope="col">Seat</th>
            <th scope="col">State</th>
            <th scope="col" class="number">
              {hasStageTimes ? 'Since' : 'Present'}
            </th>
            <th scope="col" class="number">
              Right
            </th>
            {audits.size > 0 && (
              <th scope="col" class="number">
                <Explained term="knows">Knows</Explained>
              </th>
            )}
            {audits.size > 0 && (
              <th scope="col">
                <Explained term="thinks">Likely thinks</Explained>
              </th>
            )}
            {hasKinds && (
              <th scope="col">
                <Explained term="learner_kind">Kind</Explained>
              </th>
            )}
            {periods.map((period) => (
              <th scope="colgroup" class="period" colSpan={columns.filter((column) => column.period === period).length}>
                <span class="visually-hidden">Answers in period </span>
                {period}
              </th>
            ))}
            <td class="rest">{columns.length === 0 && 'No answers yet'}</td>
          </tr>
        </thead>
        <tbody>
          {room.seats.map((seat) => (
            <tr
              key={seat.seat}
              class={marked === memberOfSeat(seat) ? 'marked' : undefined}
              onPointerEnter={() => onMark(memberOfSeat(seat))}
              onPointerLeave={() => onMark(null)}
              onFocusIn={() => onMark(memberOfSeat(seat))}
              onFocusOut={() => onMark(null)}
            >
              <th scope="row">
                {onOpen ? (
                  <button type="button" class="seat" onClick={() => onOpen(seat)} aria-haspopup="dialog">
                    <PresenceMark seat={seat} /> {seatTitle(seat)}
                  </button>
                ) : (
                  <span class="seat">
                    <PresenceMark seat={seat} /> {seatTitle(seat)}
                  </span>
                )}
                {seat.type && (
                  <span class="type" data-tip={seat.kind === 'simulated' ? `Simulated learner: ${typeLabel(study, seat.type)}` : `Type in the composition: ${typeLabel(study, seat.type)}`}>
                    {seat.type}
                  </span>
                )}
              </th>
              <td class={`state ${isOver(seat) ? 'left' : seat.presence}`} data-tip={whereabouts(seat, now)}>
                {seat.presence === 'away' && !isOver(seat) ? kPresence.away : stateText(seat)}
              </td>
              <td class="number">{timeText(seat, now)}</td>
              <td class="number">{rightText(detail.answers, seat)}</td>
              {audits.size > 0 && <Thought audit={audits.get(seat.seat)} />}
              {hasKinds && <Kind audit={audits.get(seat.seat)} />}
              {columns.map(({ period, test, isFirst }) => (
                <Cell answer={byPlace.get(`${seat.seat}/${period}/${test}`)} where={`period ${period}, test ${test}`} longest={longest} isFirst={isFirst} />
              ))}
              <td class="rest" />
            </tr>
          ))}
        </tbody>
      </table>
    </div>
  );
}

const kWide = 640; // px; below, what stands beside the names would be out of sight

function rightText(answers: Answer[], { seat }: SeatRow): string {
  const own = answers.filter((answer) => answer.seat === seat);
  return own.length === 0 ? '' : `${own.filter(({ right }) => right).length}/${own.length}`;
}

// What somebody knows and thinks, by their answers: two cells.
function Thought({ audit }: { audit: PersonAudit | undefined }): JSX.Element {
  const share = (value: number): string => `${Math.round(100 * value)} %`;
  const verdicts = audit?.components.filter(({ level }) => level !== null).map(({ name, verdict, level }) => `${name}: ${verdict}, ${share(level ?? 0)}`);
  if (audit?.exam) verdicts?.unshift(`Exam: ${audit.exam.replaceAll('-', ' ')}`);
  return (
    <>
      <td class="number" data-tip={verdicts?.join('; ')}>
        {audit ? share(audit.knows) : ''}
      </td>
      <td class="thinks" data-tip={audit?.thinks && `Thinks that ${audit.thinks} (${share(audit.probability ?? 0)})`}>
        {audit?.thinks ?? ''}
      </td>
    </>
  );
}

// What kind of learner somebody seems to be, with all probabilities from 1 % on.
function Kind({ audit }: { audit: PersonAudit | undefined }): JSX.Element {
  if (!audit?.kind) return <td />;
  const all = Object.entries(audit.kinds ?? {})
    .map(([kind, probability]) => ({ kind, percent: Math.round(100 * probability) }))
    .filter(({ percent }) => percent > 0)
    .sort((a, b) => b.percent - a.percent);
  return (
    <td class="thinks kind" data-tip={all.map(({ kind, percent }) => `${kind} ${percent} %`).join(', ')}>
      {audit.kind}
    </td>
  );
}

export function stateText(seat: SeatRow): string {
  if (seat.kind === 'simulated') return 'simulated';
  if (isOver(seat)) return statusText(seat);
  if (seat.presence === 'empty') return kPresence.empty;
  return seat.presence === 'away' ? `away (${personStage(seat.stage)})` : personStage(seat.stage);
}

// "answering; connected for 3:12"
export function whereabouts(seat: SeatRow, now: number): string {
  if (seat.kind === 'simulated') return 'simulated learner';
  if (seat.presence === 'empty' || seat.since_ms === 0) return stateText(seat);
  if (seat.presence === 'left') return `${statusText(seat)}; gone for ${duration(now - seat.since_ms)}`;
  return `${isOver(seat) ? statusText(seat) : personStage(seat.stage)}; ${kPresence[seat.presence]} for ${duration(now - seat.since_ms)}`;
}

// How long somebody has been at their stage, or else connected or away.
function timeText(seat: SeatRow, now: number): string {
  if (seat.kind === 'simulated') return '';
  const since = seat.presence === 'here' ? (seat.stage_since_ms ?? seat.since_ms) : seat.since_ms;
  return since === 0 || seat.presence === 'empty' ? '' : duration(now - since);
}

// A tick has finished, a dash was in a room that ended before its time; everybody else who is gone has a cross.
const kMarks: Partial<Record<string, string>> = { finished: 'M-4 .5-1 3.5 4.5 -3.5', ended: 'M-4 0H4' };

// Shape and colour: a full circle is connected, a half one away, a ring empty, a square a program.
export function PresenceMark({ seat }: { seat: SeatRow }): JSX.Element {
  const state = seat.kind === 'simulated' ? 'simulated' : isOver(seat) ? 'left' : seat.presence;
  return (
    <svg class={`presence ${state}`} width="11" height="11" viewBox="-6 -6 12 12" role="img" aria-label={state === 'simulated' ? 'simulated' : state === 'left' ? statusText(seat) : kPresence[seat.presence]}>
      {state === 'simulated' && <rect x={-4} y={-4} width={8} height={8} />}
      {state === 'here' && <circle r={4.5} />}
      {state === 'away' && <circle class="ring" r={4} />}
      {state === 'away' && <path d="M0 -4A4 4 0 0 1 0 4Z" />}
      {state === 'empty' && <circle class="ring" r={4} />}
      {state === 'left' && <path class="ring" d={kMarks[statusOf(seat)] ?? 'M-4 -4 4 4M4 -4-4 4'} />}
    </svg>
  );
}

interface CellProps {
  answer: Answer | undefined;
  where: string;
  longest: number;
  isFirst: boolean;
}

// A tick on green or a cross on orange; the line below is the time taken, relative to the longest in the room. An answer
// that was changed after a discussion is followed by what it was then.
function Cell({ answer, where, longest, isFirst }: CellProps): JSX.Element {
  const first = isFirst ? ' first' : '';
  if (!answer) {
    return (
      <td class={`answer-cell${first}`}>
        <span class="visually-hidden">no answer</span>
      </td>
    );
  }
  const text = `${where}: ${answerText(answer)}`;
  return (
    <td class={`answer-cell ${answer.right ? 'right' : 'wrong'}${first}`} data-tip={text.charAt(0).toUpperCase() + text.slice(1)}>
      <span role="img" aria-label={answerText(answer)}>
        <Verdict right={answer.right}>
          {answer.stopped_short && <path class="short" d="M13 2.5V11.5" />}
          <path class="time" d={`M1 16.5h${(14 * Math.min(1, answer.ms / longest)).toFixed(1)}`} />
        </Verdict>
        {answer.changed && <span class="then">{'\u2192'}</span>}
        {answer.changed && <Verdict right={answer.right_in_the_end === true} />}
      </span>
    </td>
  );
}

function Verdict({ right, children }: { right: boolean; children?: ComponentChildren }): JSX.Element {
  return (
    <svg class={right ? 'right' : 'wrong'} viewBox="0 0 16 18" width="16" height="18">
      <rect class="ground" x={0.5} y={0.5} width={15} height={13} rx={2.5} />
      <path class="mark" d={right ? 'M4.2 7.2 7 10 11.8 4.2' : 'M5 4 11 10M11 4 5 10'} />
      {children}
    </svg>
  );
}
