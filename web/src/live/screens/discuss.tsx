// What the group predicted for one task, side by side and without names: keep the own prediction or take another one.
import type { JSX } from 'preact';
import { useLayoutEffect, useRef, useState } from 'preact/hooks';
import { closedAt, played } from '../../shared/board/repeats';
import { BoardPane, Job, useLegend, WorldName } from '../../shared/play/board_pane';
import { walked } from '../../shared/play/runs';
import { StepList } from '../../shared/play/steps';
import { t } from '../../shared/texts';
import { Button, Heading, TimeLeft } from '../parts/ui';
import type { ScreenProps } from '../screen';

type Shown = NonNullable<ScreenProps['view']['discuss']>;
type Prediction = Shown['predictions'][number];

export function Discuss({ discuss, view, connection }: ScreenProps & { discuss: Shown }): JSX.Element {
  const { board, predictions } = discuss;
  const legend = useLegend(board.domain);
  const [isSent, setSent] = useState(false);
  const begun = useRef(performance.now());
  const { refused } = connection.snapshot();
  useLayoutEffect(() => {
    if (refused?.type === 'discuss') setSent(false);
  }, [refused]);
  const off = isSent || connection.isPending('discuss');
  const decide = (choice: number | null): void => {
    setSent(true);
    connection.send('discuss', { test: discuss.index, choice, ms: Math.round(performance.now() - begun.current), round: view.progress?.round ?? 0 });
  };
  const hasOwn = predictions.some(({ own }) => own);
  return (
    <>
      <p class="kicker">{t('predict.count', { index: discuss.index + 1, of: discuss.of })}</p>
      <Heading>{t('discuss.title')}</Heading>
      <p class="lead">{t(hasOwn ? 'discuss.question' : 'discuss.question_none')}</p>
      <Job board={board} />
      <WorldName board={board} />
      <TimeLeft until={view.limit_ms} />
      <ul class="predictions">
        {predictions.map((one, i) => (
          <li class={one.own ? 'own' : ''}>
            <h2>
              {t('discuss.prediction', { letter: letterOf(i) })}
              {one.own && <span class="tag">{t('discuss.own')}</span>}
            </h2>
            <p class="muted">{t('discuss.n', { n: one.n })}</p>
            {board.map ? (
              <BoardPane
                board={board}
                legend={legend}
                frames={played(one)}
                step={played(one).length - 1}
                trail="plain"
                closedAt={closedAt(one)}
                isSmall
              />
            ) : (
              <StepList title={t('discuss.prediction', { letter: letterOf(i) })} frames={stepsOf(one)} />
            )}
            <Button primary={one.own} off={off} onClick={() => decide(one.own ? null : i)}>
              {t(one.own ? 'discuss.keep' : 'discuss.change', { letter: letterOf(i) })}
            </Button>
          </li>
        ))}
      </ul>
      {!hasOwn && (
        <Button off={off} onClick={() => decide(null)}>
          {t('discuss.keep_none')}
        </Button>
      )}
      <p role="status" class="muted">
        {off && t('predict.submitted')}
      </p>
    </>
  );
}

const letterOf = (i: number): string => String.fromCharCode(65 + (i % 26));

const stepsOf = (one: Prediction) => walked(played(one), played(one).length - 1);
