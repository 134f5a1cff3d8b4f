// A lesson in a file in Debian's Firefox, with the keyboard alone, reloaded at every screen: narrow, dark, written from
// right to left, without motion. Firefox is driven by WebDriver BiDi.
//
//   node tests/firefox_test.mjs --kith PROGRAM [--modules DIR] [--firefox FILE] [--screenshots DIR]
import assert from 'node:assert/strict';
import { execFileSync, spawn } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { dirname, join } from 'node:path';
import { after, before, describe, it } from 'node:test';
import { fileURLToPath, pathToFileURL } from 'node:url';
import { parseArgs } from 'node:util';
import { requireFrom } from './browser.mjs';
import { bestPath, priced } from './live/delivery.mjs';

const here = dirname(fileURLToPath(import.meta.url));
const { values } = parseArgs({
  options: {
    kith: { type: 'string' },
    modules: { type: 'string', default: join(here, '..') },
    firefox: { type: 'string', default: '/usr/bin/firefox-esr' },
    screenshots: { type: 'string' },
  },
});
if (!values.kith) {
  console.error('usage: node tests/firefox_test.mjs --kith PROGRAM [--modules DIR] [--firefox FILE] [--screenshots DIR]');
  process.exit(2);
}
const require = requireFrom(values.modules);
const { WebSocket } = require('ws');
const axe = readFileSync(require.resolve('axe-core/axe.min.js'), 'utf8');
const folder = mkdtempSync(join(tmpdir(), 'kith-firefox-'));
const kPatience = 240_000; // milliseconds: the machine may be busy; nothing here is about time
const kKeys = { Tab: '\uE004', Enter: '\uE007', Space: ' ', up: '\uE013', down: '\uE015', left: '\uE012', right: '\uE014', pickup: ' ', dropoff: ' ' };

async function until(what, isSo) {
  const end = Date.now() + kPatience;
  for (;;) {
    const found = await isSo();
    if (found) return found;
    assert.ok(Date.now() < end, `waited in vain for ${what}`);
    await new Promise((resolve) => setTimeout(resolve, 50));
  }
}

class Firefox {
  waiting = new Map();
  trouble = [];
  count = 0;

  static async start(prefs) {
    const browser = new Firefox();
    const profile = mkdtempSync(join(folder, 'profile-'));
    writeFileSync(join(profile, 'user.js'), Object.entries(prefs).map(([key, value]) => `user_pref(${JSON.stringify(key)}, ${JSON.stringify(value)});\n`).join(''));
    browser.process = spawn(values.firefox, ['--headless', '--no-remote', '--remote-debugging-port=0', '--profile', profile], { env: { ...process.env, HOME: folder }, stdio: ['ignore', 'ignore', 'pipe'] });
    const address = await new Promise((resolve, reject) => {
      let text = '';
      browser.process.once('exit', () => reject(new Error(`Firefox ended: ${text}`)));
      browser.process.stderr.on('data', (piece) => {
        text += piece;
        const found = /WebDriver BiDi listening on (ws:\S+)/.exec(text);
        if (found) resolve(found[1]);
      });
    });
    browser.socket = new WebSocket(`${address}/session`);
    await new Promise((resolve) => browser.socket.once('open', resolve));
    browser.socket.on('message', (data) => browser.receive(JSON.parse(data)));
    await browser.ask('session.new', { capabilities: {} });
    await browser.ask('session.subscribe', { events: ['log.entryAdded', 'network.beforeRequestSent'] });
    const look = "() => window.addEventListener('kith-view', ({ detail }) => (window.seenView = detail))";
    await browser.ask('script.addPreloadScript', { functionDeclaration: look });
    browser.context = (await browser.ask('browsingContext.create', { type: 'tab' })).context;
    return browser;
  }

  receive({ id, method, params, result, error, message }) {
    if (method === 'log.entryAdded' && ['error', 'warn'].includes(params.level)) this.trouble.push(params.text);
    if (method === 'network.beforeRequestSent' && !/^(file|blob|data|about|resource|chrome|moz)/.test(params.request.url) && params.context === this.context) this.trouble.push(params.request.url);
    const { resolve, reject } = this.waiting.get(id) ?? {};
    this.waiting.delete(id);
    if (error) reject?.(new Error(`${error}: ${message}`));
    else resolve?.(result);
  }

  ask(method, params) {
    const id = ++this.count;
    this.socket.send(JSON.stringify({ id, method, params }));
    return new Promise((resolve, reject) => this.waiting.set(id, { resolve, reject }));
  }

  async evaluate(expression) {
    const reply = await this.ask('script.evaluate', { expression: `(async () => JSON.stringify(await (${expression})) ?? 'null')()`, target: { context: this.context }, awaitPromise: true });
    if (reply.type === 'exception') throw new Error(reply.exceptionDetails.text);
    return JSON.parse(reply.result.value);
  }

  async press(...names) {
    const actions = names.flatMap((name) => [{ type: 'keyDown', value: kKeys[name] }, { type: 'keyUp', value: kKeys[name] }]);
    await this.ask('input.performActions', { context: this.context, actions: [{ type: 'key', id: 'keys', actions }] });
  }

