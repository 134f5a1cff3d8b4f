// Why somebody waits, since when, and what comes then.
import type { JSX } from 'preact';
import { Heading, NextStep, Since, TimeLeft } from '../parts/ui';
import type { ScreenProps } from '../screen';
import { t } from '../../shared/texts';

type Shown = NonNullable<ScreenProps['view']['wait']>;

export function Wait({ wait, view }: ScreenProps & { wait: Shown }): JSX.Element {
  return (
    <>
      <Heading>{t(`wait.title.${wait.for}`)}</Heading>
      <p class="lead" role="status">
        {t(wait.for === 'teacher' && view.group.size === 1 ? 'wait.why.teacher_alone' : `wait.why.${wait.for}`, { n: wait.missing })}
      </p>
      <Since ms={wait.since_ms} />
      <TimeLeft until={view.limit_ms} />
      <NextStep>
        <p>{t(`wait.next.${wait.for}`)}</p>
        <p>{t('wait.itself')}</p>
      </NextStep>
    </>
  );
}
