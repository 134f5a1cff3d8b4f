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
import { keep, keepFor, recall } from '../live/storage';
import { isLoadedAgain, type Door, type Opening } from './doors/door';
import { unpacked } from './doors/packed';
import { findDoor, isFramed, Reporter, type DoorTrouble } from './doors/reporter';
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
  reporter: Reporter;
  status: Status;
  onResearch: () => void;
}

// Nobody comes across what gives the answers away: the link is there when the lesson is over, or for those who know the
// address.
const isForResearchers = new URLSearchParams(location.search).has('researcher');
const isOver = (stage: string): boolean => stage === 'debrief' || stage === 'ended';

// What a server would do for people: hand their answers on, and forget them.
function Bar({ server, reporter, status, onResearch }: BarProps): JSX.Element {
  const { isKept, trouble, door } = status;
  const [isSure, setSure] = useState(false);
  const save = async (): Promise<void> => {
    const text = JSON.stringify(await server.export());
    download(new Blob([text], { type: 'application/json' }), `${nameOf(file.title)}-answers.json`);
  };
  const erase = async (): Promise<void> => {
    server.stop();
    await reporter.end('again');
    eraseLog(file, door?.learner ?? '');
    location.reload();
  };
  const leave = async (): Promise<void> => {
    server.stop();
    const next = await reporter.end('for good');
    if (/^https?:/.test(next)) location.assign(next);
    else if (page) render(<Notice title={t('file.leave')} text={t('file.left')} />, page);
  };
  return (
    <footer class="file-bar no-print">
      {trouble && (
        <p class="door-trouble" role="status">
          {t(`door.${trouble}`)}
        </p>
      )}
      {server.stage !== 'consent' && <p>{t(isKept ? `file.${toldBy(status)}` : 'file.not_kept')}</p>}
      <Button onClick={() => void save()}>{t('file.save')}</Button>
      {isSure ? (
        <>
          <span role="alert">{t('file.sure')}</span>
          <Button onClick={() => void erase()}>{t('file.erase')}</Button>
          <Button onClick={() => setSure(false)}>{t('file.stay')}</Button>
        </>
      ) : (
        <Button onClick={() => setSure(true)}>{t('file.again')}</Button>
      )}
      {door && <Button onClick={() => void leave()}>{t('file.leave')}</Button>}
      {(isForResearchers || isOver(server.stage)) && <Button onClick={onResearch}>{t('file.researcher')}</Button>}
    </footer>
  );
}

// In place of the lesson, with what to do.
function Notice({ title, text, again }: { title: string; text: string; again?: () => void }): JSX.Element {
  return (
    <main id="main">
      <h1>{title}</h1>
      <p>{text}</p>
      {again && <Button onClick={again}>{t('file.erase')}</Button>}
    </main>
  );
}

interface Status {
  isKept: boolean;
  isElsewhere: boolean;
  trouble: DoorTrouble;
  opening: Opening | null;
  door: Door | null; // once it is open
}

// Who is told how the lesson goes.
const toldBy = ({ opening }: Status): 'kept' | 'reported' | 'told' => (opening ? 'reported' : isFramed(file) ? 'told' : 'kept');

// What the page does with what people do, as it is opened here: whoever reads it has told nobody anything yet.
function notices({ opening }: Status): string[] {
  const told = [...(opening ? [t(`data.${opening.system}`)] : []), ...(isFramed(file) ? [t('data.frame', { origins: file.origins.join(', ') })] : [])];
  return [...told, t(told.length > 0 ? 'data.kept' : 'data.alone')];
}

function Lesson({ server, reporter, status }: Omit<BarProps, 'onResearch'>): JSX.Element {
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
      {!status.isElsewhere && <Bar server={server} reporter={reporter} status={status} onResearch={() => setResearch(true)} />}
    </>
  );
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
  const opening = findDoor();
  const status: Status = { isKept: true, isElsewhere: false, trouble: !opening && file.package ? 'none' : null, opening, door: null };
  const update = (part: Partial<Status>): void => {
    Object.assign(status, part);
    if (isShown && page) render(<Lesson server={server} reporter={reporter} status={status} />, page);
  };
  const reporter = new Reporter(file, (trouble) => update({ trouble }));
  const connect = async (): Promise<void> => {
    if (!opening || status.door) return;
    try {
      status.door = await opening.open();
      reporter.connect(status.door);
      keep(kAgreed, file.digest);
    } catch (error) {
      console.warn(String(error));
      status.trouble = 'refused';
    }
    learner = status.door?.learner ?? '';
    keepFor(`${file.digest}.${learner}`);
    const log = await longestLog(status.door);
    hasLog = log !== null;
    await server.goOn(learner, log);
    update({});
  };
  const log = opening ? null : await longestLog(null);
  hasLog = log !== null;
  const server: LocalServer = new LocalServer(Engine.start(), file, log, opening ? null : '', () => notices(status), {
    kept: (isKept) => update({ isKept }),
    news: () => void reporter.news(server),
    consent: () => void connect().catch(giveUp),
    elsewhere: (isElsewhere) => update({ isElsewhere }),
  });
  await server.ready();
  // Whoever has agreed on this page before it was loaded again is not asked again.
  if (server.stage !== 'consent' || (isLoadedAgain() && recall(kAgreed) === file.digest)) await connect();
  keepFor(`${file.digest}.${learner}`);
  useTransport(server);
  // For pages around this one and for tests: what has happened, and the table of moves of a world.
  Object.assign(window, { kithLesson: { log: () => server.export(), world: (key: string) => server.world(key) } });
  await loadTexts();
  const skip = document.querySelector('.skip');
  if (skip) skip.textContent = t('page.skip');
  page.replaceChildren();
  isShown = true;
  update({});
}

const kAgreed = 'visit.agreed';
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
  const title = t('trouble.title');
  if (hasLog) render(<Notice title={title} text={t('file.lost')} again={again} />, page);
  else render(<Notice title={title} text={t('file.broken')} />, page);
}

// A report that brings the engine along asks for one thing only.
if (file.schema === 'kith.lesson/1') start();
else Object.assign(window, { kithTeachAgain: (place: HTMLElement, props: ComponentProps<typeof Again>) => render(<Again {...props} />, place) });
