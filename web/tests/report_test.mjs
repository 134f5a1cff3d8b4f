// Opens a report as a reader would and checks what a reader needs.
//
//   node tests/report_test.mjs REPORT.html [--document FILE] [--screenshots DIR] [--modules DIR] [--chromium FILE]
//   node tests/report_test.mjs --kith PROGRAM [...]
//
// With --document, REPORT.html is the template, and the document is put into a copy of it. With --kith, the page is the
// report that this program makes of a small run of the paper's study.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdirSync, mkdtempSync, readFileSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { dirname, join, resolve } from 'node:path';
import { after, before, describe, it } from 'node:test';
import { fileURLToPath, pathToFileURL } from 'node:url';
import { parseArgs } from 'node:util';
import { fillPage } from '../sample/fill_page.mjs';
import { launch, openReport, requireFrom } from './browser.mjs';

const here = dirname(fileURLToPath(import.meta.url));
const { values, positionals } = parseArgs({
  allowPositionals: true,
  options: {
    document: { type: 'string' },
    kith: { type: 'string' },
    screenshots: { type: 'string' },
    modules: { type: 'string', default: join(here, '..') },
    chromium: { type: 'string', default: '/usr/bin/chromium' },
  },
});
if (positionals.length !== (values.kith ? 0 : 1)) {
  console.error(
    'usage: node tests/report_test.mjs REPORT.html|--kith PROGRAM [--document FILE] [--screenshots DIR] [--modules DIR] [--chromium FILE]',
  );
  process.exit(2);
}
const folder = mkdtempSync(join(tmpdir(), 'kith-report-'));
let report = resolve(positionals[0] ?? join(folder, 'run', 'report.html'));
if (values.kith) {
  const run = join(folder, 'run');
  execFileSync(values.kith, ['study', 'paper', '--set', 'replicates=2', '-q', '-o', run], { stdio: 'inherit' });
  execFileSync(values.kith, ['report', '-q', run], { stdio: 'inherit' });
}
if (values.document) {
  const filled = join(folder, 'report.html');
  writeFileSync(filled, fillPage(readFileSync(report, 'utf8'), readFileSync(values.document, 'utf8')));
  report = filled;
}
const address = pathToFileURL(report).href;
const axeSource = readFileSync(requireFrom(values.modules).resolve('axe-core/axe.min.js'), 'utf8');
const kLooks = [
  { name: 'light-1280', width: 1280, dark: false },
  { name: 'dark-1280', width: 1280, dark: true },
  { name: 'light-320', width: 320, dark: false },
  { name: 'dark-320', width: 320, dark: true },
];

let browser;

async function withReport(look, body) {
  const report = await openReport(browser, address, look);
  try {
    await body(report);
    assert.deepEqual(report.trouble, [], 'requests, console messages or uncaught errors');
  } finally {
    await report.context.close();
  }
}

// What is in details is made when they open. axe needs long for many tables, and those of figures are
// all made alike, so it sees one of them.
async function openDetails(page, { all }) {
  await page.evaluate((every) => {
    const later = document.querySelectorAll('figure ~ figure details, section ~ section figure details');
    const skipped = new Set(every ? [] : later);
    for (const box of document.querySelectorAll('details')) box.open = box.open || !skipped.has(box);
  }, all);
  await page.waitForTimeout(100);
}

async function violations(page) {
  // From the debugger, so that the page's policy stays as it is.
  await page.evaluate(axeSource);
  // Drawings are hidden from assistive technology, their text alternative is around them; thousands
  // of marks would take axe a minute.
  const { violations: found } = await page.evaluate(() =>
    axe.run({ exclude: ['.drawing'] }, { resultTypes: ['violations'] }),
  );
  return found
    .filter(({ impact }) => impact === 'serious' || impact === 'critical')
    .map(
      ({ id, nodes }) =>
        `${id}: ${nodes
          .slice(0, 3)
          .map(({ html }) => html.slice(0, 160))
          .join(' | ')}`,
    );
}

