// One demonstration: the robot moves when asked to, and its path is drawn only as far as it has gone.
import type { JSX } from 'preact';
import { useLayoutEffect, useRef, useState } from 'preact/hooks';
import { BoardInWords, BoardPane, Job, Things, useLegend, WorldName } from '../../shared/play/board_pane';
import { countsOf, Ledger } from '../../shared/play/ledger';
import { LogView, useLog } from '../../shared/play/log';
import { Player, usePacedPlayback } from '../../shared/play/player';
import { StateCard, StepList } from '../../shared/play/steps';
import { Button, Heading, TimeLeft } from '../parts/ui';
import { closedAt, played } from '../../shared/board/repeats';
import type { Frame, Path } from '../../shared/board/types';
import { useDrive } from '../../shared/play/drive';
import { Driver } from '../../shared/play/driver';
import type { World } from '../../shared/play/world';
import { useWorld } from '../world';
import type { Runs } from '../protocol';
import type { ScreenProps } from '../screen';
import { driveStore, keep, recall } from '../storage';
import { isEnglish, t } from '../../shared/texts';
import { isJobDone, onAndOn, playedText } from '../../shared/play/words';

type Shown = NonNullable<ScreenProps['view']['watch']>;

// Where the study asks for it, people sketch the path before they see it.
export function Watch(props: ScreenProps & { watch: Shown }): JSX.Element {
  const { watch, view, token } = props;
  const { part = 0, round = 0 } = view.progress ?? {};
  const key = `${part}.${round}.${watch.index}`;
  const [sketch, setSketch] = useState(() => {
    const kept = recall<{ key: string; frames: Frame[] }>('sketch');
    return kept?.key === key ? kept.frames : null;
  });
  const { world } = useWorld(watch.world, token);
  if (watch.world === undefined || sketch) return <Watching {...props} sketch={sketch ?? []} />;
  const done = (frames: Frame[]): void => {
    keep('sketch', { key, frames });
    setSketch(frames);
  };
  return (
    <>
      <p class="kicker">{t('watch.count', { index: watch.index + 1, of: watch.of })}</p>
      <Heading>{t('watch.title')}</Heading>
      <p class="lead">{t(watch.board.map ? 'watch.sketch' : 'watch.sketch_plain')}</p>
      {world?.hasChance && <p>{t('predict.chance')}</p>}
      <Job board={watch.board} />
      <WorldName board={watch.board} />
      <TimeLeft until={view.limit_ms} />
      {world ? <Sketching world={world} watch={watch} name={key} onDone={done} /> : <p role="status">{t('common.loading')}</p>}
    </>
  );
}

interface SketchingProps {
  world: World;
  watch: Shown;
  name: string;
  onDone: (frames: Frame[]) => void;
}

function Sketching({ world, watch, name, onDone }: SketchingProps): JSX.Element {
  const legend = useLegend(watch.board.domain);
  const drive = useDrive({ world, start: watch.state ?? 0, draft: [], key: `sketch.${name}`, store: driveStore });
  return (
    <Driver
      board={watch.board}
      legend={legend}
      world={world}
      drive={drive}
      off={false}
      waiting={null}
      end={t('check.end')}
      stopped={t('check.stopped')}
    >
      <div class="submit">
        <div class="buttons">
          <Button primary off={drive.actions.length === 0} onClick={() => onDone(drive.frames)}>
            {t('watch.sketched')}
          </Button>
          <Button onClick={() => onDone([])}>{t('watch.skip')}</Button>
        </div>
        <p class="muted">{t('predict.steps', { n: drive.actions.length })}</p>
      </div>
    </Driver>
  );
}

// `sketch` is empty where there is none.
function Watching({ watch, view, connection, sketch }: ScreenProps & { watch: Shown; sketch: Frame[] }): JSX.Element {
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
  const hasSketch = sketch.length > 1 && !runs;
  return (
    <>
      <p class="kicker">{t('watch.count', { index: watch.index + 1, of: watch.of })}</p>
      <Heading>{t('watch.title')}</Heading>
      <p class="lead">{t(leadKey(watch, wasSeen))}</p>
      {hasSketch && <p>{t('watch.compare')}</p>}
      <Job board={board} />
      <WorldName board={board} />
      {runs && <p>{t('watch.runs', { n: runs.runs.length })}</p>}
      <TimeLeft until={view.limit_ms} />
      <div class="board-screen">
        <div class="board-column">
          {board.map ? (
            <BoardPane
              board={board}
              legend={legend}
              frames={frames}
              step={step}
              trail="own"
              closedAt={closedAt(path)}
              {...(hasSketch ? { other: sketch, decisive: { frame: 0 }, walked: Math.max(1, step) } : {})}
            />
          ) : (
            <StateCard frame={frames[step] ?? board.start} />
          )}
          <LogView log={log} />
          {board.map && <Things board={board} legend={legend} lines={hasSketch ? ['own', 'other'] : ['own']} walked={frames.slice(0, step + 1)} />}
        </div>
        <div class="side">
          <Ledger domain={board.domain} columns={[{ name: t('ledger.robot'), kind: 'own', counts: countsOf(frames, step) }]} />
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
            <BoardInWords board={board} legend={legend} frame={frames[step] ?? board.start} />
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
