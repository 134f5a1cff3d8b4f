// Where the session is: components and timers.
import type { JSX } from 'preact';
import { duration } from '../../shared/duration';
import { useNow } from '../clock';
import type { RoomDetail, RoomRow, Timer } from '../protocol';
import { Explained } from '../tip';
import { capitalised } from '../../shared/texts';
import { phaseName } from '../words';

const kStatus = { open: 'not learned yet', learned: 'learned', skipped: 'skipped' };

export function Progress({ room, detail }: { room: RoomRow; detail: RoomDetail }): JSX.Element {
  const now = useNow();
  const { components, component } = detail.session;
  return (
    <section class="progress" aria-labelledby="progress-title">
      <h3 id="progress-title">
        <Explained term="component">Components</Explained>
      </h3>
      <ol class="components">
        {components.map(({ name, status }, i) => {
          const isNow = room.stage !== 'ended' && status === 'open' && component === i + 1;
          return (
            <li class={`${status}${isNow ? ' now' : ''}`} aria-current={isNow ? 'step' : undefined}>
              <svg width="12" height="12" viewBox="-6 -6 12 12" aria-hidden="true">
                {status === 'learned' && <path d="M-4 .5-1 3.5 4.5 -3.5" />}
                {status === 'skipped' && <path d="M-4 0H4" />}
                {status === 'open' && <circle r={isNow ? 3.5 : 3} class={isNow ? 'full' : undefined} />}
              </svg>
              {name} <span class="visually-hidden">({isNow ? 'being taught' : kStatus[status]})</span>
            </li>
          );
        })}
      </ol>
      <dl class="timers">
        {detail.timers.filter(isShown).map((timer) => (
          <div>
            <dt>{timerName(timer, detail.session.phase)}</dt>
            <dd class={isLate(timer, now) ? 'late' : undefined}>{timerText(timer, now)}</dd>
          </div>
        ))}
      </dl>
    </section>
  );
}

const kTimers: Record<string, string> = { session: 'Session', pause: 'Paused', lobby: 'Lobby' };

// How long the session has been running is in the bar above.
const isShown = ({ name, until_ms }: Timer): boolean => name !== 'session' || until_ms !== undefined;

const timerName = ({ name }: Timer, phase: string): string =>
  name === 'phase' ? phaseName(phase) : (kTimers[name] ?? capitalised(name));

const isLate = ({ until_ms }: Timer, now: number): boolean => until_ms !== undefined && until_ms - now < 15_000;

function timerText({ since_ms, until_ms }: Timer, now: number): string {
  if (until_ms === undefined) return duration(now - since_ms);
  return until_ms > now ? `${duration(until_ms - now)} left` : 'over';
}
