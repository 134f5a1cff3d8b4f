// Takes lessons in a file as people would, without a server, and hands their logs back to kith.
//
//   node tests/file_test.mjs --kith PROGRAM [--screenshots DIR] [--modules DIR] [--chromium FILE]
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, statSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { dirname, join } from 'node:path';
import { after, before, describe, it } from 'node:test';
import { fileURLToPath, pathToFileURL } from 'node:url';
import { parseArgs } from 'node:util';
import { launch, reads, requireFrom } from './browser.mjs';
import { until } from './kith.mjs';
import { reach } from './live/kith_tests.mjs';
import { Reader } from './live/reader.mjs';

const here = dirname(fileURLToPath(import.meta.url));
const { values } = parseArgs({
  options: {
    kith: { type: 'string' },
    screenshots: { type: 'string' },
    modules: { type: 'string', default: join(here, '..') },
    chromium: { type: 'string', default: '/usr/bin/chromium' },
  },
});
if (!values.kith) {
  console.error('usage: node tests/file_test.mjs --kith PROGRAM [--screenshots DIR] [--modules DIR] [--chromium FILE]');
  process.exit(2);
}
const folder = mkdtempSync(join(tmpdir(), 'kith-file-'));
const axe = readFileSync(requireFrom(values.modules).resolve('axe-core/axe.min.js'), 'utf8');
const kith = (...words) => execFileSync(values.kith, words, { encoding: 'utf8' });
const refused = (...words) => {
  try {
    kith(...words);
  } catch ({ stderr }) {
    return stderr;
  }
  return assert.fail('accepted');
};
let browser;

// At a lesson file, without a network.
async function readerOf(name, look = {}) {
  const { width = 1280, dark = false, reducedMotion = true } = look;
  const context = await browser.newContext({
    viewport: { width, height: 900 },
    colorScheme: dark ? 'dark' : 'light',
    reducedMotion: reducedMotion ? 'reduce' : 'no-preference',
    offline: true,
    acceptDownloads: true,
  });
  await Reader.listen(context);
  const reader = new Reader(context, await context.newPage(), pathToFileURL(join(folder, name)).href);
  reader.page.on('request', (request) => {
    if (!/^(file|blob|data):/.test(request.url())) reader.trouble.push(`request: ${request.url()}`);
  });
  reader.origin = 'null';
  return reader.open();
}

async function withReader(name, look, body) {
  const reader = await readerOf(name, look);
  try {
    await body(reader);
    assert.deepEqual(reader.trouble, [], 'requests, console messages or uncaught errors');
  } finally {
    await reader.close();
  }
}

