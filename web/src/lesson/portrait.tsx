// The end: how often the reader was right, what the robot is like, with a board for every sentence, and what is new.
import type { JSX } from 'preact';
import { useState } from 'preact/hooks';
import { Button } from '../shared/play/button';
import { Brackets, type Bracket } from '../shared/play/brackets';
import { counted, partingOf, upperFirst, usePrinting, type Context, type Prediction } from './context';
import { Folded, Whole } from './demonstration';
import type { Component, Demonstration } from './document';
import { TestView } from './test_card';

const kEasy = 2; // so many things are weighed in a sentence that people remember

interface EndProps extends Context {
  predictions: Map<string, Prediction>;
}

export function End({ predictions, ...context }: EndProps): JSX.Element {
  const [open, setOpen] = useState(false);
  const isPrinting = usePrinting();
  const { lesson } = context;
  const tests = lesson.components.flatMap(({ number, tests: all }) => all.map((_, i) => `test.${number}.${i}`));
  const answered = tests.flatMap((name) => predictions.get(name) ?? []);
  const right = answered.filter(({ isRight }) => isRight).length;
  return (
    <section id="end" aria-labelledby="end-title">
      <h2 id="end-title">What this robot is like</h2>
      <p role="status">
        {answered.length === 0
          ? 'Here is everything that this lesson shows about the robot. Predict it first.'
          : `You predicted the robot correctly in ${right} of ${tests.length} tests${answered.length < tests.length ? ' so far' : ''}.`}
      </p>
      {open || isPrinting ? (
        <Portrait {...context} predictions={predictions} />
      ) : (
        <Button primary={answered.length === tests.length} onClick={() => setOpen(true)}>
          Show the robot in one page
        </Button>
      )}
      {lesson.fresh.length > 0 && !isPrinting && (
        <>
          <h3>New boards</h3>
          <p>Now that you know the robot: boards that were not in this lesson.</p>
          {lesson.fresh.map((test, i) => (
            <TestView {...context} test={test} title={`New board ${i + 1}`} name={`fresh.${i}`} />
          ))}
        </>
      )}
    </section>
  );
}

// The example that shows what a sentence says; failing that, one of its part.
function shownBy({ demonstrations }: Component, all: Component[], text: string): Demonstration | undefined {
  const says = ({ conveys }: Demonstration): boolean => conveys.some((sentence) => sentence.text === text);
  return demonstrations.find(says) ?? all.flatMap((one) => one.demonstrations).find(says) ?? demonstrations[0];
}

function Portrait({ predictions, ...context }: EndProps): JSX.Element {
  const isPrinting = usePrinting();
  const { components, skipped, endless, update } = context.lesson;
  const known = new Map<number, Bracket>();
  for (const { brackets } of components.flatMap(({ demonstrations }) => demonstrations)) {
    for (const bracket of brackets) known.set(bracket.feature, bracket);
  }
  const said = new Set<string>();
  const lines = components.flatMap((component) =>
    component.sentences.flatMap(({ text, normal }) => {
      if (text === '' || said.has(text)) return [];
      said.add(text);
      const board = shownBy(component, components, text);
      return [{ text, board, things: normal.filter((n) => n !== 0).length }];
    }),
  );
  const shown = (some: typeof lines): JSX.Element => (
    <ul class="lines">
      {some.map(({ text, board }) => (
        <li>
          <p class="cost">{upperFirst(text)}.</p>
          {board && <Whole {...context} board={board} other={board.runs ? null : board.alternative} at={board.decisive?.frame ?? null} />}
        </li>
      ))}
    </ul>
  );
  const fine = lines.filter(({ things }) => things > kEasy);
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
      {shown(lines.filter(({ things }) => things <= kEasy))}
      {update && update.still.length > 0 && <p>As before, {update.still.join('; ')}.</p>}
      {fine.length > 0 && (
        <Folded summary={`${counted(fine.length, 'finer trade-off')}, of more than ${kEasy} things`} isOpen={isPrinting}>
          {shown(fine)}
        </Folded>
      )}
      <Brackets brackets={[...known.values()]} />
      {skipped.length > 0 && (
        <>
          <h3>Not in this lesson</h3>
          <ul>
            {skipped.map(({ name, why }) => (
              <li>
                {upperFirst(name)}: {why}.
              </li>
            ))}
          </ul>
        </>
      )}
      <FirstAndLast {...context} predictions={predictions} />
      <div class="submit no-print">
        <Button onClick={() => window.print()}>Print</Button>
      </div>
    </div>
  );
}

// One's first and last prediction, side by side.
function FirstAndLast({ predictions, ...context }: EndProps): JSX.Element | null {
  const made = [...predictions.values()].filter(({ mine }) => mine !== null);
  const [first, last] = [made[0], made[made.length - 1]];
  if (!first || !last || made.length < 2) return null;
  const one = ({ shown, mine, isRight }: Prediction, title: string): JSX.Element => (
    <figure>
      <Whole {...context} board={shown} other={isRight ? null : mine} at={mine && !isRight ? partingOf(shown, mine) : null} />
      <figcaption>
        {title}: {isRight ? 'right.' : 'the dashed line is yours, the solid one the robot\u2019s.'}
      </figcaption>
    </figure>
  );
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
