// The lesson: every component with its examples and tests, and what the robot is like.
import type { JSX } from 'preact';
import { useLayoutEffect, useMemo, useRef, useState } from 'preact/hooks';
import { Patterns } from '../shared/board/glyphs';
import { Legend } from '../shared/board/legend';
import { themeToggle } from '../shared/theme';
import { counted, usePrinting, Worlds, type Context, type Prediction } from './context';
import { DemonstrationView, Whole } from './demonstration';
import type { Component, Lesson } from './document';
import { End } from './portrait';
import { TestView } from './test_card';

export function Page({ lesson }: { lesson: Lesson }): JSX.Element {
  const { domain } = lesson;
  const legend = useMemo(() => new Legend(domain), [domain]);
  const worlds = useMemo(() => new Worlds(lesson), [lesson]);
  const isPrinting = usePrinting();
  const [predictions, setPredictions] = useState<Map<string, Prediction>>(new Map());
  // What counts is what somebody thought before they had seen the answer.
  const tell = (key: string, prediction: Prediction): void =>
    setPredictions((known) => (known.has(key) ? known : new Map(known).set(key, prediction)));
  const context = { lesson, domain, legend, worlds, tell };
  return (
    <>
      <Patterns surfaces={legend.surfaces} />
      <header>
        <div class="masthead">
          <p class="kicker">Lesson</p>
          <Adopted make={themeToggle} />
        </div>
        <h1>What will the robot do?</h1>
      </header>
      <div class="columns">
        <Contents lesson={lesson} predictions={predictions} />
        <main id="main" tabIndex={-1}>
          <Introduction lesson={lesson} />
          {lesson.components.map((component) => (
            <ComponentView component={component} {...context} />
          ))}
          {lesson.components.length > 0 && <End {...context} predictions={predictions} />}
          {isPrinting && <Answers {...context} />}
          <Notices lesson={lesson} />
        </main>
      </div>
    </>
  );
}

// An element that the shared code makes.
function Adopted({ make }: { make: () => HTMLElement }): JSX.Element {
  const place = useRef<HTMLSpanElement>(null);
  useLayoutEffect(() => place.current?.replaceChildren(make()), []);
  return <span ref={place} />;
}

// A segment for every board, filled when it has been predicted.
function Contents({ lesson, predictions }: { lesson: Lesson; predictions: Map<string, Prediction> }): JSX.Element {
  return (
    <nav class="contents" aria-label="Contents">
      <ol>
        <li>
          <a href="#introduction">How it works</a>
        </li>
        {lesson.components.map(({ number, demonstrations, tests }) => {
          const names = [...demonstrations.map((_, i) => `example.${number}.${i}`), ...tests.map((_, i) => `test.${number}.${i}`)];
          return (
            <li>
              <a href={`#component-${number}`}>Part {number}</a>
              <span class="segments" aria-hidden="true">
                {names.map((name) => (
                  <i class={predictions.has(name) ? 'done' : undefined} />
                ))}
              </span>
            </li>
          );
        })}
        <li>
          <a href="#end">What it is like</a>
        </li>
      </ol>
    </nav>
  );
}

// About how long somebody looks at a board that they predict.
const kMinutes = { least: 0.75, most: 1.5 };

function Introduction({ lesson }: { lesson: Lesson }): JSX.Element {
  const n = lesson.components.length;
  const boards = lesson.components.reduce((sum, { demonstrations, tests }) => sum + demonstrations.length + tests.length, 0);
  const habit = `${lesson.explained ? 'Here it' : 'It'} always takes the path that is best for it.`;
  const { update } = lesson;
  const [least, most] = [Math.ceil(boards * kMinutes.least), Math.ceil(boards * kMinutes.most)];
  return (
    <section id="introduction" aria-labelledby="introduction-title">
      <h2 id="introduction-title">How it works</h2>
      {lesson.domain.job && <p class="job">{lesson.domain.job}</p>}
      {update && <p>{update.text}</p>}
      <p hidden={n === 0}>
        {habit} Your task is to find out what it likes and dislikes. {lesson.explained && `${lesson.explained} `}
        The lesson has {counted(n, 'part')} with {counted(boards, 'board')} in all, and takes about {least} to {most} minutes. On every board
        you show first what you think the robot will do. In the tests you are told whether you were right.
      </p>
    </section>
  );
}

function ComponentView({ component, ...context }: Context & { component: Component }): JSX.Element {
  const { number, demonstrations, tests } = component;
  const id = `component-${number}`;
  return (
    <section id={id} aria-labelledby={`${id}-title`}>
      <h2 id={`${id}-title`}>Part {number}</h2>
      {demonstrations.map((shown, i) => (
        <DemonstrationView shown={shown} number={i + 1} name={`example.${number}.${i}`} {...context} />
      ))}
      {tests.length > 0 && (
        <>
          <h3>{tests.length === 1 ? 'A test' : 'Tests'}</h3>
          {tests.map((test, i) => (
            <TestView test={test} title={`Test ${i + 1}`} name={`test.${number}.${i}`} {...context} />
          ))}
        </>
      )}
    </section>
  );
}

// On paper the answers are on the last page.
function Answers({ ...context }: Context): JSX.Element {
  return (
    <section class="answers" aria-labelledby="answers-title">
      <h2 id="answers-title">Answers</h2>
      <div class="pair">
        {context.lesson.components.flatMap(({ number, tests }) =>
          tests.map((test, i) => (
            <figure>
              <Whole {...context} board={test} />
              <figcaption>
                Part {number}, test {i + 1}
              </figcaption>
            </figure>
          )),
        )}
      </div>
    </section>
  );
}

function Notices({ lesson }: { lesson: Lesson }): JSX.Element {
  const place = useRef<HTMLDivElement>(null);
  useLayoutEffect(() => {
    const notices = document.getElementById('kith-notices');
    if (notices instanceof HTMLTemplateElement) place.current?.replaceChildren(notices.content);
  }, []);
  return (
    <section id="notices" aria-labelledby="notices-title">
      <h2 id="notices-title">About this page</h2>
      <p>
        Made by {lesson.program} from the domain {lesson.domain.id}
        {lesson.seed === undefined ? '' : `, seed ${lesson.seed}`}. It needs no network.
      </p>
      <details class="licences">
        <summary>Licences of the software inside this page</summary>
        <div ref={place} />
      </details>
    </section>
  );
}
