// The end: how often the reader was right, what the robot is like, with a board for every sentence, and what is new.
import type { JSX } from 'preact';
import { Button } from '../shared/play/button';
import { Brackets, type Bracket } from '../shared/play/brackets';
import { counted, sentence } from '../shared/texts';
import { Title, Whole } from './card';
import { isExample, type Card } from './cards';
import { partingOf, usePrinting, type Context, type Guess } from './context';
import type { Component, Demonstration } from './document';

interface EndProps extends Context {
  answers: { card: Card; guess: Guess | null }[];
  more: number; // boards that are offered
  onMore: () => void;
}

export function End({ answers, more, onMore, ...context }: EndProps): JSX.Element {
  const isPrinting = usePrinting();
  const predicted = answers.filter(({ guess }) => guess?.mine);
  const right = predicted.filter(({ guess }) => guess?.verdict?.isRight).length;
  return (
    <section id="end">
      <Title isQuiet={isPrinting}>What this robot is like</Title>
      {predicted.length > 0 && (
        <p role="status">
          You were right on {right} of {counted(predicted.length, 'board')}.
        </p>
      )}
      <Portrait {...context} answers={predicted} seen={answers.map(({ card }) => card)} />
      <div class="submit no-print">
        <div class="buttons">
          {more > 0 && (
            <Button primary onClick={onMore}>
              {counted(more, 'more board')}
            </Button>
          )}
          <Button onClick={() => window.print()}>Print</Button>
        </div>
      </div>
    </section>
  );
}

// The example that shows what a sentence says; failing that, one of its part.
function shownBy({ demonstrations }: Component, all: Component[], text: string): Demonstration | undefined {
  const says = ({ conveys }: Demonstration): boolean => conveys.some((sentence) => sentence.text === text);
  return demonstrations.find(says) ?? all.flatMap((one) => one.demonstrations).find(says) ?? demonstrations[0];
}

function Portrait({ answers, seen, ...context }: Context & Pick<EndProps, 'answers'> & { seen: Card[] }): JSX.Element {
  const { components, endless, update } = context.lesson;
  const known = new Map<number, Bracket>();
  for (const { shown } of seen) {
    if (isExample(shown)) for (const bracket of shown.brackets) known.set(bracket.feature, bracket);
  }
  const said = new Set<string>();
  const lines = components.flatMap((component) =>
    component.sentences.flatMap(({ text }) => {
      if (text === '' || said.has(text)) return [];
      said.add(text);
      const board = shownBy(component, components, text);
      return [{ text, board }];
    }),
  );
  const shown = (some: typeof lines): JSX.Element => (
    <ul class="lines">
      {some.map(({ text, board }) => (
        <li>
          <p class="cost">{sentence(text)}</p>
          {board && <Whole {...context} board={board} other={board.runs ? null : board.alternative} otherKind="plain" at={board.decisive?.frame ?? null} />}
        </li>
      ))}
    </ul>
  );
  return (
    <div class="portrait">
      {endless && (
        <ul class="lines">
          <li>
            <p class="cost">From here {endless.repeats_text ?? 'it goes on for ever'}.</p>
            <Whole {...context} board={endless} />
          </li>
        </ul>
      )}
      {update && <h3>What is new</h3>}
      {shown(lines)}
      {update && update.still.length > 0 && <p>As before, {update.still.join('; ')}.</p>}
      <Brackets brackets={[...known.values()]} counted={context.domain.counted} title="What the boards tell" />
      <FirstAndLast {...context} answers={answers} />
    </div>
  );
}

// One's first and last prediction, side by side.
function FirstAndLast({ answers, ...context }: Context & Pick<EndProps, 'answers'>): JSX.Element | null {
  const [first, last] = [answers[0], answers.at(-1)];
  if (!first || !last?.guess?.verdict?.isRight || answers.length < 2) return null;
  const one = ({ card: { shown }, guess }: typeof first, title: string): JSX.Element => {
    const other = guess?.verdict?.isRight ? null : (guess?.mine ?? null);
    return (
      <figure>
        <Whole {...context} board={shown} other={other} at={other && partingOf(shown, other)} />
        <figcaption>
          {title}: {other ? 'the dashed line is yours, the solid one the robot\u2019s.' : 'correct.'}
        </figcaption>
      </figure>
    );
  };
  return (
    <>
      <h3>How far you have come</h3>
      <div class="pair">
        {one(first, 'Your first prediction')}
        {one(last, 'Your last prediction')}
      </div>
    </>
  );
}
