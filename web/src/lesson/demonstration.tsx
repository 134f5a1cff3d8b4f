import type { JSX } from 'preact';
import type { Demonstration, Sentence } from './document';
import { Scene, type Context } from './scene';
import { cellText, upperFirst } from './words';

export function Sentences({ sentences }: { sentences: Sentence[] }): JSX.Element {
  return (
    <ul class="sentences">
      {sentences.map(({ text }) => (
        <li>{upperFirst(text)}.</li>
      ))}
    </ul>
  );
}

export function DemonstrationView({ shown, number, ...context }: Context & { shown: Demonstration; number: number }) {
  const { alternative, decisive, flip } = shown;
  const where = decisive?.cell ? ` at ${cellText(decisive.cell)}` : '';
  // The board of the other world marks the same place: there the robot decides otherwise.
  const there = flip && decisive ? { frame: decisive.frame, ...cellThere(flip.frames[decisive.frame]?.robot) } : null;
  return (
    <article class="demonstration">
      <h3>Demonstration {number}</h3>
      <p class="reason">{upperFirst(shown.reason)}.</p>
      <div class={flip ? 'pair' : 'single'}>
        <Scene
          {...context}
          board={shown}
          title={`World ${shown.world}: what the robot does`}
          name="the robot's path"
          {...(alternative ? { other: alternative.frames } : {})}
          decisive={decisive}
        >
          {alternative && decisive
            ? `${shown.map ? 'The dashed way' : 'The other list'} is what somebody would expect who does not know this yet. They part${where} with step ${decisive.frame + 1}.`
            : null}
        </Scene>
        {flip && (
          <Scene
            {...context}
            board={flip}
            title={`World ${flip.world}: where it decides otherwise`}
            name="the robot's path there"
            decisive={there}
          >
            {`The nearest world with another decision: ${flip.text}.`}
          </Scene>
        )}
      </div>
      {shown.conveys.length > 1 && (
        <div class="conveys">
          <p>Who watches closely can conclude:</p>
          <Sentences sentences={shown.conveys} />
        </div>
      )}
    </article>
  );
}

const cellThere = (cell: [number, number] | undefined): { cell?: [number, number] } => (cell ? { cell } : {});
