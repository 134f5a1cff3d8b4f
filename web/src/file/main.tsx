// A lesson in one file: the pages of live sessions, with the engine in the server's place.
import { render, type JSX } from 'preact';
import { useState } from 'preact/hooks';
import { App } from '../live/app';
import { Button } from '../live/parts/ui';
import { keep } from '../live/storage';
import { download } from '../shared/download';
import { loadTexts, t } from '../shared/texts';
import { installTheme } from '../shared/theme';
import { useTransport } from '../shared/transport';
import { readDocument } from './document';
import { Engine } from './engine';
import { LocalServer } from './local_server';
import { eraseLog, recalledLog, type Log } from './log';

installTheme();
const file = readDocument();
const page = document.getElementById('page');

function nameOf(title: string): string {
  return title.toLowerCase().replace(/[^a-z0-9]+/g, '-').replace(/^-|-$/g, '') || 'lesson';
}

// What a server would do for people: hand their answers on, and forget them.
function Bar({ server, isKept }: { server: LocalServer; isKept: boolean }): JSX.Element {
  const [isSure, setSure] = useState(false);
  const save = async (): Promise<void> => {
    const text = JSON.stringify(await server.export());
    download(new Blob([text], { type: 'application/json' }), `${nameOf(file.title)}-answers.json`);
  };
  const erase = (): void => {
    server.stop();
    eraseLog(file);
    location.reload();
  };
  return (
    <footer class="file-bar no-print">
      <p>{t(isKept ? 'file.kept' : 'file.not_kept')}</p>
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

function show(server: LocalServer, isKept: boolean): void {
  if (!page) return;
  render(
    <>
      <App />
      <Bar server={server} isKept={isKept} />
    </>,
    page,
  );
}

async function begin(log: Log | null): Promise<void> {
  if (!page) return;
  let isKept = true;
  let isShown = false;
  const engine = await Engine.start();
  const server: LocalServer = new LocalServer(engine, file, log, (kept) => {
    isKept = kept;
    if (isShown) show(server, kept);
  });
  await server.ready();
  useTransport(server);
  // For pages around this one and for tests: what has happened, and the table of moves of a world.
  Object.assign(window, { kithLesson: { log: () => server.export(), world: (key: string) => server.world(key) } });
  keep('token', 'lesson-file');
  await loadTexts();
  const skip = document.querySelector('.skip');
  if (skip) skip.textContent = t('page.skip');
  page.replaceChildren();
  isShown = true;
  show(server, isKept);
}

const kept = recalledLog(file);
begin(kept).catch((error: unknown) => {
  console.error(error);
  if (!page) return;
  const isOld = typeof DecompressionStream === 'undefined' || typeof WebAssembly === 'undefined';
  const again = (): void => {
    eraseLog(file);
    location.reload();
  };
  page.replaceChildren();
  if (isOld) render(<Trouble text={t('file.old_browser')} />, page);
  else if (kept) render(<Trouble text={t('file.lost')} again={again} />, page);
  else render(<Trouble text={t('file.broken')} />, page);
});