async function saved(page, button) {
  const [download] = await Promise.all([page.waitForEvent('download'), button.click()]);
  return { name: download.suggestedFilename(), bytes: readFileSync(await download.path()) };
}

// In a suite, because Node.js 18 runs hooks only there, and for `it` alone.
describe('a report', () => {
  before(async () => (browser = await launch(values.modules, values.chromium)));
  after(async () => browser?.close());

  for (const look of kLooks) {
    it(`a reader at ${look.name} sees every chart, no overflow and no serious axe violation`, async () => {
      await withReport(look, async ({ page }) => {
        const charts = await page.$$eval('figure .drawing svg', (all) =>
          all.map((svg) => svg.querySelectorAll('path, text').length),
        );
        assert.ok(charts.length > 0 && charts.every((marks) => marks > 10), `charts with marks: ${charts}`);
        if (values.screenshots) {
          mkdirSync(values.screenshots, { recursive: true });
          await page.screenshot({ path: join(values.screenshots, `${look.name}.png`), fullPage: true });
        }
        await openDetails(page, { all: false });
        assert.deepEqual(await violations(page), []);
        await openDetails(page, { all: true });
        const { page: body, view } = await page.evaluate(() => ({
          page: document.documentElement.scrollWidth,
          view: document.documentElement.clientWidth,
        }));
        assert.ok(body <= view, `the page is ${body} px wide in a window of ${view} px`);
      });
    });
  }

  it('every figure saves as SVG, PNG and CSV, drawn in light whatever the theme is', async () => {
    await withReport({ width: 1280, dark: true }, async ({ page }) => {
      const figures = await page.$$('figure');
      for (const figure of figures) {
        const id = await figure.getAttribute('id');
        const svg = await saved(page, await figure.$('[data-save=svg]'));
        assert.match(svg.name, /\.svg$/);
        const text = svg.bytes.toString('utf8');
        assert.match(text, /^<svg [^>]*xmlns/, id);
        assert.ok(!text.includes('var(--'), `${id} leaves colours to a page`);
        const png = await saved(page, await figure.$('[data-save=png]'));
        assert.match(png.name, /\.png$/);
        assert.deepEqual([...png.bytes.subarray(0, 4)], [0x89, 0x50, 0x4e, 0x47], id);
        const csv = await saved(page, await figure.$('[data-save=csv]'));
        assert.match(csv.name, /\.csv$/);
        const lines = csv.bytes.toString('utf8').trimEnd().split('\n');
        assert.ok(lines.length > 1 && lines.every((line) => line.includes(',')), `${id}: ${lines[0]}`);
        if (values.screenshots) {
          writeFileSync(join(values.screenshots, png.name), png.bytes);
          writeFileSync(join(values.screenshots, svg.name), svg.bytes);
        }
      }
    });
  });

  it('headings are in order, figures are numbered and every link of the contents leads somewhere', async () => {
    await withReport({ width: 1280, dark: false }, async ({ page }) => {
      const levels = await page.$$eval('h1, h2, h3, h4', (all) => all.map((heading) => Number(heading.tagName[1])));
      assert.equal(levels.filter((level) => level === 1).length, 1);
      levels.forEach((level, i) => assert.ok(i === 0 || level <= levels[i - 1] + 1, `heading ${i} skips a level`));
      const captions = await page.$$eval('figcaption', (all) => all.map((caption) => caption.textContent));
      captions.forEach((caption, i) => assert.ok(caption.startsWith(`Figure ${i + 1}. `), caption));
      const lost = await page.$$eval('nav a', (all) =>
        all.map((a) => a.getAttribute('href')).filter((href) => !document.querySelector(href)),
      );
      assert.deepEqual(lost, []);
      const names = await page.$$eval('.chart', (all) => all.map((chart) => chart.getAttribute('aria-label') ?? ''));
      assert.ok(
        names.every((name) => name.length > 20),
        'a chart without a text alternative',
      );
    });
  });

  it('plain sentences come first, then figures, then tests, and every table has rows under words', async () => {
    await withReport({ width: 1280, dark: false }, async ({ page }) => {
      const sentences = await page.$$eval('#summary .lead', (all) => all.map((one) => one.textContent));
      assert.equal(sentences.length, 3);
      for (const sentence of sentences) assert.match(sentence, /^[A-Z].{30,400}[.]$/);
      const order = await page.$$eval('main section', (all) => all.map(({ id }) => id));
      assert.equal(order[0], 'summary');
      assert.ok(order.indexOf('outcomes') < order.indexOf('findings'), order.join(' '));
      await openDetails(page, { all: true });
      const tables = await page.$$eval('main table', (all) =>
        all.map((table) => ({
          caption: table.caption?.textContent ?? '',
          heads: [...table.querySelectorAll('thead th')].map((head) => head.textContent),
          rows: table.querySelectorAll('tbody tr').length,
        })),
      );
      for (const { caption, heads, rows } of tables) {
        assert.ok(rows > 0, `no rows: ${caption}`);
        assert.ok(
          heads.every((head) => /^(F|t|d|n|df|N|sd|95 % (low|high)|[A-Za-z].{2,})$/.test(head) && !/, (low|high)$/.test(head)),
          `${caption}: ${heads.join(' | ')}`,
        );
      }
      const tests = await page.$$eval('#findings tbody tr', (rows) =>
        rows.map((row) => [...row.children].map((cell) => cell.textContent)),
      );
      assert.ok(tests.length > 0);
      assert.ok(!tests.flat().some((cell) => /undefined|NaN|\[object/.test(cell)), 'a cell that is no value');
    });
  });

  it('the theme button changes the theme, and paper is light', async () => {
    await withReport({ width: 1280, dark: false }, async ({ page }) => {
      const ground = () => page.evaluate(() => getComputedStyle(document.body).backgroundColor);
      const light = await ground();
      await page.click('.theme-toggle');
      assert.notEqual(await ground(), light);
      await page.emulateMedia({ media: 'print' });
      assert.equal(await ground(), light);
      assert.equal(await page.isVisible('.theme-toggle'), false);
      if (values.screenshots)
        await page.pdf({ path: join(values.screenshots, 'print.pdf'), format: 'A4', printBackground: true });
    });
  });

  it('belief spheres follow the slider, the arrow keys and the choice of team', async () => {
    await withReport({ width: 1280, dark: false, reducedMotion: true }, async ({ page }) => {
      if (!(await page.$('#figure-beliefs'))) return;
      const label = () => page.getAttribute('#figure-beliefs .chart', 'aria-label');
      const path = () => page.$eval('#figure-beliefs svg', (svg) => svg.innerHTML);
      assert.match(await label(), /before teaching/);
      const first = await path();
      await page.focus('#sphere-period');
      await page.keyboard.press('ArrowRight');
      assert.match(await label(), /after period 1/);
      await page.waitForFunction((before) => document.querySelector('#figure-beliefs svg').innerHTML !== before, first);
      const second = await path();
      await page.focus('#sphere-turn');
      await page.keyboard.press('ArrowRight');
      await page.waitForFunction(
        (before) => document.querySelector('#figure-beliefs svg').innerHTML !== before,
        second,
      );
      const third = await path();
      await page.focus('#sphere-zoom');
      await page.keyboard.press('ArrowRight');
      await page.waitForFunction((before) => document.querySelector('#figure-beliefs svg').innerHTML !== before, third);
      assert.equal(
        await page.locator('#figure-beliefs button', { hasText: 'Play' }).count(),
        0,
        'no motion for who asks for less',
      );
      await page.selectOption('#sphere-team', { index: (await page.$$('#sphere-team option')).length - 1 });
      assert.match(await label(), /before teaching/);
    });
  });
});
