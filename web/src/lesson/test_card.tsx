import type { JSX } from 'preact';
import { useState } from 'preact/hooks';
import { Sentences } from './demonstration';
import type { Test } from './document';
import { Scene, Start, type Context } from './scene';

export function TestView({ test, number, ...context }: Context & { test: Test; number: number }): JSX.Element {
  const [open, setOpen] = useState(false);
  return (
    <article class="test">
      <h4>
        Test {number} <span class={`badge ${test.difficulty}`}>{test.difficulty}</span>
      </h4>
      <p class="question">World {test.world}: which way does the robot take?</p>
      {!open && <Start {...context} board={test} />}
      <details open={open} onToggle={(event) => setOpen(event.currentTarget.open)}>
        <summary>Show the answer</summary>
        {open && (
          <div class="answer">
            <Scene {...context} board={test} title="The robot's answer" name="the robot's path" />
            <p>A right answer shows that somebody knows:</p>
            <Sentences sentences={test.covers} />
          </div>
        )}
      </details>
      <p class="share">
        {Math.round(100 * test.share_right)} % of all who have not been taught this would be right by what they already
        believe.
      </p>
    </article>
  );
}
