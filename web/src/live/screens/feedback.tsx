// What the robot really does, beside what was predicted.
import type { JSX } from 'preact';
import { useLayoutEffect, useRef, useState } from 'preact/hooks';
import { BoardInWords, LiveBoardView, Things, useLegend, WorldName } from '../parts/live_board';
import { LogView, useLog } from '../parts/log';
import { Player, usePacedPlayback } from '../parts/player';
import { StateCard, StepList } from '../parts/steps';
import { Button, Heading, TimeLeft } from '../parts/ui';
import { closedAt, played } from '../../shared/board/repeats';
import type { Path } from '../../shared/board/types';
import type { Frame, Judged } from '../protocol';
import type { ScreenProps } from '../screen';
import { keep, recall } from '../storage';
import { sentence, t } from '../texts';
import { playedText } from '../words';
import { walked } from './watch';

type Shown = NonNullable<ScreenProps['view']['feedback']>;

// One task per screen.
export function Feedback({ feedback, view, connection }: ScreenProps & { feedback: Shown }): JSX.Element {
  const { part = 0, round = 0 } = view.progress ?? {};
  const key = `${part}.${round}`;
  const [index, setIndex] = useState(() => {
    const kept = recall<{ key: string; index: number }>('feedback');
    return kept?.key === key ? Math.min(kept.index, feedback.tests.length - 1) : 0;
  });
  const go = (to: number): void => {
    setIndex(to);
    keep('feedback', { key, index: to });
  };
  const test = feedback.tests[index];
  const isLast = index >= feedback.tests.length - 1;
  const off = connection.isPending('continue');
  const next = (isPrimary: boolean): JSX.Element => (
    <div class="submit">
      {isLast && feedback.all_right && feedback.tests.length > 1 && <p>{t('feedback.all_right')}</p>}
      <Button primary={isPrimary} off={off} onClick={() => (isLast ? connection.send('continue', {}) : go(index + 1))}>
        {t(off ? 'feedback.continuing' : isLast ? 'common.continue' : 'common.next')}
      </Button>
      {isLast && <p class="muted">{t(`feedback.${feedback.learned ? 'learned' : feedback.others_unsure ? 'again_others' : 'again'}`)}</p>}
    </div>
  );
  if (!test) {
    return (
      <>
        <Heading>{t('feedback.title.none')}</Heading>
        {next(true)}
      </>
    );
  }
  return (
    <>
      <p class="kicker">{t('feedback.count', { index: index + 1, of: feedback.tests.length })}</p>
      <TimeLeft until={view.limit_ms} />
      <OneTask key={index} test={test} next={next} />
    </>
  );
}

function OneTask({ test, next }: { test: Judged; next: (isPrimary: boolean) => JSX.Element }): JSX.Element {
  const { board, right } = test;
  const robotPath = pathOf(test.robot, test.robot_repeats_from, test.robot_repeats_text);
  const robot = played(robotPath);
  const mine = test.mine && pathOf(test.mine, test.mine_repeats_from);
  const legend = useLegend(board.domain);
  const other = right || !mine ? null : played(mine);
  const last = Math.max(robot.length, other?.length ?? 0, 1) - 1;
  const playback = usePacedPlayback(last);
  const { step } = playback;
  const [wasSeen, setSeen] = useState(false);
  useLayoutEffect(() => {
    if (step === last) setSeen(true);
  }, [step, last]);
  const log = useLog(t('watch.start'));
  const shown = useRef(0);
  useLayoutEffect(() => {
    if (step === shown.current) return;
    shown.current = step;
    if (step < robot.length) log.say(playedText(board, legend, robotPath, step));
  }, [step]);
  const at = other ? test.differs_at : null;
  const decisive = at === null ? null : { frame: at, ...cellOf(robot[at]) };
  const verdict = right ? 'right' : test.mine ? 'wrong' : 'none';
  const robotStep = Math.min(step, robot.length - 1);
  return (
    <>
      <div class={`verdict ${verdict}`}>
        <Mark verdict={verdict} />
        <Heading>{t(`feedback.title.${verdict}`)}</Heading>
      </div>
      <p class="lead">{t(leadKey(test))}</p>
      <WorldName board={board} />
      <div class="board-screen">
        <div class="board-column">
          {board.map ? (
            <LiveBoardView
              board={board}
              legend={legend}
              frames={robot}
              step={robotStep}
              walked={step}
              trail="own"
              decisive={decisive}
              closedAt={closedAt(robotPath)}
              {...(other && mine ? { other, otherClosedAt: closedAt(mine) } : {})}
            />
          ) : (
            <StateCard frame={robot[robotStep] ?? board.start} />
          )}
          <LogView log={log} />
        </div>
        <div class="side">
          <Player playback={playback} primary={!right && !wasSeen} />
          {(right || wasSeen) && <Reasons test={test} at={at} />}
          {next(right || wasSeen)}
          {board.map ? (
            <>
              <Things board={board} legend={legend} lines={other ? ['own', 'other'] : ['own']} walked={robot.slice(0, robotStep + 1)} />
              <BoardInWords board={board} legend={legend} frame={robot[robotStep] ?? board.start} />
            </>
          ) : (
            <div class="step-lists">
              <StepList title={t('feedback.robot')} frames={walked(robot, robotStep)} differs={at} />
              {other && <StepList title={t('feedback.mine')} frames={other} differs={at} />}
            </div>
          )}
        </div>
      </div>
    </>
  );
}

const pathOf = (frames: Frame[], from?: number, text?: string): Path => ({
  frames,
  ...(from === undefined ? {} : { repeats_from: from }),
  ...(text === undefined ? {} : { repeats_text: text }),
});

function leadKey({ right, mine, board, differs_at }: Judged): string {
  if (right) return differs_at === null ? 'feedback.right' : 'feedback.right_other';
  if (!mine) return 'feedback.none';
  return board.map ? 'feedback.wrong' : 'feedback.wrong_plain';
}

const cellOf = (frame: Frame | undefined): { cell?: [number, number] } => (frame?.robot ? { cell: frame.robot } : {});

// Shown when the robot has run: the reason first would spoil it.
function Reasons({ test, at }: { test: Judged; at: number | null }): JSX.Element | null {
  const differs = at === null ? null : t(test.board.map ? 'feedback.differs' : 'feedback.differs_plain', { step: at + 1 });
  const cost = test.cost ? sentence(test.cost) : test.unfinished && t('feedback.unfinished');
  if (test.why.length === 0 && !cost && !differs) return null;
  return (
    <div class="reasons">
      {differs && <p>{differs}</p>}
      {cost && <p class="cost">{cost}</p>}
      {test.why.length > 0 && (
        <>
          <h2>{t('feedback.why')}</h2>
          <ul>
            {test.why.map((text) => (
              <li>{sentence(text)}</li>
            ))}
          </ul>
        </>
      )}
    </div>
  );
}

// A tick, a cross or a circle: shape as well as colour.
function Mark({ verdict }: { verdict: string }): JSX.Element {
  const paths: Record<string, string> = { right: 'M6 12.5l4 4 8-9', wrong: 'M7 7l10 10M17 7L7 17', none: 'M7 12h10' };
  return (
    <svg class="mark-icon" viewBox="0 0 24 24" aria-hidden="true" focusable="false">
      <circle cx={12} cy={12} r={11} />
      <path d={paths[verdict] ?? ''} />
    </svg>
  );
}
