// Last pages: the debriefing, and the ends that come sooner.
import type { JSX } from 'preact';
import { useState } from 'preact/hooks';
import { useLegend } from '../../shared/play/board_pane';
import { SmallBoard } from '../../shared/play/small_board';
import { remembered, type Memory } from '../memory';
import { exploreTitle, Exploring } from '../parts/explore';
import { Button, CompletionCode, GoOn, Heading } from '../parts/ui';
import type { Judged, ParticipantView, Update } from '../protocol';
import type { ScreenProps } from '../screen';
import { pathOf } from './feedback';
import { hasText, isEnglish, sentence, t, type TextKey } from '../../shared/texts';
import { transport } from '../../shared/transport';

type Shown = NonNullable<ParticipantView['debrief']>;

export function Debrief({ debrief, isSaved, view, connection }: ScreenProps & { debrief: Shown; isSaved: boolean }): JSX.Element {
  const { code, redirect, rounds, right, tests, summary, not_reached } = debrief;
  const [memory] = useState(remembered);
  return (
    <>
      <Heading>{t('debrief.title')}</Heading>
      <p class="lead">{t('debrief.done')}</p>
      {tests > 0 && <p>{t('debrief.score', { right, tests, rounds })}</p>}
      {code && !transport().isAlone && <CompletionCode code={code} />}
      <GoOn address={redirect} isSaved={isSaved} />
      <Sentences name="summary" texts={summary} boards={memory.boards} update={view.study.update} />
      <Sentences name="not_reached" texts={not_reached} />
      <FirstAndLast {...memory} />
      {view.explore && (
        <section class="explore-part no-print" aria-labelledby="explore-title">
          <h2 id="explore-title">{exploreTitle(view.explore)}</h2>
          <Exploring explore={view.explore} onAsk={(asked) => asked && connection.send('explore', asked)} />
        </section>
      )}
      {summary.length > 0 && (
        <p class="no-print">
          <Button onClick={() => window.print()}>{t('debrief.print')}</Button>
        </p>
      )}
    </>
  );
}

interface SentencesProps {
  name: 'summary' | 'not_reached';
  texts: string[];
  boards?: Record<string, Judged>; // on which they were seen
  update?: Update | undefined; // what of it is new
}

// What the robot is like, as far as the group was taught it, or as far as it was not.
function Sentences({ name, texts, boards, update }: SentencesProps): JSX.Element | null {
  if (texts.length === 0) return null;
  const isNew = (text: string): boolean => update?.news.some((one) => sentence(one) === sentence(text)) ?? false;
  return (
    <section class="summary" aria-labelledby={`${name}-title`}>
      <h2 id={`${name}-title`}>{t(`debrief.${name}`)}</h2>
      <ul class={boards ? 'lines' : undefined}>
        {texts.map((text) => {
          const test = boards?.[text];
          return (
            <li>
              {sentence(text)} {isNew(text) && <em>{t('debrief.new')}</em>}
              {test && <Picture test={test} isAlone />}
            </li>
          );
        })}
      </ul>
    </section>
  );
}

function Picture({ test, isAlone }: { test: Judged; isAlone?: boolean }): JSX.Element {
  const { board, mine, right, differs_at } = test;
  const legend = useLegend(board.domain);
  const other = isAlone || right || !mine ? null : pathOf(mine, test.mine_repeats_from);
  return <SmallBoard board={board} legend={legend} path={pathOf(test.robot, test.robot_repeats_from)} other={other} at={differs_at} />;
}

function FirstAndLast({ first, last }: Memory): JSX.Element | null {
  if (!first || !last || JSON.stringify(first) === JSON.stringify(last)) return null;
  const one = (test: Judged, key: TextKey): JSX.Element => (
    <figure>
      <Picture test={test} />
      <figcaption>
        {t(key)} {t(test.right ? 'debrief.was_right' : 'debrief.was_wrong')}
      </figcaption>
    </figure>
  );
  return (
    <section class="summary" aria-labelledby="far-title">
      <h2 id="far-title">{t('debrief.far')}</h2>
      <div class="lines">
        {one(first, 'debrief.first')}
        {one(last, 'debrief.last')}
      </div>
    </section>
  );
}

export type LastStage = 'declined' | 'full' | 'ended' | 'replaced';

export function Ended({ view, stage, isSaved }: { view: ParticipantView; stage: LastStage; isSaved: boolean }): JSX.Element {
  const { end } = view;
  const own = `end.reason.${end?.reason ?? ''}`; // the server's sentence is English
  const text = hasText(own) ? t(own) : end?.text && isEnglish() ? sentence(end.text) : t(`end.text.${stage}`);
  return (
    <>
      <Heading>{t(`end.title.${stage}`)}</Heading>
      <p class="lead">{text}</p>
      {end?.code && <CompletionCode code={end.code} />}
      <GoOn address={end?.redirect} isSaved={isSaved} />
    </>
  );
}
