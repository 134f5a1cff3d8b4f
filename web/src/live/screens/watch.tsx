// One demonstration: the robot moves when asked to, and its path is drawn only as far as it has gone.
import type { JSX } from 'preact';
import { useLayoutEffect, useState } from 'preact/hooks';
import { BoardInWords, BoardPane, Job, Things, useLegend, WorldName } from '../../shared/play/board_pane';
import { countsOf, Ledger } from '../../shared/play/ledger';
import { LogView, usePathLog } from '../../shared/play/log';
import { Player, usePacedPlayback } from '../../shared/play/player';
import { StateCard, StepList } from '../../shared/play/steps';
import { Button, Heading, TimeLeft } from '../parts/ui';
import { closedAt, played } from '../../shared/board/repeats';
import type { Frame, Path } from '../../shared/board/types';
import { useCalm } from '../../shared/playback';
import { useDrive } from '../../shared/play/drive';
import { Driver } from '../../shared/play/driver';
import type { World } from '../../shared/play/world';
import { useWorld } from '../world';
import { RunsView, walked, type Runs } from '../../shared/play/runs';
import type { ScreenProps } from '../screen';
import { driveStore, keep, recall } from '../storage';
import { t, type TextKey } from '../../shared/texts';
import { isJobDone, onAndOn } from '../../shared/play/words';

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
  if (watch.world === undefined || sketch) return <Watching {...props} sketch={sketch ?? []} name={key} />;
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

type WatchingProps = ScreenProps & { watch: Shown };

// `sketch` is empty where there is none.
function Watching({ sketch, name, ...props }: WatchingProps & { sketch: Frame[]; name: string }): JSX.Element {
  const { watch, view } = props;
  const { board, runs } = watch;
  const [wasSeen, setSeen] = useState(() => recall<string>('seen') === name);
  const seen = (): void => {
    if (wasSeen) return;
    setSeen(true);
    keep('seen', name);
  };
  return (
    <>
      <p class="kicker">{t('watch.count', { index: watch.index + 1, of: watch.of })}</p>
      <Heading>{t('watch.title')}</Heading>
      <p class="lead">{t(sketch.length > 1 && !runs && !wasSeen ? 'watch.compare' : leadKey(watch, wasSeen))}</p>
      <Job board={board} />
      <WorldName board={board} />
      <TimeLeft until={view.limit_ms} />
      {runs ? (
        <WatchingRuns {...props} runs={runs} wasSeen={wasSeen} onSeen={seen} />
      ) : (
        <WatchingPath {...props} sketch={sketch} wasSeen={wasSeen} onSeen={seen} />
      )}
    </>
  );
}

interface Seeing {
  wasSeen: boolean;
  onSeen: () => void;
}

// What happened in all of the runs would tell too early.
function WatchingRuns({ runs, wasSeen, onSeen, ...props }: WatchingProps & Seeing & { runs: Runs }): JSX.Element {
  const { board } = props.watch;
  const legend = useLegend(board.domain);
  return (
    <RunsView board={board} legend={legend} shown={runs} isOpen={wasSeen} primary={!wasSeen} onSeen={onSeen}>
      <GoOn {...props} wasSeen={wasSeen} hint={t(wasSeen ? 'watch.over' : 'watch.finish')} />
    </RunsView>
  );
}

function WatchingPath({ sketch, wasSeen, onSeen, ...props }: WatchingProps & Seeing & { sketch: Frame[] }): JSX.Element {
  const { watch } = props;
  const { board } = watch;
  const frames = played(watch);
  const legend = useLegend(board.domain);
  const hasSketch = sketch.length > 1;
  const isAuto = !useCalm() && hasSketch && !wasSeen;
  const playback = usePacedPlayback(Math.max(0, frames.length - 1), { from: 0, isAuto });
  const { step, last } = playback;
  const log = usePathLog(board, legend, watch, step);
  useLayoutEffect(() => {
    if (step === last) onSeen();
  }, [step, last]);
  return (
    <div class="board-screen">
      <div class="board-column">
        {board.map ? (
          <BoardPane
            board={board}
            legend={legend}
            frames={frames}
            step={step}
            trail="own"
            closedAt={closedAt(watch)}
            {...(hasSketch ? { other: sketch, decisive: { frame: 0 }, walked: Math.max(1, step) } : {})}
          />
        ) : (
          <StateCard frame={frames[step] ?? board.start} />
        )}
        <LogView log={log} />
        {board.map && <Things board={board} legend={legend} lines={hasSketch ? ['own', 'other'] : ['own']} walked={frames.slice(0, step + 1)} />}
      </div>
      <div class="side">
        <Ledger board={board} columns={[{ name: t('ledger.robot'), kind: 'own', counts: countsOf(frames, step) }]} />
        <Player playback={playback} primary={!wasSeen} />
        <GoOn {...props} wasSeen={wasSeen} hint={hint(wasSeen, watch, isJobDone(board, legend, frames.at(-1)))} />
        {board.map ? (
          <BoardInWords board={board} legend={legend} frame={frames[step] ?? board.start} />
        ) : (
          <StepList title={t('feedback.robot')} frames={walked(frames, step)} />
        )}
      </div>
    </div>
  );
}

function GoOn({ watch, view, connection, wasSeen, hint: text }: WatchingProps & { wasSeen: boolean; hint: string }): JSX.Element {
  return (
    <div class="submit act-bar">
      <Button
        primary={wasSeen}
        off={!wasSeen || connection.isPending('watched')}
        describedBy="watch-hint"
        onClick={() => connection.send('watched', { demo: watch.index, round: view.progress?.round ?? 0 })}
      >
        {t('common.next')}
      </Button>
      <p id="watch-hint" class="muted">
        {text}
      </p>
    </div>
  );
}

function hint(wasSeen: boolean, path: Path, isDone: boolean): string {
  if (!wasSeen) return t('watch.finish');
  if (path.repeats_from !== undefined) return `${onAndOn(path)} ${t('watch.for_ever')}`;
  return t(isDone ? 'watch.done' : 'watch.over');
}

// Whoever was asked for a guess before is not asked again.
function leadKey({ board, runs, world }: Shown, wasSeen: boolean): TextKey {
  if (!wasSeen && world !== undefined) return 'watch.see';
  if (wasSeen && runs) return 'watch.think_runs';
  return `watch.${wasSeen ? 'think' : 'question'}${board.map ? '' : '_plain'}`;
}
