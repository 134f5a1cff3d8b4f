// The lesson: one board after the other, then what the robot is like, and more boards for those who want them.
import type { JSX } from 'preact';
import { useLayoutEffect, useMemo, useState } from 'preact/hooks';
import { Patterns } from '../shared/board/glyphs';
import { Legend } from '../shared/board/legend';
import { Button } from '../shared/play/button';
import { enterGoesOn } from '../shared/play/keys';
import { counted } from '../shared/texts';
import { Licences, ThemeToggle } from '../shared/edges';
import { CardView, Title, Whole } from './card';
import { cardsOf, isSameAgain, kindOf, type Card } from './cards';
import { usePrinting, Worlds, type Context, type Guess } from './context';
import type { Lesson } from './document';
import { End } from './portrait';

type Step = Card | 'introduction' | 'end';

export function Page({ lesson }: { lesson: Lesson }): JSX.Element {
  const { domain } = lesson;
  const legend = useMemo(() => new Legend(domain), [domain]);
  const worlds = useMemo(() => new Worlds(lesson), [lesson]);
  const { first, more } = useMemo(() => cardsOf(lesson), [lesson]);
  const isPrinting = usePrinting();
  const [at, setAt] = useState(0);
  const [isLonger, setLonger] = useState(false);
  const [guesses, setGuesses] = useState<Map<string, Guess>>(new Map());
  const [reached, setReached] = useState(0);
  useLayoutEffect(enterGoesOn, []);
  const steps: Step[] = first.length === 0 ? ['introduction'] : ['introduction', ...first, 'end', ...(isLonger ? more : [])];
  const end = steps.indexOf('end');
  const go = (to: number): void => {
    setReached(Math.max(reached, to));
    setAt(to);
  };
  const context = { lesson, domain, legend, worlds };
  const cards = [...first, ...(isLonger ? more : [])];
  const kinds = [...guesses].map(([name, { verdict }]) => {
    const shown = cards.find((card) => card.name === name)?.shown;
    return shown && verdict?.counts && !verdict.isRight ? kindOf(shown.counts, verdict.counts) : null;
  });
  const view = (step: Step, i: number): JSX.Element | null => {
    const isQuiet = isPrinting || reached === 0;
    if (step === 'introduction') return <Introduction lesson={lesson} cards={first} isQuiet={isQuiet} onStart={() => go(1)} />;
    if (step === 'end') {
      const longer = (): void => {
        setLonger(true);
        go(end + 1);
      };
      return <End {...context} answers={cards.flatMap((card) => ({ card, guess: guesses.get(card.name) ?? null }))} more={isLonger ? 0 : more.length} onMore={longer} />;
    }
    const next = i + 1 < steps.length ? i + 1 : end;
    return (
      <CardView
        key={step.name}
        {...context}
        card={step}
        place={`${cards.indexOf(step) + 1} of ${cards.length}`}
        guess={guesses.get(step.name) ?? null}
        isChoice={isSameAgain(kinds) && worlds.choice(step.shown) !== null}
        onGuess={(guess) => setGuesses((known) => new Map(known).set(step.name, guess))}
        next={
          <Button primary onClick={() => go(next)}>
            {next === end ? 'See what this robot is like' : 'Next board'}
          </Button>
        }
      />
    );
  };
  return (
    <>
      <Patterns surfaces={legend.surfaces} />
      <header class="masthead">
        <h1>What will the robot do?</h1>
        <ThemeToggle />
      </header>
      {steps.length > 1 && <Track steps={steps} at={at} reached={reached} guesses={guesses} onGo={go} />}
      <main id="main" tabIndex={-1}>
        {isPrinting ? steps.map(view) : view(steps[at] ?? 'introduction', at)}
        {isPrinting && <Answers {...context} cards={first} />}
        {(isPrinting || at === 0 || steps[at] === 'end') && <Notices lesson={lesson} />}
      </main>
    </>
  );
}

interface TrackProps {
  steps: Step[];
  at: number;
  reached: number; // nobody goes further than they have come
  guesses: Map<string, Guess>;
  onGo: (to: number) => void;
}

// A place for every board: grey when it is done, with a tick when the reader was right.
function Track({ steps, at, reached, guesses, onGo }: TrackProps): JSX.Element {
  return (
    <nav class="track no-print" aria-label="Boards">
      <ol>
        {steps.map((step, i) => {
          const guess = typeof step === 'string' ? undefined : guesses.get(step.name);
          const word = guess?.verdict?.isRight ? 'right' : guess ? 'done' : '';
          const name = step === 'introduction' ? 'How it works' : step === 'end' ? 'What this robot is like' : `Board ${i < steps.indexOf('end') ? i : i - 1}, ${step.kind}`;
          return (
            <li>
              <button
                type="button"
                class={word}
                aria-label={[name, word].filter((text) => text !== '').join(', ')}
                aria-current={i === at ? 'step' : undefined}
                disabled={i > reached}
                onClick={() => onGo(i)}
              >
                {word === 'right' ? '\u2713' : ''}
              </button>
            </li>
          );
        })}
      </ol>
    </nav>
  );
}

// About how long somebody looks at a board that they predict.
const kMinutes = { least: 0.75, most: 1.5 };

interface IntroductionProps {
  lesson: Lesson;
  cards: Card[];
  isQuiet: boolean;
  onStart: () => void;
}

function Introduction({ lesson, cards, isQuiet, onStart }: IntroductionProps): JSX.Element {
  const { update, explained } = lesson;
  const [least, most] = [kMinutes.least, kMinutes.most].map((minutes) => Math.ceil(cards.length * minutes));
  return (
    <section id="introduction">
      <Title isQuiet={isQuiet}>How it works</Title>
      {lesson.domain.job && (
        <p class="job">
          {lesson.domain.job} {lesson.endless && 'Sometimes it would rather go on for ever.'}
        </p>
      )}
      {update && <p>{update.text}</p>}
      {cards.length > 0 && (
        <>
          <p>
            {explained ? 'Here it' : 'It'} always takes the path that is best for it. Find out what it likes and dislikes: on every board, show first what you think
            it will do, then see what it does. {explained}
          </p>
          <p>
            {counted(cards.length, 'board')}, about {least} to {most} minutes.
          </p>
          <div class="submit no-print">
            <Button primary onClick={onStart}>
              Start
            </Button>
          </div>
        </>
      )}
    </section>
  );
}

// On paper the answers are on the last page.
function Answers({ cards, ...context }: Context & { cards: Card[] }): JSX.Element {
  return (
    <section class="answers" aria-labelledby="answers-title">
      <h2 id="answers-title">Answers</h2>
      <div class="pair">
        {cards.map(({ kind, shown }, i) =>
          kind === 'Test' ? (
            <figure>
              <Whole {...context} board={shown} />
              <figcaption>Board {i + 1}</figcaption>
            </figure>
          ) : null,
        )}
      </div>
    </section>
  );
}

function Notices({ lesson }: { lesson: Lesson }): JSX.Element {
  return (
    <section id="notices" aria-labelledby="notices-title">
      <h2 id="notices-title">About this page</h2>
      <p>
        Made by kith {lesson.program} from the domain {lesson.domain.id}
        {lesson.seed === undefined ? '' : `, seed ${lesson.seed}`}. It needs no network.
      </p>
      <Licences />
    </section>
  );
}
