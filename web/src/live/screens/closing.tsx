// Last pages: the debriefing, and the ends that come sooner.
import type { JSX } from 'preact';
import { CompletionCode, GoOn, Heading } from '../parts/ui';
import type { ParticipantView } from '../protocol';
import { hasText, isEnglish, sentence, t } from '../../shared/texts';

export function Debrief({ debrief, isSaved }: { debrief: NonNullable<ParticipantView['debrief']>; isSaved: boolean }): JSX.Element {
  const { code, redirect, rounds, right, tests, summary, not_reached } = debrief;
  return (
    <>
      <Heading>{t('debrief.title')}</Heading>
      <p class="lead">{t('debrief.done')}</p>
      {tests > 0 && <p>{t('debrief.score', { right, tests, rounds })}</p>}
      {code && <CompletionCode code={code} />}
      <GoOn address={redirect} isSaved={isSaved} />
      <Sentences name="summary" texts={summary} />
      <Sentences name="not_reached" texts={not_reached} />
    </>
  );
}

// What the robot is like, as far as the group was taught it, or as far as it was not.
function Sentences({ name, texts }: { name: 'summary' | 'not_reached'; texts: string[] }): JSX.Element | null {
  if (texts.length === 0) return null;
  return (
    <section class="summary" aria-labelledby={`${name}-title`}>
      <h2 id={`${name}-title`}>{t(`debrief.${name}`)}</h2>
      <ul>
        {texts.map((text) => (
          <li>{sentence(text)}</li>
        ))}
      </ul>
    </section>
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
