// A lesson in one file: the pages of live sessions, with the engine in the server's place.
import { render, type ComponentProps, type JSX } from 'preact';
import { useLayoutEffect, useState } from 'preact/hooks';
import { App } from '../live/app';
import { Button } from '../live/parts/ui';
import { download } from '../shared/download';
import { loadTexts, t } from '../shared/texts';
import { installTheme } from '../shared/theme';
import { useTransport } from '../shared/transport';
import { Again } from './again';
import { readDocument } from './document';
import type { Door } from './doors/door';
import { unpacked } from './doors/packed';
import { findDoor, Reporter, type DoorTrouble } from './doors/reporter';
import { Engine } from './engine';
import { LocalServer } from './local_server';
import { emptyLog, eraseLog, recalledLog, type Log } from './log';
import { Playground } from './playground';
import sheet from './style.css?text';
import { Researcher } from './teacher';

const file = readDocument();
const page = document.getElementById('page');

function nameOf(title: string): string {
  return title.toLowerCase().replace(/[^a-z0-9]+/g, '-').replace(/^-|-$/g, '') || 'lesson';
}

interface BarProps {
  server: LocalServer;
  learner: string;
  status: Status;
  onResearch: () => void;
}

// Nobody comes across what gives the answers away: the link is there when the lesson is over, or for those who know the
// address.
const isForResearchers = new URLSearchParams(location.search).has('researcher');
const isOver = (stage: string): boolean => stage === 'debrief' || stage === 'ended';

// What a server would do for people: hand their answers on, and forget them.
function Bar({ server, learner, status, onResearch }: BarProps): JSX.Element {
  const { isKept, trouble } = status;
  const [isSure, setSure] = useState(false);
  const save = async (): Promise<void> => {
    const text = JSON.stringify(await server.export());
    download(new Blob([text], { type: 'application/json' }), `${nameOf(file.title)}-answers.json`);
  };
  const erase = (): void => {
    server.stop();
    eraseLog(file, learner);
    location.reload();
  };
  return (
    <footer class="file-bar no-print">
      {trouble && (
        <p class="door-trouble" role="status">
          {t(`door.${trouble}`)}
        </p>
      )}
      <p>{t(!isKept ? 'file.not_kept' : file.package || file.origins.length > 0 ? 'file.told' : 'file.kept')}</p>
      <Button onClick={() => void save()}>{t('file.save')}</Button>
      {isSure ? (
        <>
          <span role="alert">{t('file.sure')}</span>
          <Button onClick={erase}>{t('file.erase')}</Button>
          <Button onClick={() => setSure(false)}>{t('file.stay')}</Button>
        </>
      ) : (
        <Button onClick={() => setSure(true)}>{t('file.again')}</Button>
      )}
      {(isForResearchers || isOver(server.stage)) && <Button onClick={onResearch}>{t('file.researcher')}</Button>}
    </footer>
  );
}

// In place of the lesson, with what to do.
function Trouble({ text, again }: { text: string; again?: () => void }): JSX.Element {
  return (
    <main id="main">
      <h1>{t('trouble.title')}</h1>
      <p>{text}</p>
      {again && <Button onClick={again}>{t('file.erase')}</Button>}
    </main>
  );
}

interface Status {
  isKept: boolean;
  trouble: DoorTrouble;
}

function Lesson({ server, learner, status }: Omit<BarProps, 'onResearch'>): JSX.Element {
  const [isResearch, setResearch] = useState(false);
  const [, setStage] = useState(server.stage);
  useLayoutEffect(() => {
    const changed = (): void => setStage(server.stage);
    window.addEventListener('kith-view', changed);
    return () => window.removeEventListener('kith-view', changed);
  }, []);
  if (isResearch) return <Researcher load={() => server.teacher()} back={() => setResearch(false)} />;
  return (
    <>
      <App />
      <Bar server={server} learner={learner} status={status} onResearch={() => setResearch(true)} />
    </>
  );
}

function show(server: LocalServer, learner: string, status: Status): void {
  if (page) render(<Lesson server={server} learner={learner} status={status} />, page);
}

// Of what this browser and the learning system have kept, the longer one.
async function longestLog(door: Door | null): Promise<Log | null> {
  const here = recalledLog(file, door?.learner ?? '');
  const there = door?.recalled ? await unpacked(door.recalled, emptyLog(file)) : null;
  const last = (log: Log): number => Number((log.events[log.events.length - 1] as { at_us?: number } | undefined)?.at_us ?? 0);
  if (!here || !there) return here ?? there;
  return last(there) > last(here) ? there : here;
}

async function begin(): Promise<void> {
  if (!page) return;
  if (file.playground) {
    page.replaceChildren();
    render(<Playground engine={Engine.start()} file={file} />, page);
    return;
  }
  let isShown = false;
  const { door, trouble } = await findDoor(file);
  learner = door?.learner ?? '';
  const status: Status = { isKept: true, trouble };
  const update = (part: Partial<Status>): void => {
    Object.assign(status, part);
    if (isShown) show(server, learner, status);
  };
  const reporter = new Reporter(file, door, (found) => update({ trouble: found }));
  const log = await longestLog(door);
  hasLog = log !== null;
  const engine = Engine.start();
  const server: LocalServer = new LocalServer(engine, file, log, learner, (isKept) => update({ isKept }), () => void reporter.news(server));
  await server.ready();
  useTransport(server);
  // For pages around this one and for tests: what has happened, and the table of moves of a world.
  Object.assign(window, { kithLesson: { log: () => server.export(), world: (key: string) => server.world(key) } });
  await loadTexts();
  const skip = document.querySelector('.skip');
  if (skip) skip.textContent = t('page.skip');
  page.replaceChildren();
  isShown = true;
  show(server, learner, status);
}

let learner = ''; // as the learning system knows them
let hasLog = false;
function start(): void {
  installTheme();
  const style = document.createElement('style');
  style.textContent = sheet;
  document.head.append(style);
  begin().catch(giveUp);
}

function giveUp(error: unknown): void {
  console.error(error);
  if (!page) return;
  const again = (): void => {
    eraseLog(file, learner);
    location.reload();
  };
  page.replaceChildren();
  if (hasLog) render(<Trouble text={t('file.lost')} again={again} />, page);
  else render(<Trouble text={t('file.broken')} />, page);
}

// A report that brings the engine along asks for one thing only.
if (file.schema === 'kith.lesson/1') start();
else Object.assign(window, { kithTeachAgain: (place: HTMLElement, props: ComponentProps<typeof Again>) => render(<Again {...props} />, place) });
