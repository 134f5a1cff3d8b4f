// Some runs of a robot that chance interferes with: of different lengths, with all of their ends and what happened.
import type { ComponentChildren, JSX } from 'preact';
import { useState } from 'preact/hooks';
import type { Board, Frame } from '../shared/board/types';
import { Button } from '../shared/play/button';
import { BoardInWords, BoardPane, Things } from '../shared/play/board_pane';
import { countsOf, Ledger } from '../shared/play/ledger';
import { LogView, useLog } from '../shared/play/log';
import { Player, usePacedPlayback } from '../shared/play/player';
import { StateCard, StepList } from '../shared/play/steps';
import { t } from '../shared/texts';
import { playedText } from '../shared/play/words';
import { useLayoutEffect, useRef } from 'preact/hooks';
import { playBoard, upperFirst, type Context } from './context';
import type { Runs } from './document';

const kShown = 5;
type Run = Runs['runs'][number];

// Of all runs some that stand for them, by their length: the middle one first.
export function typical(runs: Run[]): Run[] {
  const byLength = [...runs].sort((a, b) => a.frames.length - b.frames.length);
  if (byLength.length <= kShown) return byLength;
  const at = [0.5, 0.3, 0.7, 0.1, 0.9].map((share) => Math.floor(share * byLength.length));
  return [...new Set(at)].flatMap((i) => byLength[i] ?? []);
}

interface RunsProps extends Context {
  board: Board;
  shown: Runs;
  isStill: boolean;
  reason: ComponentChildren;
  fan?: ComponentChildren; // what can happen where it matters
  children?: ComponentChildren;
}

export function RunsView({ shown, ...props }: RunsProps): JSX.Element {
  const [number, setNumber] = useState(0);
  const runs = typical(shown.runs);
  const run = runs[number];
  return (
    <>
      <p>The same choice can turn out differently each time. Here are some runs of the robot, just as they happened.</p>
      {run && <OneRun key={number} {...props} run={run} title={`Run ${number + 1} of ${runs.length}`} />}
      <div class="ends" role="group" aria-label="Runs of the robot">
        {runs.map((one, i) => (
          <Button pressed={i === number} onClick={() => setNumber(i)}>
            <End {...props} run={one} />
            <span>
              Run {i + 1}: {one.ended ? `${one.frames.length - 1} steps` : 'it goes on'}
            </span>
          </Button>
        ))}
      </div>
      <p class="frequencies">{upperFirst(shown.text)}.</p>
    </>
  );
}

// How a run ends, in small.
function End({ board, run, domain, legend }: Omit<RunsProps, 'shown'> & { run: Run }): JSX.Element | null {
  const placed = playBoard(domain, board);
  if (!placed.map || (domain.width ?? 0) > 12) return null;
  return <BoardPane board={placed} legend={legend} frames={run.frames} step={run.frames.length - 1} trail="own" isSmall isBare />;
}

function OneRun({ board, run, title, isStill, reason, fan, children, domain, legend }: Omit<RunsProps, 'shown'> & { run: Run; title: string }) {
  const placed = playBoard(domain, board);
  const { frames } = run;
  const last = frames.length - 1;
  const playback = usePacedPlayback(last);
  const { step } = playback;
  const log = useLog(t('watch.start'));
  const said = useRef(0);
  useLayoutEffect(() => {
    if (step === said.current) return;
    said.current = step;
    log.say(playedText(placed, legend, { frames }, step) + (step === last && !run.ended ? ' It goes on.' : ''));
  }, [step]);
  const frame: Frame = frames[step] ?? board.start;
  return (
    <div class="board-screen runs">
      <div class="board-column">
        <p class="list-title">{title}</p>
        {placed.map ? (
          <BoardPane board={placed} legend={legend} frames={frames} step={isStill ? last : step} trail="own" tail={6} />
        ) : (
          <StateCard frame={frame} />
        )}
        {!isStill && <LogView log={log} />}
        {placed.map && <Things board={placed} legend={legend} lines={['own']} walked={frames.slice(0, step + 1)} />}
        {fan}
      </div>
      <div class="side">
        {reason}
        <Ledger domain={domain} columns={[{ name: t('ledger.robot'), kind: 'own', counts: countsOf(frames, isStill ? last : step) }]} />
        {!isStill && <Player playback={playback} primary={false} />}
        {children}
        {placed.map ? (
          !isStill && <BoardInWords board={placed} legend={legend} frame={frame} />
        ) : (
          <StepList title={t('feedback.robot')} frames={frames.slice(0, step + 1)} />
        )}
      </div>
    </div>
  );
}
