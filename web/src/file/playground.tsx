// A robot that can be changed: sliders for what it likes and dislikes, and a board to paint. Behind tabs are the file
// that says so, and the lesson.
import type { JSX } from 'preact';
import { useEffect, useRef, useState } from 'preact/hooks';
import { App } from '../live/app';
import { Exploring, type Asking } from '../live/parts/explore';
import type { ParticipantView } from '../live/protocol';
import { Patterns } from '../shared/board/glyphs';
import { useLegend } from '../shared/play/board_pane';
import { Brackets, type Bracket } from '../shared/play/brackets';
import { Button } from '../shared/play/button';
import { labelOf } from '../shared/play/ledger';
import { download } from '../shared/download';
import { capitalised } from '../shared/texts';
import { useTransport } from '../shared/transport';
import type { LessonFile } from './document';
import { EngineError, type Diagnostic, type Engine } from './engine';
import { LocalServer } from './local_server';

const kDomain = 'domain.toml';
const kPause = 120; // ms after the last change
const kTabs = { robot: 'The robot', file: 'Its file', lesson: 'Take the lesson' } as const;

// What the engine says of the robot.
interface Played {
  explore: ParticipantView['explore'] | null; // nothing where the map is too large
  learn: Bracket[]; // between which bounds its weights lie for whoever has learned everything
  warnings: string[];
}

// What is wrong with the study is not for who changes the domain, unless nothing else is.
const isOfStudy = (text: string): boolean => text.startsWith('/study/study.toml');

const diagnosticsOf = (error: unknown): string[] => {
  if (!(error instanceof EngineError) || error.diagnostics.length === 0) return [error instanceof Error ? error.message : String(error)];
  const own = error.diagnostics.filter(({ file }: Diagnostic) => !isOfStudy(file ?? ''));
  return (own.length > 0 ? own : error.diagnostics).map(({ text }) => text);
};

const kWeights = /^(\s*weights\s*=\s*\{)([^}]*)\}/m;

function weightsOf(text: string): [string, number][] {
  const pairs = kWeights.exec(text)?.[2]?.split(',') ?? [];
  return pairs.flatMap((pair): [string, number][] => {
    const [name = '', value = ''] = pair.split('=').map((part) => part.trim());
    return name === '' || !Number.isFinite(Number(value)) ? [] : [[name, Number(value)]];
  });
}

const withWeight = (text: string, name: string, value: number): string =>
  text.replace(kWeights, (_, head: string, pairs: string) => `${head}${pairs.replace(new RegExp(`(^|[,\\s])(${name}\\s*=\\s*)[-+.\\d]+`), `$1$2${value}`)}}`);

