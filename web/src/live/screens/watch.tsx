// One demonstration: the robot moves when asked to, and its path is drawn only as far as it has gone.
import type { JSX } from 'preact';
import { useLayoutEffect, useRef, useState } from 'preact/hooks';
import { BoardInWords, LiveBoardView, Things, useLegend, WorldName } from '../parts/live_board';
import { LogView, useLog } from '../parts/log';
import { Player, usePacedPlayback } from '../parts/player';
import { StateCard, StepList } from '../parts/steps';
import { Button, Heading, TimeLeft } from '../parts/ui';
import { closedAt, played } from '../../shared/board/repeats';
import type { Path } from '../../shared/board/types';
import type { Runs } from '../protocol';
import type { ScreenProps } from '../screen';
import { keep, recall } from '../storage';
import { isEnglish, t } from '../texts';
import { isJobDone, onAndOn, playedText } from '../words';

type Shown = NonNullable<ScreenProps['view']['watch']>;

export function Watch({ watch, view, connection }: ScreenProps & { watch: Shown }): JSX.Element {
  const { board, runs } = watch;
  const [run, setRun] = useState(0);
  const path = runs?.runs[run] ?? watch;
  const frames = played(path);
  const { part = 0, round = 0 } = view.progress ?? {};
  const key = `${part}.${round}.${watch.index}`;
  const legend = useLegend(board.domain);
  const playback = usePacedPlayback(Math.max(0, frames.length - 1));
  const { step, last } = playback;
  const [wasSeen, setSeen] = useState(() => recall<string>('seen') === key);
  const log = useLog(t('watch.start'));
  const shown = useRef(0);
  useLayoutEffect(() => {
    if (step === shown.current) return;
    shown.current = step;
    log.say(playedText(board, legend, path, step));
  }, [step]);
  useLayoutEffect(() => {
    if (step < last || wasSeen) return;
    setSeen(true);
    keep('seen', key);
  }, [step, last]);
  const off = connection.isPending('watched');
  return (
    <>
      <p class="kicker">{t('watch.count', { index: watch.index + 1, of: watch.of })}</p>
      <Heading>{t('watch.title')}</Heading>
      <p class="lead">{t(leadKey(watch, wasSeen))}</p>
      {view.study.goal && <p class="muted">{view.study.goal}</p>}
      <WorldName board={board} />
      {runs && <p>{t('watch.runs', { n: runs.runs.length })}</p>}
      <TimeLeft until={view.limit_ms} />
      <div class="board-screen">
        <div class="board-column">
          {board.map ? (
            <LiveBoardView board={board} legend={legend} frames={frames} step={step} trail="own" closedAt={closedAt(path)} />
          ) : (
            <StateCard frame={frames[step] ?? board.start} />
          )}
          <LogView log={log} />
        </div>
        <div class="side">
          <Player playback={playback} primary={!wasSeen} />
          {runs && (
            <RunChoice
              run={run}
              runs={runs}
              isSeen={wasSeen}
              onRun={(to) => {
                setRun(to);
                playback.show(0);
              }}
            />
          )}
          <div class="submit">
            <Button
              primary={wasSeen}
              off={!wasSeen || off}
              describedBy="watch-hint"
              onClick={() => connection.send('watched', { demo: watch.index })}
            >
              {t('common.next')}
            </Button>
            <p id="watch-hint" class="muted">
              {hint(wasSeen, path, isJobDone(board, legend, frames.at(-1)))}
            </p>
          </div>
          {board.map ? (
            <>
              <Things board={board} legend={legend} lines={['own']} walked={frames.slice(0, step + 1)} />
              <BoardInWords board={board} legend={legend} frame={frames[step] ?? board.start} />
            </>
          ) : (
            <StepList title={t('feedback.robot')} frames={walked(frames, step)} />
          )}
        </div>
      </div>
    </>
  );
}

function hint(wasSeen: boolean, path: Path, isDone: boolean): string {
  if (!wasSeen) return t('watch.finish');
  if (path.repeats_from !== undefined) return `${onAndOn(path)} ${t('watch.for_ever')}`;
  return t(isDone ? 'watch.done' : 'watch.over');
}

const leadKey = ({ board, runs }: Shown, wasSeen: boolean): string =>
  wasSeen && runs ? 'watch.think_runs' : `watch.${wasSeen ? 'think' : 'question'}${board.map ? '' : '_plain'}`;

interface RunChoiceProps {
  run: number;
  runs: Runs;
  isSeen: boolean; // what happened in all of them would tell too early
  onRun: (to: number) => void;
}

function RunChoice({ run, runs, isSeen, onRun }: RunChoiceProps): JSX.Element {
  const of = runs.runs.length;
  return (
    <div class="runs" role="group" aria-label={t('watch.run', { index: run + 1, of })}>
      <p role="status">{t('watch.run', { index: run + 1, of })}</p>
      <div class="buttons">
        <Button off={run === 0} onClick={() => onRun(run - 1)}>
          {t('watch.previous_run')}
        </Button>
        <Button off={!isSeen || run + 1 === of} onClick={() => onRun(run + 1)}>
          {t('watch.next_run')}
        </Button>
      </div>
      {isSeen && isEnglish() && <p class="muted">{t('watch.all_runs', { what: runs.text })}</p>}
    </div>
  );
}

// The steps that have been made: what comes next is not told.
export const walked = (frames: Shown['frames'], step: number): Shown['frames'] =>
  frames.slice(0, step + 1).map((frame, i) => (i < step ? frame : { ...frame, action: null }));
