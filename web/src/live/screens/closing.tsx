// Last pages: the debriefing, and the ends that come sooner.
import type { JSX } from 'preact';
import { CompletionCode, GoOn, Heading } from '../parts/ui';
import type { ParticipantView } from '../protocol';
import { hasText, isEnglish, sentence, t } from '../texts';

export function Debrief({ debrief, isSaved }: { debrief: NonNullable<ParticipantView['debrief']>; isSaved: boolean }): JSX.Element {
  const { code, redirect, rounds, right, tests } = debrief;
  const summary = [...new Set(debrief.summary.map(sentence))]; // parts may teach the same
  return (
    <>
      <Heading>{t('debrief.title')}</Heading>
      <p class="lead">{t('debrief.done')}</p>
      {tests > 0 && <p>{t('debrief.score', { right, tests, rounds })}</p>}
      {code && <CompletionCode code={code} />}
      <GoOn address={redirect} isSaved={isSaved} />
      {summary.length > 0 && (
        <section class="summary" aria-labelledby="summary-title">
          <h2 id="summary-title">{t('debrief.summary')}</h2>
          <ul>
            {summary.map((text) => (
              <li>{text}</li>
            ))}
          </ul>
        </section>
      )}
    </>
  );
}

export function Ended({ view, isSaved }: { view: ParticipantView; isSaved: boolean }): JSX.Element {
  const { stage, end } = view;
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
