import type { ComponentChildren, JSX } from 'preact';
import { useState } from 'preact/hooks';
import type { Demonstration, Sentence } from './document';
import { RunsView } from './runs';
import { Scene, Start, WorldName, type Context } from './scene';
import { actionsText, upperFirst, withoutCells } from './words';

// Sentences that can be said, each once: of some constraints nothing short is true.
export const textsOf = (sentences: Sentence[]): string[] =>
  [...new Set(sentences.map(({ text }) => text))].filter((text) => text !== '');

export function Sentences({ sentences }: { sentences: Sentence[] }): JSX.Element {
  return (
    <ul class="sentences">
      {textsOf(sentences).map((text) => (
        <li>{upperFirst(text)}.</li>
      ))}
    </ul>
  );
}

// First the robot moves; why it does so, and what it would do elsewhere, is there when the reader asks.
export function DemonstrationView({ shown, number, ...context }: Context & { shown: Demonstration; number: number }) {
  const [open, setOpen] = useState(false);
  const [watching, setWatching] = useState(false);
  const { alternative, decisive, flip } = shown;
  // Where chance has a part, the most likely paths can be the same although the decisions differ.
  const isSame = Boolean(shown.runs && alternative && actionsText(shown) === actionsText(alternative));
  // A list, and what happened in how many runs, would tell before the reader has decided.
  const tells = !shown.map || Boolean(shown.runs);
  // The board of the other world marks the same place: there the robot decides differently.
  const there = flip && decisive ? { frame: decisive.frame, ...cellThere(flip.frames[decisive.frame]?.robot) } : null;
  return (
    <article class="demonstration">
      <h3>Example {number}</h3>
      <p class="question">{shown.runs ? 'What will the robot do?' : 'Where will the robot go?'} Decide first, then watch.</p>
      <WorldName board={shown} />
      {(!shown.map || (tells && !watching)) && <Start {...context} board={shown} />}
      <Watched isHidden={tells} watching={watching} setWatching={setWatching}>
        {shown.runs && <RunsView {...context} board={shown} shown={shown.runs} />}
        {(!shown.runs || open) && (
          <Scene
            {...context}
            board={shown}
            title={shown.runs ? 'The most likely path' : 'The robot'}
            name={shown.runs ? "the robot's most likely path" : "the robot's path"}
            {...(open && alternative && !isSame ? { other: alternative } : {})}
            decisive={open && !isSame ? decisive : null}
          >
            {open && alternative && decisive && !isSame
              ? `${shown.map ? 'The dashed path' : 'The other list'} is one that you might have expected. They differ from step ${decisive.frame + 1}.`
              : null}
            {open && isSame
              ? 'On this path the robot does what you might have expected. The difference shows when things turn out otherwise.'
              : null}
          </Scene>
        )}
      </Watched>
      <details
        class="why"
        open={open}
        onToggle={(event) => {
          setOpen(event.currentTarget.open);
          if (event.currentTarget.open) setWatching(true); // the reason is about what the robot does
        }}
      >
        <summary>{open ? 'Hide the reason' : 'Why does it do this?'}</summary>
        {open && (
          <>
            <p class="reason">{upperFirst(shown.reason)}.</p>
            {textsOf(shown.conveys).length > 1 && (
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

// A board shows the robot only as far as it has gone; whatever tells more waits until the reader has decided.
function Watched(props: { isHidden: boolean; watching: boolean; setWatching: (open: boolean) => void; children: ComponentChildren }) {
  const { isHidden, watching, setWatching, children } = props;
  if (!isHidden) return <>{children}</>;
  return (
    <details class="watch" open={watching} onToggle={(event) => setWatching(event.currentTarget.open)}>
      <summary>{watching ? 'Hide what the robot does' : 'Show what the robot does'}</summary>
      {watching && children}
    </details>
  );
}

const cellThere = (cell: [number, number] | undefined): { cell?: [number, number] } => (cell ? { cell } : {});