describe('a lesson in a file', () => {
  before(async () => {
    browser = await launch(values.modules, values.chromium);
    kith('lesson', 'item-delivery', '--adaptive', '-o', join(folder, 'delivery.html'));
  });
  after(async () => {
    await browser?.close();
    rmSync(folder, { recursive: true, force: true });
  });

  it('is a file that can be sent', () => {
    assert.ok(statSync(join(folder, 'delivery.html')).size < 1_000_000);
  });

  it('teaches to the end, reloaded at every stage, and its log is that of a session', async () => {
    await withReader('delivery.html', {}, async (reader) => {
      for (const stage of ['check', 'watch', 'predict', 'feedback']) {
        await reach([reader], [stage], () => false);
        const { stage: before, progress } = reader.view;
        await reader.reload();
        assert.deepEqual([reader.view.stage, reader.view.progress], [before, progress]);
      }
      await reach([reader], ['debrief', 'ended']);
      const log = join(folder, 'answers.json');
      const saving = reader.page.waitForEvent('download');
      await reader.button('Save my answers').click();
      await (await saving).saveAs(log);

      const session = join(folder, 'session');
      assert.match(kith('session', 'import', log, '-o', session), /replayed \d+ events/);
      assert.match(kith('session', 'import', log, '-o', session), /already/);
      assert.match(kith('session', 'replay', session), /all identical/);
      kith('session', 'export', session, '-o', join(folder, 'tables'));

      // Whoever edits a log is found out.
      const edited = JSON.parse(readFileSync(log, 'utf8'));
      const answer = edited.events.find(({ type }) => type === 'answered');
      answer.body.actions = answer.body.actions.slice(0, -1);
      writeFileSync(join(folder, 'edited.json'), JSON.stringify(edited));
      assert.match(refused('session', 'import', join(folder, 'edited.json'), '-o', session), /E1622/);
      writeFileSync(join(folder, 'cut.json'), readFileSync(log, 'utf8').slice(0, -20));
      assert.match(refused('session', 'import', join(folder, 'cut.json'), '-o', session), /E1621/);
    });
  });

  it('is held by the tab that opened it last: an older one says so, writes nothing, and can take over', async () => {
    await withReader('delivery.html', {}, async (older) => {
      await reach([older], ['watch']);
      const newer = new Reader(older.context, await older.context.newPage(), older.page.url());
      await newer.open();
      await older.page.getByRole('heading', { name: 'Open in another tab' }).waitFor();
      assert.equal(await older.button('Start again').count(), 0);
      await reach([newer], ['feedback']);
      const answers = () => newer.page.evaluate(() => JSON.parse(Object.entries(localStorage).find(([key]) => !key.endsWith('.tab'))[1]).events.filter(({ type }) => type === 'answered').length);
      const before = await answers();
      assert.ok(before > 0);
      await older.button('Use this tab instead').click();
      await newer.page.getByRole('heading', { name: 'Open in another tab' }).waitFor();
      await until(() => older.view.stage === 'feedback');
      assert.deepEqual(older.view.progress, newer.view.progress);
      assert.equal(await answers(), before);
      assert.deepEqual(newer.trouble, []);
    });
  });

  for (const [width, dark] of [
    [1280, false],
    [320, true],
  ]) {
    it(`at ${width} px ${dark ? 'dark' : 'light'}: no overflow, nothing serious for axe`, async () => {
      await withReader('delivery.html', { width, dark }, async (reader) => {
        for (const stage of ['consent', 'check', 'watch', 'predict', 'feedback']) {
          await reach([reader], [stage], () => false);
          await reader.page.waitForSelector(`main.stage-${stage}`);
          if (values.screenshots) {
            await reader.page.screenshot({ path: join(values.screenshots, `${stage}-${width}.png`), fullPage: true });
          }
          assert.deepEqual(await reader.violations(axe), []);
          const wide = await reader.page.evaluate(() => document.documentElement.scrollWidth - window.innerWidth);
          assert.ok(wide <= 0, `${stage} is ${wide} px too wide`);
        }
      });
    });
  }

  it('lets people change the world by keys and by dragging, and the robot plans again', async () => {
    await withReader('delivery.html', {}, async (reader) => {
      const { page } = reader;
      await reach([reader], ['feedback']);
      while (reader.view.feedback.tests.length > 1 && !(await reader.button('Change the world').isVisible())) await reader.button('Next').click();
      await reader.button('Change the world').click();
      const shown = () => reader.view.explore.last;
      const cell = (x, y) => page.locator(`[data-cell="${x},${y}"]`);
      const put = async (name, x, y) => {
        await page.getByRole('radio', { name }).check();
        await cell(x, y).click();
      };
      // Walls around the goal: the robot cannot do its job, and is told so.
      await put('Wall', 1, 2);
      await put('Wall', 2, 2);
      await put('Wall', 2, 3);
      await until(() => shown()?.impossible);
      await page.getByText('The robot cannot do its job here').waitFor();
      await reader.button('As it was').click();

      // The robot by keys to its own place and two to the left.
      await page.getByRole('radio', { name: 'Move' }).check();
      const from = reader.view.explore.first.board.start.robot;
      const to = from[0] > 2 ? [from[0] - 1, from[1]] : [from[0] + 1, from[1]];
      await cell(...from).focus();
      await page.keyboard.press('Enter');
      await page.keyboard.press(to[0] > from[0] ? 'ArrowRight' : 'ArrowLeft');
      await page.keyboard.press('Enter');
      await until(() => shown() && JSON.stringify(shown().board?.start.robot) === JSON.stringify(to));

      // And back with the pointer; whatever comes about survives a reload.
      const [a, b] = [await cell(...to).boundingBox(), await cell(...from).boundingBox()];
      await page.mouse.move(a.x + a.width / 2, a.y + a.height / 2);
      await page.mouse.down();
      await page.mouse.move(b.x + b.width / 2, b.y + b.height / 2, { steps: 4 });
      await page.mouse.up();
      await until(() => JSON.stringify(shown().board?.start.robot) === JSON.stringify(from));
      if (values.screenshots) await page.screenshot({ path: join(values.screenshots, 'explore.png'), fullPage: true });
      assert.deepEqual(await reader.violations(axe), []);
      const seen = shown();
      await reader.reload();
      assert.deepEqual(shown(), seen);
    });
  });

  it('teaches models as CSV, and chooses the lesson that the program chooses', async () => {
    kith('lesson', join(here, '../../domains/gallery/frozen_lake.toml'), '--adaptive', '-o', join(folder, 'lake.html'));
    await withReader('lake.html', {}, async (reader) => {
      await reader.consent();
      await reader.at('What this is about');
      await reader.button('Continue').click();
      await reader.at('Try the controls');
      await reader.drive(['right', 'down', 'left', 'up', 'right', 'down', 'left', 'up']);
      await reader.page.getByText('You can continue whenever you like.').waitFor();
      await reader.button('Continue').click();
      await until(() => reader.view.stage === 'watch');
      if (values.screenshots) {
        await reader.page.waitForSelector('.drive-area, .player');
        await reader.page.screenshot({ path: join(values.screenshots, 'lake-watch.png'), fullPage: true });
      }
      const log = join(folder, 'lake.json');
      writeFileSync(log, JSON.stringify(await reader.log()));
      assert.match(kith('session', 'import', log, '-o', join(folder, 'lake')), /replayed \d+ events/);
    });
  });

  it('shows researchers how it was chosen, at the end and to those who know the address only', async () => {
    await withReader('delivery.html', {}, async (reader) => {
      const { page } = reader;
      const link = reader.button('For researchers: how this lesson was chosen');
      await reach([reader], ['feedback'], () => false);
      assert.equal(await link.count(), 0);
      await reach([reader], ['debrief']);
      await link.click();
      await page.getByText('This page is for researchers.').waitFor();
      await page.locator('.teacher-picture .globe').first().waitFor();
      const said = page.locator('.teacher-steps span');
      assert.match(await said.textContent(), /^at the end, after period \d+$/);
      const steps = page.locator('.teacher-steps input');
      const periods = Number(await steps.getAttribute('max'));
      assert.ok(periods > 0);
      await steps.fill('0');
      assert.equal(await said.textContent(), 'after period 1');
      await page.locator('.teacher-picture .why-text').waitFor();
      if (values.screenshots) await page.screenshot({ path: join(values.screenshots, 'researcher.png'), fullPage: true });
      assert.deepEqual(await reader.violations(axe), []);
      await reader.button('Back to the lesson').click();
      await page.waitForSelector('main.stage-debrief');

      await reader.button('Start again').click();
      reader.view = null;
      await reader.button('Erase and start again').click();
      await until(() => reader.view?.stage === 'consent');
      assert.equal(await link.count(), 0);
      await page.goto(`${page.url()}?researcher`);
      await link.click();
      await page.locator('.teacher-picture .globe').first().waitFor();
    });
  });

  it('has a playground, where path, facts and what there is to learn follow weights and board', async () => {
    kith('lesson', 'item-delivery', '--playground', '-q', '-o', join(folder, 'playground.html'));
    const context = await browser.newContext({ viewport: { width: 1500, height: 950 }, offline: true, reducedMotion: 'reduce' });
    const page = await context.newPage();
    const trouble = [];
    page.on('console', (message) => trouble.push(message.text()));
    page.on('pageerror', (error) => trouble.push(error.message));
    await page.goto(pathToFileURL(join(folder, 'playground.html')).href);
    page.setDefaultTimeout(240_000);
    const tab = (name) => page.getByRole('button', { name, exact: true }).click();
    const learn = page.locator('.brackets').first();
    await reads(learn, /Crossing rubble costs 2 to 4 steps/);
    await page.getByRole('slider', { name: 'Crossing rubble' }).fill('-5.5');
    await reads(learn, /Crossing rubble costs more than 4 steps/);
    await page.getByLabel('Wall').check();
    const free = page.locator('.explore-cells button', { hasText: /^Free floor/i }).first();
    await free.click();
    await reads(page.locator('.explore .reasons'), /1 place is changed/);
    await page.evaluate(axe);
    const { violations } = await page.evaluate(() => window.axe.run());
    assert.deepEqual(violations.filter(({ impact }) => ['serious', 'critical'].includes(impact)).map(({ id, nodes }) => `${id}: ${nodes[0].html}`), []);
    if (values.screenshots) await page.screenshot({ path: join(values.screenshots, 'playground.png'), fullPage: true });
    await tab('Its file');
    const area = page.getByLabel('Text of the domain');
    const text = await area.inputValue();
    assert.match(text, /weights = \{ rubble = -5.5, recharge = 3.5, step = -1.0 \}/);
    await area.fill(text.replace('discount', 'discuont'));
    await reads(page.locator('.said').first(), /^domain.toml:11:1: error\[E0107\]: unknown key 'discuont'/);
    await tab('The first robot again');
    await tab('Take the lesson');
    await page.waitForSelector('main.stage-consent');
    assert.deepEqual(trouble, []);
    await context.close();
  });

  it('teaches teams of a report again', async () => {
    kith('study', 'paper', '--set', 'replicates=1', '-q', '-o', join(folder, 'run'));
    kith('report', join(folder, 'run'), '--run', '-q', '-o', join(folder, 'report.html'));
    const context = await browser.newContext({ offline: true });
    const page = await context.newPage();
    await page.goto(pathToFileURL(join(folder, 'report.html')).href);
    for (const name of ['Joint, NNP', 'Individual low, PPP']) {
      await page.locator('#team-choice').selectOption({ label: await page.locator('#team-choice option', { hasText: name }).first().textContent() });
      await page.getByRole('button', { name: 'Teach this team again' }).click();
      await page.getByText(/^Taught again: all \d+ lessons are those of the run/).waitFor({ timeout: 240_000 });
    }
    await page.locator('#team-choice').selectOption({ label: await page.locator('#team-choice option', { hasText: 'Baseline, NNP' }).first().textContent() });
    assert.equal(await page.getByRole('button', { name: 'Teach this team again' }).count(), 0);
    await context.close();
  });

  it('shows texts as texts, whatever is in them', async () => {
    const corpus = [
      '<img src=x onerror=window.hacked=1>',
      '</script><script>window.hacked=1</script>',
      '<svg/onload=window.hacked=1>',
      '<!--<script>',
      "javascript:window.hacked=1//';window.hacked=1;'",
      '{{constructor.constructor("window.hacked=1")()}}',
      '&lt;b&gt;\u2028<style>*{display:none}</style>',
    ];
    const evil = corpus.join(' ');
    const words = (n) => corpus[n % corpus.length].replaceAll('{', '(').replaceAll('}', ')');
    const robot = readFileSync(join(here, '../../domains/item_delivery.toml'), 'utf8')
      .replace(/title +=.*/, `title = ${JSON.stringify(evil)}\ngoal = ${JSON.stringify(words(0))}`)
      .replace(/\[words\][^]*/, `[words]\n${['rubble', 'recharge', 'step'].map((name, i) => `${name} = { one = ${JSON.stringify(words(i))}, many = ${JSON.stringify(`${words(i + 1)} {n}`)} }`).join('\n')}\n`);
    writeFileSync(join(folder, 'evil.toml'), robot);
    const set = (key, value) => ['--set', `${key}=${JSON.stringify(value)}`];
    const texts = JSON.stringify(corpus);
    const questions = `[{ id = "a", kind = "choice", text = ${JSON.stringify(evil)}, options = ${texts} }]`;
    const options = [...set('title', evil), ...set('group.title', evil), ...set('group.goal', evil)];
    options.push('--set', `group.story=${texts}`, '--set', `group.consent={ version = "1", text = ${texts} }`, '--set', `group.questions=${questions}`);
    kith('lesson', join(folder, 'evil.toml'), ...options, '--adaptive', '-o', join(folder, 'evil.html'));
    await withReader('evil.html', {}, async (reader) => {
      const look = async () => {
        const found = await reader.page.evaluate(() => ({ hacked: window.hacked ?? null, images: document.querySelectorAll('img, iframe, script[src]:not([src^="blob:"]), #page script, #page style').length }));
        assert.deepEqual(found, { hacked: null, images: 0 });
      };
      for (const stage of ['check', 'watch', 'predict', 'feedback', 'questions', 'debrief']) {
        await look();
        await reach([reader], [stage]);
        await reader.page.waitForSelector(`main.stage-${stage}`);
      }
      await look();
    });
  });

  it('forgets everything when told to', async () => {
    await withReader('delivery.html', {}, async (reader) => {
      await reach([reader], ['watch']);
      await reader.button('Start again').click();
      reader.view = null;
      await reader.button('Erase and start again').click();
      await until(() => reader.view?.stage === 'consent');
      assert.deepEqual((await reader.log()).events.filter(({ type }) => type === 'consented'), []);
    });
  });
});
