// What a facilitator wants to know first: who needs help, who is waited for, and how long it will still take.
import type { JSX } from 'preact';
import { duration } from '../../shared/duration';
import { minutesText, useNow } from '../clock';
import type { Answer, Forecast, RoomDetail, RoomRow, SeatRow, StudyInfo } from '../protocol';
import { Explained } from '../tip';
import { counted } from '../../shared/texts';
import { isOver, seatTitle } from '../words';

const kSlowest = 45_000; // ms; nobody is stuck before
const kTimes = 3; // so many times as long as the group usually takes for an answer
const kWrong = 3; // answers in a row
const kFew = 3; // people whose names are told
const kMany = 6; // answers of which not half were right

function usualMs(answers: Answer[]): number {
  const times = answers.map(({ ms }) => ms).sort((a, b) => a - b);
  return times[times.length >> 1] ?? 0;
}

// Why somebody may need help, or nothing.
function trouble(seat: SeatRow, answers: Answer[], now: number): string | null {
  if (seat.kind !== 'person' || seat.presence !== 'here' || seat.dropped) return null;
  if (seat.needs_help) return seat.needs_help;
  const limit = Math.max(kSlowest, kTimes * usualMs(answers));
  const since = now - (seat.stage_since_ms ?? now);
  if ((seat.stage === 'predict' || seat.stage === 'watch') && since > limit) {
    return `${seat.stage === 'predict' ? 'answering' : 'watching'} for ${duration(since)}`;
  }
  const own = answers.filter((answer) => answer.seat === seat.seat).slice(-kWrong);
  if (own.length === kWrong && own.every(({ right }) => !right)) return `the last ${kWrong} answers were wrong`;
  const all = answers.filter((answer) => answer.seat === seat.seat);
  const right = all.filter((answer) => answer.right).length;
  return all.length >= kMany && 2 * right < all.length ? `${right} of ${all.length} answers right` : null;
}

function forecastText({ minutes_low, minutes_high, periods, done_within }: Forecast): string {
  const next = done_within?.[0];
  const done = next === undefined ? '' : `; done after the next period: ${Math.round(100 * next)} %`;
  return `${minutesText(minutes_low, minutes_high)}, about ${counted(Math.round(periods), 'period')}${done}`;
}

export function Now({ room, detail, study }: { room: RoomRow; detail: RoomDetail; study: StudyInfo }): JSX.Element | null {
  const now = useNow();
  if (room.stage === 'ended' || room.stage === 'lobby') return null;
  const away = room.seats.filter((seat) => seat.presence === 'away' && !isOver(seat));
  const stuck = room.seats.flatMap((seat) => {
    const why = trouble(seat, detail.answers, now);
    return why ? [`${seatTitle(seat)}: ${why}`] : [];
  });
  const isWaiting = room.seats.some(({ stage }) => stage === 'wait');
  const slow = room.seats.filter((seat) => isWaiting && seat.presence === 'here' && !isOver(seat) && seat.stage !== 'wait');
  const waited = [...away.map((seat) => `${seatTitle(seat)}, away for ${duration(now - seat.since_ms)} (of ${study.grace_s} s)`), ...(slow.length > kFew ? [`${slow.length} people`] : slow.map(seatTitle))];
  const { forecast } = room;
  return (
    <dl class="now-facts">
      <div class={stuck.length > 0 ? 'alarm' : undefined}>
        <dt>Needs help</dt>
        <dd>{stuck.length === 0 ? 'nobody' : stuck.join('; ')}</dd>
      </div>
      <div class={away.length > 0 ? 'alarm' : undefined}>
        <dt>Waited for</dt>
        <dd>{waited.length === 0 ? 'nobody' : waited.join('; ')}</dd>
      </div>
      <div>
        <dt>
          <Explained term="forecast">Time left</Explained>
        </dt>
        <dd>{forecast ? forecastText(forecast) : 'not known yet'}</dd>
      </div>
    </dl>
  );
}
