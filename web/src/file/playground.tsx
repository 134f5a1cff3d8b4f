// A domain file that can be changed, and what follows at once: a simulated crew that is taught, or the lesson.
import type { JSX } from 'preact';
import { useEffect, useRef, useState } from 'preact/hooks';
import { App } from '../live/app';
import { download } from '../shared/download';
import { useTransport } from '../shared/transport';
import type { LessonFile } from './document';
import { EngineError, type Diagnostic, type Engine, type State } from './engine';
import { LocalServer } from './local_server';
import { TeacherView, type Teacher } from './teacher';

const kDomain = 'domain.toml';
const kPause = 500; // ms after the last change

interface Crew {
  strategy: string;
  members: string; // a letter of a learner type each
  replicate: number;
}

interface Told {
  errors: Diagnostic[];
  warnings: string[];
  busy: boolean;
}

// What is wrong with the study is not for who changes the domain, unless nothing else is.
const isOfStudy = (text: string): boolean => text.startsWith('/study/study.toml');

const diagnosticsOf = (error: unknown): Diagnostic[] => {
  if (error instanceof EngineError && error.diagnostics.length > 0) {
    const own = error.diagnostics.filter(({ file }) => !isOfStudy(file ?? ''));
    return own.length > 0 ? own : error.diagnostics;
  }
  return [{ file: null, line: null, column: null, text: error instanceof Error ? error.message : String(error) }];
};

export function Playground({ engine, file }: { engine: Engine; file: LessonFile }): JSX.Element {
  const [text, setText] = useState(file.inputs[kDomain] ?? '');
  const [mode, setMode] = useState<'crew' | 'lesson'>('crew');
  const [crew, setCrew] = useState<Crew>({ strategy: String(file.setup['strategy']), members: '', replicate: 1 });
  const [teacher, setTeacher] = useState<Teacher | null>(null);
  const [period, setPeriod] = useState(Infinity);
  const [lesson, setLesson] = useState(0); // counts lessons that were begun
  const [told, setTold] = useState<Told>({ errors: [], warnings: [], busy: true });
  const run = useRef(0);

  const inputs = { ...file.inputs, [kDomain]: text };
  const open = (setup: object): Promise<State> => engine.ask({ do: 'open', inputs, setup: { ...file.setup, id: 'playground', ...setup } });

  // Taught before one's eyes: every period is shown when it is over.
  const teach = async (isCurrent: () => boolean): Promise<void> => {
    const members = crew.members || String(file.setup['composition']).repeat(3);
    const simulated = [...members].map(() => true);
    let state = await open({ composition: members, strategy: crew.strategy, replicate: crew.replicate, simulated });
    setTold({ errors: [], warnings: (state.warnings ?? []).filter((one) => !isOfStudy(one)), busy: true });
    setPeriod(Infinity);
    while (isCurrent() && state.teaching) {
      state = await engine.ask<State>({ do: 'teach' });
      const now = await engine.ask<Teacher>({ do: 'teacher' });
      if (isCurrent()) setTeacher(now);
    }
  };
  const take = async (): Promise<void> => {
    const nothing = (): void => undefined;
    const server = new LocalServer(engine, { ...file, inputs }, null, null, () => [], { kept: nothing, news: nothing, consent: nothing, elsewhere: nothing });
    await server.ready();
    useTransport(server);
    setLesson((count) => count + 1);
  };
  const begin = async (): Promise<void> => {
    const own = (run.current += 1);
    const isCurrent = (): boolean => run.current === own;
    try {
      await (mode === 'crew' ? teach(isCurrent) : take());
      if (isCurrent()) setTold((known) => ({ ...known, errors: [], busy: false }));
    } catch (error) {
      if (isCurrent()) setTold({ errors: diagnosticsOf(error), warnings: [], busy: false });
    }
  };
  useEffect(() => {
    setTold((known) => ({ ...known, busy: true }));
    const timer = setTimeout(() => void begin(), teacher || lesson > 0 ? kPause : 0);
    return () => clearTimeout(timer);
  }, [text, mode, crew]);

  const isBad = told.errors.length > 0;
  return (
    <main id="main" tabIndex={-1} class={`playground ${mode}`} lang="en" dir="ltr">
      <h1>{file.title}: playground</h1>
      <p>Change the robot, and see at once what there is to learn about it and how a crew is taught. Nothing leaves this page, and nothing is kept: save the domain to go on with it.</p>
      <div class="playground-parts">
        <section aria-labelledby="domain-title">
          <h2 id="domain-title">The domain</h2>
          <Editor text={text} onText={setText} told={told} />
          <p>
            <button type="button" onClick={() => download(new Blob([text], { type: 'text/plain' }), kDomain)}>
              Save the domain
            </button>{' '}
            <button type="button" onClick={() => setText(file.inputs[kDomain] ?? '')} disabled={text === file.inputs[kDomain]}>
              As it was
            </button>
          </p>
        </section>
        <section aria-labelledby="seen-title" aria-busy={told.busy}>
          <h2 id="seen-title">{mode === 'crew' ? 'A simulated crew' : 'The lesson'}</h2>
          <p role="group" aria-label="What to see">
            <button type="button" aria-pressed={mode === 'crew'} onClick={() => setMode('crew')}>
              Teach a simulated crew
            </button>{' '}
            <button type="button" aria-pressed={mode === 'lesson'} onClick={() => setMode('lesson')}>
              Take the lesson yourself
            </button>
          </p>
          {mode === 'crew' && teacher && <Choices teacher={teacher} crew={crew} onCrew={setCrew} fallback={String(file.setup['composition']).repeat(3)} />}
          <p role="status">{isBad ? 'The domain has errors; what is shown is from before.' : told.busy ? (mode === 'crew' ? 'The crew is being taught...' : 'The lesson is being prepared...') : ''}</p>
          {mode === 'crew' && teacher && <TeacherView teacher={teacher} period={period} onPeriod={setPeriod} />}
          {mode === 'lesson' && lesson > 0 && <App key={lesson} />}
        </section>
      </div>
    </main>
  );
}

