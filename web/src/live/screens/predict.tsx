// Where somebody shows what the robot will do.
import type { JSX } from 'preact';
import { useLayoutEffect, useState } from 'preact/hooks';
import { useDrive, type Drive } from '../../shared/play/drive';
import { BoardAlone, Driver } from '../../shared/play/driver';
import { Job, useLegend, WorldName } from '../../shared/play/board_pane';
import { Button, Heading, TimeLeft } from '../parts/ui';
import type { Task } from '../protocol';
import type { ScreenProps } from '../screen';
import { driveStore } from '../storage';
import { t } from '../../shared/texts';
import type { World } from '../../shared/play/world';
import { useWorld } from '../world';

interface Props extends ScreenProps {
  task: Task;
  kind: keyof typeof kCommands;
}

// What is sent, by why somebody is asked: before, during or after the lessons.
const kCommands = { screening: 'screen', predict: 'answer', exam: 'examine' } as const;
const kTitles = { screening: 'screening.title', predict: 'predict.title', exam: 'exam.title' } as const;

export function Predict(props: Props): JSX.Element {
  const { task, token, kind, view } = props;
  const { world, hasTrouble } = useWorld(task.world, token);
  const legend = useLegend(task.board.domain);
  const asked = task.board.map ? 'predict.question' : 'predict.question_plain';
  const question = { screening: 'screening.question', predict: asked, exam: 'exam.question' } as const;
  return (
    <>
      <p class="kicker">{t(kind === 'exam' ? 'exam.count' : 'predict.count', { index: task.index + 1, of: task.of })}</p>
      <Heading>{t(kTitles[kind])}</Heading>
      <p class="lead">{t(question[kind])}</p>
      <Job board={task.board} />
      <WorldName board={task.board} />
      {world?.hasChance && <p>{t('predict.chance')}</p>}
      <TimeLeft until={view.limit_ms} />
      {world ? (
        <Answering {...props} world={world} legend={legend} />
      ) : (
        <BoardAlone board={task.board} legend={legend}>
          <p role="status">{t(hasTrouble ? 'common.loading_trouble' : 'common.loading')}</p>
        </BoardAlone>
      )}
    </>
  );
}

function Answering({ task, kind, view, connection, world, legend }: Props & { world: World; legend: ReturnType<typeof useLegend> }) {
  const { part = 0, round = 0 } = view.progress ?? {};
  const drive = useDrive({
    world,
    start: task.start,
    draft: task.draft,
    store: driveStore,
    key: [view.stage, part, round, task.index, task.world, task.start].join('.'),
    ...(kind !== 'predict' ? {} : { onDraft: (actions: number[]) => connection.sendDraft({ test: task.index, actions }) }),
  });
  const type = kCommands[kind];
  const [isSubmitted, setSubmitted] = useState(false);
  const { refused } = connection.snapshot();
  useLayoutEffect(() => {
    if (refused?.type === type) setSubmitted(false);
  }, [refused]);
  const off = isSubmitted || connection.isPending(type);
  const [endless, setEndless] = useState<number[] | null>(null); // the path that is said to go on for ever
  const isForEver = endless === drive.actions && drive.repeatsFrom !== null;
  const submit = (): void => {
    const answer = { test: task.index, actions: drive.actions, ...(isForEver ? { for_ever: true as const } : {}), ms: drive.ms() };
    setSubmitted(true);
    if (kind === 'predict') connection.send('answer', { ...answer, keys: drive.keys(), round });
    else connection.send(kCommands[kind], answer);
  };
  return (
    <Driver
      board={task.board}
      legend={legend}
      world={world}
      drive={drive}
      off={off}
      end={t('predict.end')}
      stopped={t('predict.stopped')}
      isForEver={isForEver}
    >
      {drive.repeatsFrom !== null && (
        <div class="for-ever">
          <Button pressed={isForEver} off={off} onClick={() => setEndless(isForEver ? null : drive.actions)}>
            {t('predict.for_ever')}
          </Button>
          <p class="muted">{t(isForEver ? 'predict.is_for_ever' : 'predict.repeats')}</p>
        </div>
      )}
      <Submit drive={drive} isWhole={drive.isAtEnd || isForEver} off={off} onSubmit={submit} />
    </Driver>
  );
}

interface SubmitProps {
  drive: Drive;
  isWhole: boolean; // the path ends, or it is said to go on for ever
  off: boolean;
  onSubmit: () => void;
}

// A path that is not finished is submitted only if it is meant so. The button stays where it is, and with it the focus.
function Submit({ drive, isWhole, off, onSubmit }: SubmitProps): JSX.Element {
  const [asked, setAsked] = useState<number[] | null>(null); // the path that the question is about
  const isAsking = asked === drive.actions && !isWhole && !off;
  return (
    <div class="submit">
      <Button primary={!isAsking} off={off || isAsking} onClick={() => (isWhole ? onSubmit() : setAsked(drive.actions))}>
        {t(off ? 'predict.submitting' : 'predict.submit')}
      </Button>
      <p role="status" class={isAsking ? 'asks' : 'muted'}>
        {off
          ? t('predict.submitted')
          : isAsking
            ? t(drive.actions.length === 0 ? 'predict.empty' : 'predict.unfinished')
            : t('predict.steps', { n: drive.actions.length })}
      </p>
      {isAsking && (
        <div class="buttons">
          <Button primary onClick={() => setAsked(null)}>
            {t('predict.keep')}
          </Button>
          <Button onClick={onSubmit}>{t('predict.anyway')}</Button>
        </div>
      )}
    </div>
  );
}
