// The lesson: what the map's things are, then every component with its demonstrations and tests.
import type { JSX } from 'preact';
import { useEffect, useMemo, useRef } from 'preact/hooks';
import { themeToggle } from '../shared/theme';
import { DemonstrationView, Sentences } from './demonstration';
import type { Component, Lesson } from './document';
import { kFew } from './board';
import { Patterns, PartGlyph, Robot } from './glyphs';
import { Legend } from './legend';
import type { Context } from './scene';
import { TestView } from './test_card';
import { counted, upperFirst } from './words';

export function Page({ lesson }: { lesson: Lesson }): JSX.Element {
  const { domain } = lesson;
  const legend = useMemo(() => new Legend(domain), [domain]);
  const context = { domain, legend };
  return (
    <>
      <Patterns surfaces={legend.surfaces} />
      <header>
        <div class="masthead">
          <p class="kicker">kith lesson</p>
          <Adopted make={themeToggle} />
        </div>
        <h1>{domain.title || domain.id}</h1>
      </header>
      <div class="columns">
        <Contents lesson={lesson} />
        <main id="main" tabIndex={-1}>
          <Introduction lesson={lesson} {...context} />
          {lesson.components.map((component) => (
            <ComponentView component={component} {...context} />
          ))}
          <Skipped lesson={lesson} />
          <Notices lesson={lesson} />
        </main>
      </div>
    </>
  );
}

// An element that the shared code makes.
function Adopted({ make }: { make: () => HTMLElement }): JSX.Element {
  const place = useRef<HTMLSpanElement>(null);
  useEffect(() => place.current?.replaceChildren(make()), []);
  return <span ref={place} />;
}

function Contents({ lesson }: { lesson: Lesson }): JSX.Element {
  return (
    <nav class="contents" aria-label="Contents">
      <ol>
        <li>
          <a href="#introduction">How to read this</a>
        </li>
        {lesson.components.map(({ number, name }) => (
          <li>
            <a href={`#component-${number}`}>
              {number}. {upperFirst(name)}
            </a>
          </li>
        ))}
        {lesson.skipped.length > 0 && (
          <li>
            <a href="#skipped">Not taught</a>
          </li>
        )}
      </ol>
    </nav>
  );
}

function Introduction({ lesson, legend }: Context & { lesson: Lesson }): JSX.Element {
  const things = legend.things();
  const hasMap = lesson.components.some(({ demonstrations }) => demonstrations.some(({ map }) => map));
  const n = lesson.components.length;
  return (
    <section id="introduction" aria-labelledby="introduction-title">
      <h2 id="introduction-title">How to read this</h2>
      <p>
        What this robot prefers, in {counted(n, 'part')}. Each part shows demonstrations, with one reason each, and then
        asks what the robot would do.
      </p>
      {hasMap && (
        <ul class="legend" aria-label="What is on the boards">
          <LegendItem name="the robot">
            <Robot />
          </LegendItem>
          {things.map((part) => (
            <LegendItem name={part.name} isSurface={part.kind === 'terrain' || part.kind === 'wall'}>
              <PartGlyph part={part} legend={legend} />
            </LegendItem>
          ))}
          <LegendItem name="the robot's way">
            <g class="way own">
              <path class="line" d="M-20 0H20" />
              <path class="arrow" d="M5 0-4 -4.6V4.6Z" />
            </g>
          </LegendItem>
          <LegendItem name="what somebody could expect">
            <g class="way other">
              <path class="line" d="M-20 0H20" />
              <path class="arrow" d="M5 0-4 -4.6V4.6Z" />
            </g>
          </LegendItem>
          <LegendItem name="where both part">
            <rect class="decisive" x={-17} y={-17} width={34} height={34} rx={4} />
          </LegendItem>
        </ul>
      )}
    </section>
  );
}

function LegendItem({ name, isSurface, children }: { name: string; isSurface?: boolean; children: preact.ComponentChildren }) {
  return (
    <li>
      <svg viewBox="-22 -22 44 44" aria-hidden="true" focusable="false">
        {children}
        {isSurface && <rect class="frame" x={-20} y={-20} width={40} height={40} />}
      </svg>
      {upperFirst(name)}
    </li>
  );
}

function ComponentView({ component, ...context }: Context & { component: Component }): JSX.Element {
  const id = `component-${component.number}`;
  const tests = component.tests;
  return (
    <section id={id} aria-labelledby={`${id}-title`}>
      <h2 id={`${id}-title`}>
        {component.number}. {upperFirst(component.name)}
      </h2>
      <div class="goals">
        <p>What there is to learn:</p>
        <Sentences sentences={component.sentences} />
      </div>
      {component.demonstrations.map((shown, i) => (
        <DemonstrationView shown={shown} number={i + 1} {...context} />
      ))}
      {tests.length > 0 && (
        <>
          <h3>{tests.length === 1 ? 'A test' : 'Tests'}</h3>
          <div class={(context.domain.width ?? 0) > kFew ? 'tests wide' : 'tests'}>
            {tests.map((test, i) => (
              <TestView test={test} number={i + 1} {...context} />
            ))}
          </div>
        </>
      )}
    </section>
  );
}

function Skipped({ lesson }: { lesson: Lesson }): JSX.Element | null {
  if (lesson.skipped.length === 0) return null;
  return (
    <section id="skipped" aria-labelledby="skipped-title">
      <h2 id="skipped-title">Not taught</h2>
      <ul>
        {lesson.skipped.map(({ name, why }) => (
          <li>
            {upperFirst(name)}: {why}.
          </li>
        ))}
      </ul>
    </section>
  );
}

function Notices({ lesson }: { lesson: Lesson }): JSX.Element {
  const place = useRef<HTMLDivElement>(null);
  useEffect(() => {
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
