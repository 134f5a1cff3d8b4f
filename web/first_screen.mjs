// Measures how long the first screen of each page takes from opening the link until it can be used: `kith serve --demo`
// serves it, and Chromium has nothing in its cache.
//
//   node first_screen.mjs --kith PROGRAM [--runs N] [--modules DIR] [--chromium FILE]
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { parseArgs } from 'node:util';
import { launch } from './tests/browser.mjs';
import { startKith } from './tests/kith.mjs';

const { values } = parseArgs({
  options: {
    kith: { type: 'string' },
    runs: { type: 'string', default: '10' },
    modules: { type: 'string', default: dirname(fileURLToPath(import.meta.url)) },
    chromium: { type: 'string', default: '/usr/bin/chromium' },
  },
});
const runs = Number(values.runs);
if (!values.kith || !(runs >= 1)) {
  console.error('usage: node first_screen.mjs --kith PROGRAM [--runs N] [--modules DIR] [--chromium FILE]');
  process.exit(2);
}

// Runs in the page before its scripts: `firstScreen` is the time, in milliseconds since the navigation began, at which
// what matches the selector has been painted.
function watchFor(selector) {
  window.firstScreen = new Promise((resolve) => {
    const look = () => {
      if (!document.querySelector(selector)) return requestAnimationFrame(look);
      return requestAnimationFrame(() => setTimeout(() => resolve(performance.now())));
    };
    look();
  });
}

const transferred = () => {
  const all = [...performance.getEntriesByType('navigation'), ...performance.getEntriesByType('resource')];
  const sum = (entries) => entries.reduce((bytes, entry) => bytes + entry.encodedBodySize, 0);
  return { scripts: sum(all.filter(({ name }) => name.endsWith('.js'))), all: sum(all) };
};

async function open(browser, address, selector) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 800 } });
  try {
    const page = await context.newPage();
    await page.addInitScript(watchFor, selector);
    await page.goto(address);
    return { ms: await page.evaluate(() => window.firstScreen), ...(await page.evaluate(transferred)) };
  } finally {
    await context.close();
  }
}

async function measure(browser, name, address, selector) {
  const opened = [];
  for (let i = 0; i < runs; i += 1) opened.push(await open(browser, address, selector));
  const times = opened.map(({ ms }) => ms).sort((a, b) => a - b);
  const [{ scripts, all }] = opened;
  const kilobytes = (bytes) => `${(bytes / 1000).toFixed(0)} kB`;
  console.log(
    `${name.padEnd(12)} median ${times[runs >> 1].toFixed(0)} ms, slowest ${times[runs - 1].toFixed(0)} ms of ${runs};`,
    `scripts ${kilobytes(scripts)}, in all ${kilobytes(all)} (compressed)`,
  );
}

const folder = mkdtempSync(join(tmpdir(), 'kith-first-screen-'));
const server = await startKith(values.kith, join(folder, 'session'));
const browser = await launch(values.modules, values.chromium);
try {
  await measure(browser, 'participant', server.seats[0], 'main.stage-consent button.primary');
  await measure(browser, 'join link', server.join, 'main button.primary');
  await measure(browser, 'facilitator', server.facilitator, '.globe');
} finally {
  await browser.close();
  await server.stop('SIGTERM');
  rmSync(folder, { recursive: true, force: true });
}
