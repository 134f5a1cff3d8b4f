// Who is missing and for how long, what happens next, and how to leave.
import type { JSX } from 'preact';
import { useState } from 'preact/hooks';
import { duration } from '../../shared/duration';
import { serverNow, useTick } from '../clock';
import { Button, Heading, NextStep, Paragraphs, Since } from '../parts/ui';
import type { ScreenProps } from '../screen';
import { t } from '../../shared/texts';

type Shown = NonNullable<ScreenProps['view']['lobby']>;

export function Lobby({ lobby, view, connection }: ScreenProps & { lobby: Shown }): JSX.Element {
  const { present, size } = lobby;
  const missing = Math.max(0, size - present);
  return (
    <>
      <Heading>{t('lobby.title')}</Heading>
      <Seats present={present} size={size} />
      <p class="lead" role="status">
        {missing === 0 ? t('lobby.all') : `${t('lobby.present', { n: present, size })} ${t('lobby.missing', { n: missing })}`}
      </p>
      <Since ms={lobby.since_ms} />
      <NextStep>
        <p>{t('lobby.next')}</p>
        <Limit until={lobby.until_ms} />
        <Leave lobby={lobby} connection={connection} />
      </NextStep>
      {(view.study.story.length > 0 || view.study.goal) && (
        <section class="story" aria-labelledby="story-title">
          <h2 id="story-title">{t('intro.title')}</h2>
          <Paragraphs texts={view.study.story} />
          {view.study.goal && <p class="goal">{view.study.goal}</p>}
        </section>
      )}
    </>
  );
}

function Seats({ present, size }: { present: number; size: number }): JSX.Element {
  return (
    <ul class="seats">
      {Array.from({ length: size }, (_, i) => (
        <li class={i < present ? 'here' : 'missing'}>
          <svg viewBox="0 0 40 44" aria-hidden="true" focusable="false">
            <circle cx={20} cy={13} r={9} />
            <path d="M4 42c0-11 7-17 16-17s16 6 16 17z" />
          </svg>
          <span>{t(i < present ? 'lobby.seat_here' : 'lobby.seat_missing')}</span>
        </li>
      ))}
    </ul>
  );
}

function Limit({ until }: { until: number | undefined }): JSX.Element | null {
  useTick();
  return until === undefined ? null : <p>{t('lobby.next_limit', { time: duration(until - serverNow()) })}</p>;
}

function Leave({ lobby, connection }: { lobby: Shown; connection: ScreenProps['connection'] }): JSX.Element {
  useTick();
  const [asks, setAsks] = useState(false);
  const off = connection.isPending('leave');
  const left = lobby.leave_after_ms - serverNow();
  if (left > 0) return <p>{t('lobby.leave_later', { time: duration(left) })}</p>;
  return (
    <>
      <p>{t('lobby.leave_text')}</p>
      <Button off={asks || off} onClick={() => setAsks(true)}>
        {t('lobby.leave')}
      </Button>
      {asks && (
        <div class="sure">
          <p role="status">{t('lobby.leave_sure')}</p>
          <div class="buttons">
            <Button primary off={off} onClick={() => setAsks(false)}>
              {t('lobby.stay')}
            </Button>
            <Button off={off} onClick={() => connection.send('leave', {})}>
              {t('lobby.leave')}
            </Button>
          </div>
        </div>
      )}
    </>
  );
}
