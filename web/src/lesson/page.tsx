// The lesson: what the map's things are, then every component with its demonstrations and tests.
import type { JSX } from 'preact';
import { useLayoutEffect, useMemo, useRef, useState } from 'preact/hooks';
import { kFew, Tried } from '../shared/board/board';
import { Patterns, PartGlyph, Robot } from '../shared/board/glyphs';
import { Legend } from '../shared/board/legend';
import { themeToggle } from '../shared/theme';
import { DemonstrationView, Sentences, textsOf } from './demonstration';
import type { Component, Lesson } from './document';
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
          <p class="kicker">Lesson</p>
          <Adopted make={themeToggle} />
        </div>
        <h1>What will the robot do?</h1>
      </header>
      <div class="columns">
        <Contents lesson={lesson} />
        <main id="main" tabIndex={-1}>
          <Introduction lesson={lesson} {...context} />
          {lesson.components.map((component) => (
            <ComponentView component={component} {...context} />
          ))}
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

function Contents({ lesson }: { lesson: Lesson }): JSX.Element {
  return (
    <nav class="contents" aria-label="Contents">
      <ol>
        <li>
          <a href="#introduction">How it works</a>
        </li>
        {lesson.components.map(({ number }) => (
          <li>
            <a href={`#component-${number}`}>
              Part {number}
            </a>
          </li>
        ))}
      </ol>
    </nav>
  );
}

function Introduction({ lesson, legend }: Context & { lesson: Lesson }): JSX.Element {
  const things = legend.things();
  const hasMap = lesson.components.some(({ demonstrations }) => demonstrations.some(({ map }) => map));
  const hasChance = lesson.components.some(({ demonstrations }) => demonstrations.some(({ runs }) => runs));
  const n = lesson.components.length;
  return (
    <section id="introduction" aria-labelledby="introduction-title">
      <h2 id="introduction-title">How it works</h2>
      <p>
        This robot always takes the path that is best for it. Your task is to find out what it likes and dislikes. The lesson has{' '}
        {counted(n, 'part')}. In each part you watch examples, and then you predict what the robot will do.
      </p>
      {hasMap && (
        <ul class="legend" aria-label="What the symbols mean">
          <LegendItem name="the robot">
            <Robot />
          </LegendItem>
          {things.map((part) => (
            <LegendItem name={part.name} isSurface={part.kind === 'terrain' || part.kind === 'wall'}>
              <PartGlyph part={part} legend={legend} />
            </LegendItem>
          ))}
          <LegendItem name="the robot's path">
            <g class="way own">
              <path class="line" d="M-20 0H20" />
              <path class="arrow" d="M5 0-4 -4.6V4.6Z" />
            </g>
          </LegendItem>
          {hasChance && (
            <LegendItem name="where the robot tried to go, if it slips">
              <g class="way own">
                <Tried from={{ x: -14, y: 0 }} x={14} y={0} angle={0} />
              </g>
            </LegendItem>
          )}
          <LegendItem name="a path you might have expected">
            <g class="way other">
              <path class="line" d="M-20 0H20" />
              <path class="arrow" d="M5 0-4 -4.6V4.6Z" />
            </g>
          </LegendItem>
          <LegendItem name="where the paths separate">
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
        Part {component.number}
      </h2>
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
      <Summary component={component} />
    </section>
  );
}

function Summary({ component }: { component: Component }): JSX.Element | null {
  const [open, setOpen] = useState(false);
  if (textsOf(component.sentences).length === 0) return null;
  return (
    <details class="goals" open={open} onToggle={(event) => setOpen(event.currentTarget.open)}>
      <summary>
        {open ? 'Hide' : 'Show'} the summary of part {component.number}
      </summary>
      {open && <Sentences sentences={component.sentences} />}
    </details>
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
