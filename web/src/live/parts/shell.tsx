// What is around every screen: the title, whether everything is saved, how far the session is, messages and pauses.
import type { ComponentChildren, JSX } from 'preact';
import { useState } from 'preact/hooks';
import { Patterns } from '../../shared/board/glyphs';
import { duration } from '../../shared/duration';
import { serverNow, useTick } from '../clock';
import type { Connection, Snapshot } from '../connection';
import type { ParticipantView, Pause, Stage } from '../protocol';
import { remembered } from '../memory';
import { keep, recall } from '../storage';
import { sentence, t } from '../../shared/texts';
import { Button } from './ui';

interface Props {
  connection: Connection;
  snapshot: Snapshot;
  view: ParticipantView;
  children: ComponentChildren;
}

export function Shell({ connection, snapshot, view, children }: Props): JSX.Element {
  const { check, watch, predict, discuss, feedback } = view;
  const board = (check ?? watch ?? predict ?? discuss ?? feedback?.tests[0] ?? (view.debrief && remembered().first))?.board;
  return (
    <>
      {board && <Patterns surfaces={board.domain.surfaces ?? []} />}
      <header class="top">
        <p class="study-title">{view.study.title}</p>
        <Status snapshot={snapshot} stage={view.stage} />
        {view.progress && <Progress {...view.progress} />}
      </header>
      <div class="messages">
        <Lost connection={connection} snapshot={snapshot} />
        <Refusal connection={connection} snapshot={snapshot} />
        <Notices notices={view.notices} />
        {view.pause && <Paused pause={view.pause} />}
      </div>
      <main id="main" tabIndex={-1} class={`stage-${view.stage}`} inert={view.pause !== undefined}>
        {children}
      </main>
    </>
  );
}

// Nothing of these people is stored, so the page must not call it saved.
const kUnstored: readonly Stage[] = ['consent', 'declined', 'full'];

// A tick, an arrow or an exclamation mark, and always a word.
function Status({ snapshot, stage }: { snapshot: Snapshot; stage: Stage }): JSX.Element {
  const state = snapshot.socket.phase !== 'open' ? 'reconnecting' : snapshot.pending.length > 0 ? 'saving' : 'saved';
  const signs = { saved: '\u2713', saving: '\u2191', reconnecting: '!' };
  return (
    <p class={`status ${state}`} role="status">
      {!(state === 'saved' && kUnstored.includes(stage)) && (
        <>
          <span aria-hidden="true">{signs[state]}</span> {t(`status.${state}`)}
        </>
      )}
    </p>
  );
}

// A segment for every round that there may be, as the group may be done sooner; of many rounds, one for every part.
function Progress({ part, parts, round, most }: NonNullable<ParticipantView['progress']>): JSX.Element {
  const isByRound = most <= kMostSegments;
  const text = t(isByRound ? 'progress.rounds' : 'progress.part', { part, parts, round, most });
  const [now, all] = isByRound ? [round, most] : [part, parts];
  return (
    <div class="progress">
      <span>{text}</span>
      <span class="segments" aria-hidden="true">
        {Array.from({ length: all }, (_, i) => (
          <i class={i + 1 < now ? 'done' : i + 1 === now ? 'now' : undefined} />
        ))}
      </span>
    </div>
  );
}

const kMostSegments = 20;
const kPatience = 2000; // a short break needs no banner

function Lost({ connection, snapshot }: { connection: Connection; snapshot: Snapshot }): JSX.Element | null {
  useTick();
  const { phase, since, bye } = snapshot.socket;
  const time = performance.now() - since;
  if (phase !== 'lost' || time < kPatience) return null;
  const isStopping = bye === 'server-stops';
  return (
    <div class="message warning">
      <p>{isStopping ? t('bye.server-stops.text') : t('status.lost', { time: duration(time) })}</p>
      <Button onClick={() => connection.reopen()}>{t('status.retry')}</Button>
    </div>
  );
}

function Refusal({ connection, snapshot }: { connection: Connection; snapshot: Snapshot }): JSX.Element {
  const { refused } = snapshot;
  return (
    <div role="alert">
      {refused && (
        <div class="message warning">
          <p>
            <strong>{t('refused.title')}.</strong> {sentence(refused.text)}
          </p>
          <Button onClick={() => connection.dismissRefusal()}>{t('refused.dismiss')}</Button>
        </div>
      )}
    </div>
  );
}

function Notices({ notices }: { notices: ParticipantView['notices'] }): JSX.Element {
  const [dismissed, setDismissed] = useState(() => recall<number>('dismissed') ?? 0);
  const fresh = notices.filter(({ at_ms }) => at_ms > dismissed);
  const dismiss = (): void => {
    const latest = Math.max(...notices.map(({ at_ms }) => at_ms));
    setDismissed(latest);
    keep('dismissed', latest);
  };
  return (
    <div role="status">
      {fresh.length > 0 && (
        <div class="message notice">
          <div>
            <p class="notice-title">{t('notice.title')}</p>
            {fresh.map(({ text }) => (
              <p>{text}</p>
            ))}
          </div>
          <Button onClick={dismiss}>{t('notice.dismiss')}</Button>
        </div>
      )}
    </div>
  );
}

function Paused({ pause }: { pause: Pause }): JSX.Element {
  useTick();
  const { why, since_ms, until_ms, missing } = pause;
  return (
    <section class="pause" aria-labelledby="pause-title">
      <div role="status">
        <h2 id="pause-title">{t('pause.title')}</h2>
        <p>{t(`pause.${why}`, { n: missing })}</p>
      </div>
      <p class="muted time">{t('common.since', { time: duration(serverNow() - since_ms) })}</p>
      {until_ms !== undefined && <p>{t('pause.until', { time: duration(until_ms - serverNow()) })}</p>}
      <p>{t('pause.next')}</p>
    </section>
  );
}

// The frame of pages without a session.
export function Bare({ children }: { children: ComponentChildren }): JSX.Element {
  return (
    <main id="main" tabIndex={-1} class="bare">
      {children}
    </main>
  );
}
