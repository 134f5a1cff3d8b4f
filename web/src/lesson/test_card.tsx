import type { JSX } from 'preact';
import { useState } from 'preact/hooks';
import { Sentences, textsOf } from './demonstration';
import type { Test } from './document';
import { RunsView } from './runs';
import { Scene, Start, WorldName, type Context } from './scene';

export function TestView({ test, number, ...context }: Context & { test: Test; number: number }): JSX.Element {
  const [open, setOpen] = useState(false);
  return (
    <article class="test">
      <h4>
        Test {number} <span class={`badge ${test.difficulty}`}>{test.difficulty}</span>
      </h4>
      <p class="question">
        {test.runs ? 'What will the robot do, here and wherever it may end up?' : 'Which path will the robot take?'}
      </p>
      <WorldName board={test} />
      {!open && <Start {...context} board={test} />}
      <details open={open} onToggle={(event) => setOpen(event.currentTarget.open)}>
        <summary>{open ? 'Hide the answer' : 'Show the answer'}</summary>
        {open && (
          <div class="answer">
            {test.runs ? (
              <RunsView {...context} board={test} shown={test.runs} />
            ) : (
              <Scene {...context} board={test} title="The robot's answer" name="the robot's path" />
            )}
            {textsOf(test.covers).length > 0 && (
              <>
                <p>A correct answer shows that you know:</p>
                <Sentences sentences={test.covers} />
              </>
            )}
            <p class="share">Before this lesson, about {Math.round(100 * test.share_right)} % would answer correctly.</p>
          </div>
        )}
      </details>
    </article>
  );
}