// The text with its line numbers. Errors stand below, and each leads to its place.
function Editor({ text, onText, told }: { text: string; onText: (text: string) => void; told: Told }): JSX.Element {
  const area = useRef<HTMLTextAreaElement>(null);
  const gutter = useRef<HTMLPreElement>(null);
  const lines = text.split('\n');
  const here = told.errors.filter(({ file, line }) => line !== null && (file ?? '').endsWith(kDomain));
  const marked = new Set(here.map(({ line }) => line));
  const goTo = (line: number, column: number): void => {
    if (!area.current) return;
    const before = lines.slice(0, line - 1).reduce((sum, one) => sum + one.length + 1, 0);
    area.current.focus();
    area.current.setSelectionRange(before + column - 1, before + (lines[line - 1]?.length ?? 0));
    area.current.scrollTop = (area.current.scrollHeight / lines.length) * Math.max(0, line - 6);
  };
  return (
    <>
      <div class="editor">
        <pre ref={gutter} aria-hidden="true">
          {lines.map((_, i) => (
            <span class={marked.has(i + 1) ? 'bad' : undefined}>{`${marked.has(i + 1) ? '! ' : ''}${i + 1}\n`}</span>
          ))}
        </pre>
        <textarea
          ref={area}
          value={text}
          spellcheck={false}
          wrap="off"
          aria-label="Text of the domain"
          aria-invalid={told.errors.length > 0}
          aria-describedby="domain-errors"
          onInput={(event) => onText(event.currentTarget.value)}
          onScroll={(event) => gutter.current && (gutter.current.scrollTop = event.currentTarget.scrollTop)}
        />
      </div>
      <div id="domain-errors" role="status">
        {told.errors.map(({ text: said, file, line, column }) => (
          <>
            <pre class="said bad" tabIndex={0}>{said.replaceAll('/study/', '')}</pre>
            {line !== null && (file ?? '').endsWith(kDomain) && (
              <button type="button" onClick={() => goTo(line, column ?? 1)}>
                Go to line {line}
              </button>
            )}
          </>
        ))}
        {told.warnings.map((said) => (
          <pre class="said" tabIndex={0}>{said.replaceAll('/study/', '')}</pre>
        ))}
      </div>
    </>
  );
}

interface ChoicesProps {
  teacher: Teacher;
  crew: Crew;
  onCrew: (crew: Crew) => void;
  fallback: string;
}

function Choices({ teacher, crew, onCrew, fallback }: ChoicesProps): JSX.Element {
  const { strategies, types } = teacher.study;
  const members = crew.members || fallback;
  const first = types[0]?.letter ?? 'N';
  const resized = (size: number): string => members.slice(0, size).padEnd(size, first);
  return (
    <div class="choices">
      <label>
        Strategy{' '}
        <select value={crew.strategy} onChange={(event) => onCrew({ ...crew, strategy: event.currentTarget.value })}>
          {strategies.map(({ name }) => (
            <option value={name}>{name}</option>
          ))}
        </select>
      </label>
      <label>
        People{' '}
        <select value={String(members.length)} onChange={(event) => onCrew({ ...crew, members: resized(Number(event.currentTarget.value)) })}>
          {[1, 2, 3, 4, 5, 6].map((size) => (
            <option value={String(size)}>{size}</option>
          ))}
        </select>
      </label>
      {types.length > 1 &&
        [...members].map((letter, i) => (
          <label>
            <span class="visually-hidden">Person {i + 1}</span>
            <select value={letter} onChange={(event) => onCrew({ ...crew, members: members.slice(0, i) + event.currentTarget.value + members.slice(i + 1) })}>
              {types.map((type) => (
                <option value={type.letter}>{type.label || type.letter}</option>
              ))}
            </select>
          </label>
        ))}
      <button type="button" onClick={() => onCrew({ ...crew, replicate: crew.replicate + 1 })}>
        Other people
      </button>
    </div>
  );
}