  // With Tab alone.
  async focus(what, isIt) {
    for (let i = 0; i < 200; ++i) {
      if (await this.evaluate(`(${isIt})(document.activeElement)`)) return;
      await this.press('Tab');
    }
    assert.fail(`${what} is not reached by Tab`);
  }
  async use(name) {
    const text = JSON.stringify(name);
    await until(`the button ${name}`, () => this.evaluate(`[...document.querySelectorAll('button')].some((one) => one.textContent.trim() === ${text} && one.getAttribute('aria-disabled') !== 'true' && !one.disabled)`));
    await this.focus(name, `(one) => one.tagName === 'BUTTON' && one.textContent.trim() === ${text}`);
    await this.press('Enter');
  }
  view() {
    return until('a view', () => this.evaluate('window.seenView ?? null'));
  }
  at(stage) {
    return until(stage, () => this.evaluate(`document.querySelector('main.stage-${stage}') !== null`));
  }
  async open(address) {
    await this.ask('browsingContext.navigate', { context: this.context, url: address, wait: 'complete' });
    await this.view();
  }
  async reload() {
    await this.ask('browsingContext.reload', { context: this.context, wait: 'complete' });
    await this.view();
  }
  async stop() {
    this.socket?.close();
    const ended = new Promise((resolve) => this.process.once('exit', resolve));
    this.process.kill();
    await ended;
  }
}

const has = (browser, text) => browser.evaluate(`[...document.querySelectorAll('button')].some((one) => one.textContent.trim() === ${JSON.stringify(text)})`);

async function drive(browser) {
  const view = await browser.view();
  const task = view.predict ?? view.check;
  const table = await browser.evaluate(`window.kithLesson.world(${JSON.stringify(task.world)})`);
  const names = bestPath(priced(table), task.start).actions.map((action) => table.actions[action].name);
  await until('the board', () => browser.evaluate("document.querySelector('.drive-area') !== null"));
  await browser.focus('the board', "(one) => one.classList.contains('drive-area')");
  await browser.press(...names);
}

const kActs = {
  consent: async (browser) => {
    await browser.focus('the box', "(one) => one.type === 'checkbox'");
    await browser.press('Space');
    await browser.use('Agree and continue');
  },
  check: async (browser) => {
    if ((await browser.evaluate("document.querySelector('h1').textContent")) !== 'Try the controls') await browser.use('Continue');
    await drive(browser);
    await browser.use('Continue');
  },
  watch: async (browser, view) => {
    await until('the board', () => browser.evaluate("document.querySelector('.drive-area, .player') !== null"));
    if (await has(browser, 'Watch without a guess')) await browser.use('Watch without a guess');
    await until('the player', () => browser.evaluate("document.querySelector('.player') !== null"));
    for (let i = 1; i < view.watch.frames.length; ++i) await browser.press('right');
    await browser.use('Next');
  },
  predict: async (browser) => {
    await drive(browser);
    await browser.use('Submit');
  },
  feedback: async (browser) => {
    while (!(await has(browser, 'Continue'))) await browser.use('Next');
    await browser.use('Continue');
  },
};

describe('a lesson in Firefox', () => {
  let browser;
  before(() => {
    writeFileSync(join(folder, 'rtl.json'), JSON.stringify({ lang: 'he', dir: 'rtl', strings: { 'intro.title': 'What this is about' } }));
    const words = ['lesson', 'item-delivery', '--set', 'group.language="rtl.json"', '-o', 'lesson.html'];
    execFileSync(values.kith, words, { cwd: folder, encoding: 'utf8' });
  });
  after(async () => {
    await browser?.stop();
    rmSync(folder, { recursive: true, force: true, maxRetries: 10, retryDelay: 200 });
  });

  it('is taken to the end by keys, reloaded at every screen, at 320 px, dark, from right to left, without motion', async () => {
    browser = await Firefox.start({ 'ui.systemUsesDarkTheme': 1, 'ui.prefersReducedMotion': 1, 'browser.shell.checkDefaultBrowser': false, 'datareporting.policy.dataSubmissionEnabled': false, 'app.update.enabled': false });
    await browser.ask('browsingContext.setViewport', { context: browser.context, viewport: { width: 320, height: 800 } });
    await browser.open(pathToFileURL(join(folder, 'lesson.html')).href);
    const checked = new Set();
    for (;;) {
      let view = await browser.view();
      const { stage } = view;
      if (stage === 'wait') continue;
      await browser.at(stage);
      if (!checked.has(stage)) {
        checked.add(stage);
        await browser.reload();
        const again = await browser.view();
        assert.deepEqual([again.stage, again.progress], [stage, view.progress]);
        view = again;
        await browser.at(stage);
        const { violations } = await browser.evaluate(`(() => { ${axe}; return window.axe.run(document, { resultTypes: ['violations'] }); })()`);
        assert.deepEqual(violations.filter(({ impact }) => ['serious', 'critical'].includes(impact)).map(({ id, nodes }) => [id, nodes[0].html]), [], stage);
        const looks = await browser.evaluate("({ wide: document.documentElement.scrollWidth - window.innerWidth, dir: document.documentElement.dir || document.querySelector('[dir]')?.dir, dark: matchMedia('(prefers-color-scheme: dark)').matches, still: matchMedia('(prefers-reduced-motion: reduce)').matches })");
        assert.ok(looks.wide <= 0, `${stage} is ${looks.wide} px too wide`);
        assert.deepEqual([looks.dir, looks.dark, looks.still], ['rtl', true, true]);
        if (values.screenshots) {
          const { data } = await browser.ask('browsingContext.captureScreenshot', { context: browser.context, origin: 'document' });
          writeFileSync(join(values.screenshots, `firefox-${stage}.png`), Buffer.from(data, 'base64'));
        }
      }
      if (!kActs[stage]) break;
      await kActs[stage](browser, view);
      const key = ({ stage: one, progress, watch, predict }) => JSON.stringify([one, progress, watch?.index, predict?.index]);
      await until(`what follows ${stage}`, async () => key(await browser.view()) !== key(view));
    }
    assert.equal((await browser.view()).stage, 'debrief');
    assert.deepEqual([...checked].sort(), ['check', 'consent', 'debrief', 'feedback', 'predict', 'watch']);
    assert.deepEqual(browser.trouble, []);
  });
});