export function Playground({ engine, file }: { engine: Engine; file: LessonFile }): JSX.Element {
  const original = file.inputs[kDomain] ?? '';
  const [text, setText] = useState(original);
  const [tab, setTab] = useState<keyof typeof kTabs>('robot');
  const [played, setPlayed] = useState<Played | null>(null);
  const [asked, setAsked] = useState<Asking | null>(null);
  const [errors, setErrors] = useState<string[]>([]);
  const [isBusy, setBusy] = useState(true);
  const [lesson, setLesson] = useState(0); // counts lessons that were begun
  const run = useRef(0); // counts changes
  const isAsking = useRef(false);
  const inputs = { ...file.inputs, [kDomain]: text };

  const take = async (): Promise<void> => {
    const nothing = (): void => undefined;
    const server = new LocalServer(engine, { ...file, inputs }, null, null, () => [], { kept: nothing, news: nothing, consent: nothing, elsewhere: nothing });
    await server.ready();
    useTransport(server);
    setLesson((count) => count + 1);
  };
  const latest = useRef({ inputs, asked, isLesson: false, take });
  latest.current = { inputs, asked, isLesson: tab === 'lesson', take };
  // One question at a time: what changed meanwhile is asked when the answer is there, and only the last of it.
  const begin = async (): Promise<void> => {
    if (isAsking.current) return;
    isAsking.current = true;
    const own = run.current;
    let found: string[] = [];
    try {
      const { inputs, asked, isLesson, take } = latest.current;
      if (isLesson) await take();
      else setPlayed(await engine.ask<Played>({ do: 'play', inputs, asked }));
    } catch (error) {
      found = diagnosticsOf(error);
    }
    isAsking.current = false;
    if (own !== run.current) return begin();
    setErrors(found);
    setBusy(false);
  };
  useEffect(() => {
    setBusy(true);
    run.current += 1;
    const timer = setTimeout(() => void begin(), played ? kPause : 0);
    return () => clearTimeout(timer);
  }, [text, asked, tab === 'lesson']);

  const said = (
    <div id="said" role="status">
      {errors.length > 0 && <p>The robot cannot be like this; what is shown is from before.</p>}
      {[...errors, ...(tab === 'file' ? (played?.warnings ?? []).filter((one) => !isOfStudy(one)) : [])].map((one) => (
        <pre class="said" tabIndex={0}>
          {one.replaceAll('/study/', '')}
        </pre>
      ))}
    </div>
  );
  return (
    <main id="main" tabIndex={-1} class="playground" lang="en" dir="ltr">
      <h1>{file.title}: playground</h1>
      <p role="group" aria-label="What to see">
        {Object.entries(kTabs).map(([name, title]) => (
          <>
            <Button pressed={tab === name} onClick={() => setTab(name as keyof typeof kTabs)}>
              {title}
            </Button>{' '}
          </>
        ))}
      </p>
      <section aria-label={kTabs[tab]} aria-busy={isBusy}>
        {tab === 'robot' && played && <Robot text={text} original={original} onText={setText} played={played} onAsk={setAsked} said={said} />}
        {tab === 'file' && <Editor text={text} onText={setText} isBad={errors.length > 0} />}
        {tab === 'lesson' && lesson > 0 && <App key={lesson} />}
        {!(tab === 'robot' && played) && said}
      </section>
      <p>Nothing leaves this page, and nothing is kept: save the robot to go on with it.</p>
      <div class="buttons">
        <Button onClick={() => download(new Blob([text], { type: 'text/plain' }), kDomain)}>Save the robot</Button>
        <Button off={text === original} onClick={() => setText(original)}>
          The first robot again
        </Button>
      </div>
    </main>
  );
}

interface RobotProps {
  text: string;
  original: string;
  onText: (text: string) => void;
  played: Played;
  onAsk: (asked: Asking | null) => void;
  said: JSX.Element; // beside the sliders, where people look
}

function Robot({ text, original, onText, played: { explore, learn }, onAsk, said }: RobotProps): JSX.Element {
  const board = explore?.first.board;
  const counted = board?.domain.counted ?? [];
  const { surfaces } = useLegend(board?.domain ?? { id: '' });
  const most = Math.ceil(2 * Math.max(1, ...weightsOf(original).map(([, weight]) => Math.abs(weight))));
  return (
    <div class="playground-parts">
      <div>
        <Patterns surfaces={surfaces} />
        <h2>What it likes and dislikes</h2>
        {weightsOf(text).map(([name, weight]) => {
          const one = counted.find((feature) => feature.name === name);
          return (
            <label class="weight">
              <span>{one ? capitalised(labelOf(one)) : name}</span>
              <input type="range" min={-most} max={most} step={0.25} value={weight} onInput={(event) => onText(withWeight(text, name, event.currentTarget.valueAsNumber))} />
              <output>{weight}</output>
            </label>
          );
        })}
        {said}
        <Brackets title="What there is to learn" brackets={learn} counted={counted} />
      </div>
      <div>
        <h2>What it does</h2>
        {explore ? <Exploring key={board?.map?.join()} explore={explore} onAsk={onAsk} /> : <p>The map is too large to be changed here.</p>}
      </div>
    </div>
  );
}

function Editor({ text, onText, isBad }: { text: string; onText: (text: string) => void; isBad: boolean }): JSX.Element {
  return (
    <textarea
      class="editor"
      value={text}
      spellcheck={false}
      wrap="off"
      aria-label="Text of the domain"
      aria-invalid={isBad}
      aria-describedby="said"
      onInput={(event) => onText(event.currentTarget.value)}
    />
  );
}
