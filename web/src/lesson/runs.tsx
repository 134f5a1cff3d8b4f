// Several runs of a robot that chance interferes with: one at a time, with what happened in all of them.
import type { JSX } from 'preact';
import { useState } from 'preact/hooks';
import type { Board } from '../shared/board/types';
import type { Runs } from './document';
import { Scene, type Context } from './scene';
import { upperFirst } from './words';

interface RunsProps extends Context {
  board: Board;
  shown: Runs;
}

export function RunsView({ board, shown, ...context }: RunsProps): JSX.Element {
  const [number, setNumber] = useState(0);
  const count = shown.runs.length;
  const run = shown.runs[number];
  return (
    <div class="runs">
      <p>
        The same choice can turn out differently each time. Here are {count} runs of the robot, just as they happened.
      </p>
      <div class="player buttons" role="group" aria-label="Runs of the robot">
        <button type="button" disabled={number === 0} onClick={() => setNumber(number - 1)}>
          Previous run
        </button>
        <button type="button" disabled={number + 1 === count} onClick={() => setNumber(number + 1)}>
          Next run
        </button>
        <span class="step" aria-live="polite">
          Run {number + 1} of {count}
        </span>
      </div>
      {run && (
        <Scene
          key={number}
          {...context}
          board={{ ...board, frames: run.frames }}
          title={`Run ${number + 1}`}
          name="the robot's path"
          isCutOff={!run.ended}
        />
      )}
      <p class="frequencies">{upperFirst(shown.text)}.</p>
    </div>
  );
}
