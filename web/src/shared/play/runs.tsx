// Some runs of a robot that chance interferes with, with all of their ends and what happened.
import type { ComponentChildren, JSX } from 'preact';
import { useLayoutEffect, useRef, useState } from 'preact/hooks';
import type { Intent } from '../board/board';
import { kMoves } from '../board/geometry';
import type { Legend } from '../board/legend';
import type { Frame, PlayBoard } from '../board/types';
import { capitalised, isEnglish, t } from '../texts';
import { BoardInWords, BoardPane, Things } from './board_pane';
import { Button } from './button';
import { countsOf, Ledger } from './ledger';
import { LogView, useLog } from './log';
import { Player, usePacedPlayback } from './player';
import { StateCard, StepList } from './steps';
import { playedText } from './words';

export interface Run {
  frames: Frame[];
  ended: boolean;
}

// With outcomes as they fell, and what happened in how many of them, in English.
export interface Runs {
  text: string;
  runs: Run[];
}

const kSmallMap = 12; // columns of a map that can be drawn as a thumbnail
const kTail = 6; // steps behind the robot that are drawn

// Where the robot means to go from the cells that it came to in any run, while things are as in a frame.
export function intentsOf(runs: Run[], { items, stations }: Frame): Intent[] {
  const things = (frame: Frame): string => JSON.stringify([(frame.items ?? []).map(({ cell, carried }) => (carried ? null : cell)), frame.stations ?? []]);
  const now = things({ ...(items ? { items } : {}), ...(stations ? { stations } : {}) });
  const found = new Map<string, Intent>();
  for (const frame of runs.flatMap(({ frames }) => frames)) {
    const { robot, action } = frame;
    if (robot && action && kMoves[action] && things(frame) === now) found.set(`${robot} ${action}`, { cell: robot, action });
  }
  return [...found.values()];
}

interface Props {
  board: PlayBoard;
  legend: Legend;
  shown: Runs;
  isStill?: boolean; // for paper: nothing to press
  isOpen: boolean; // ends, and where the robot means to go, may be seen
  primary?: boolean; // whether to play is what is to be done next
  reason?: ComponentChildren; // beside the board
  below?: ComponentChildren; // below the board
  children?: ComponentChildren; // below the player
  onSeen?: () => void; // a run has been played to its end
}

export function RunsView({ shown, ...props }: Props): JSX.Element {
  const [number, setNumber] = useState(0);
  const { runs } = shown;
  const run = runs[number];
  const title = t('watch.run', { index: number + 1, of: runs.length });
  const choice = (
    <div class="runs" role="group" aria-label={t('watch.ends')}>
      <div class="ends">
        {runs.map((one, i) => (
          <Button pressed={i === number} off={!props.isOpen && i !== number} onClick={() => setNumber(i)}>
            {props.isOpen && <End {...props} run={one} />}
            <span>
              {t('watch.try', { index: i + 1 })}
              {props.isOpen && `: ${one.ended ? t('predict.steps', { n: one.frames.length - 1 }) : t('watch.goes_on')}`}
            </span>
          </Button>
        ))}
      </div>
      {props.isOpen && isEnglish() && <p class="frequencies">{capitalised(t('watch.all_runs', { what: shown.text }))}</p>}
    </div>
  );
  return (
    <>
      <p>{t('watch.runs', { n: runs.length })}</p>
      {run ? <OneRun key={number} {...props} runs={runs} run={run} title={title} choice={choice} /> : choice}
    </>
  );
}

// How a run ends, in small.
function End({ board, legend, run }: Pick<Props, 'board' | 'legend'> & { run: Run }): JSX.Element | null {
  if (!board.map || (board.domain.width ?? 0) > kSmallMap) return null;
  return <BoardPane board={board} legend={legend} frames={run.frames} step={run.frames.length - 1} trail="own" tail={kTail} isSmall isBare />;
}

interface OneRunProps extends Omit<Props, 'shown'> {
  runs: Run[];
  run: Run;
  title: string;
  choice: JSX.Element;
}

function OneRun({ board, legend, runs, run, title, choice, isStill, isOpen, primary, reason, below, children, onSeen }: OneRunProps): JSX.Element {
  const { frames } = run;
  const last = frames.length - 1;
  const playback = usePacedPlayback(last);
  const step = isStill ? last : playback.step;
  const log = useLog(t('watch.start'));
  const said = useRef(0);
  useLayoutEffect(() => {
    if (playback.step === said.current) return;
    said.current = playback.step;
    const goesOn = playback.step === last && !run.ended ? ` ${t('watch.run_goes_on')}` : '';
    log.say(playedText(board, legend, { frames }, playback.step) + goesOn);
  }, [playback.step]);
  useLayoutEffect(() => {
    if (playback.step === last) onSeen?.();
  }, [playback.step, last]);
  const frame = frames[step] ?? board.start;
  const intents = isOpen ? intentsOf(runs, frame) : [];
  return (
    <div class="board-screen">
      <div class="board-column">
        <p class="list-title" role="status">
          {title}
        </p>
        {board.map ? (
          <BoardPane board={board} legend={legend} frames={frames} step={step} trail="own" tail={kTail} intents={intents} />
        ) : (
          <StateCard frame={frame} />
        )}
        {!isStill && <LogView log={log} />}
        {board.map && (
          <Things board={board} legend={legend} lines={['own']} walked={frames.slice(Math.max(0, step - kTail), step + 1)} hasIntents={intents.length > 0} />
        )}
        {below}
      </div>
      <div class="side">
        {reason}
        <Ledger board={board} columns={[{ name: t('ledger.robot'), kind: 'own', counts: countsOf(frames, step) }]} />
        {!isStill && <Player playback={playback} primary={primary ?? false} />}
        {choice}
        {children}
        {board.map ? (
          !isStill && <BoardInWords board={board} legend={legend} frame={frame} />
        ) : (
          <StepList title={t('feedback.robot')} frames={walked(frames, step)} />
        )}
      </div>
    </div>
  );
}

// The steps that have been made: what comes next is not told.
export const walked = (frames: Frame[], step: number): Frame[] =>
  frames.slice(0, step + 1).map((frame, i) => (i < step ? frame : { ...frame, action: null }));
