import type { JSX } from 'preact';
import { useState } from 'preact/hooks';
import type { Demonstration, Sentence } from './document';
import { Scene, type Context } from './scene';
import { upperFirst, withoutCells } from './words';

export function Sentences({ sentences }: { sentences: Sentence[] }): JSX.Element {
  return (
    <ul class="sentences">
      {sentences.map(({ text }) => (
        <li>{upperFirst(text)}.</li>
      ))}
    </ul>
  );
}

// First the robot moves; why it does so, and what it would do elsewhere, is there when the reader asks.
export function DemonstrationView({ shown, number, ...context }: Context & { shown: Demonstration; number: number }) {
  const [open, setOpen] = useState(false);
  const { alternative, decisive, flip } = shown;
  // The board of the other world marks the same place: there the robot decides differently.
  const there = flip && decisive ? { frame: decisive.frame, ...cellThere(flip.frames[decisive.frame]?.robot) } : null;
  return (
    <article class="demonstration">
      <h3>Example {number}</h3>
      <p class="question">Where will the robot go? Decide first, then watch.</p>
      <Scene
        {...context}
        board={shown}
        title="The robot"
        name="the robot's path"
        {...(open && alternative ? { other: alternative.frames } : {})}
        decisive={open ? decisive : null}
      >
        {open && alternative && decisive
          ? `${shown.map ? 'The dashed path' : 'The other list'} is one that you might have expected. They differ from step ${decisive.frame + 1}.`
          : null}
      </Scene>
      <details class="why" open={open} onToggle={(event) => setOpen(event.currentTarget.open)}>
        <summary>{open ? 'Hide the reason' : 'Why does it do this?'}</summary>
        {open && (
          <>
            <p class="reason">{upperFirst(shown.reason)}.</p>
            {shown.conveys.length > 1 && (
              <div class="conveys">
                <p>From this you can conclude:</p>
                <Sentences sentences={shown.conveys} />
              </div>
            )}
            {flip && (
              <Scene {...context} board={flip} title="On another map" name="the robot's path there" decisive={there}>
                {`${upperFirst(withoutCells(flip.text))}.`}
              </Scene>
            )}
          </>
        )}
      </details>
    </article>
  );
}

const cellThere = (cell: [number, number] | undefined): { cell?: [number, number] } => (cell ? { cell } : {});
