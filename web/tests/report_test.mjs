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
import { launch, openPage, openReport, requireFrom, violations } from './browser.mjs';

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
// `rules`: those of axe that a look may break; without, all of them.
const kLooks = [
  { name: 'light-1280', width: 1280, dark: false },
  { name: 'dark-1280', width: 1280, dark: true, rules: ['color-contrast'] },
  { name: 'light-320', width: 320, dark: false, rules: ['scrollable-region-focusable'] },
  { name: 'dark-320', width: 320, dark: true, rules: [] },
];
// The sample has all that a report can have, so that one of the program needs each theme and each width once.
const looks = kLooks.filter(({ width, dark }) => !values.kith || dark === (width === 320));

let browser;
// Drawing all charts takes seconds: a test goes on with the page that the one before has left.
const opened = new Map();

async function withReport(look, body) {
  const key = `${look.width} ${look.dark} ${look.reducedMotion ?? false}`;
  if (!opened.has(key)) opened.set(key, await openReport(browser, address, look));
  const report = opened.get(key);
  await body(report);
  assert.deepEqual(report.trouble, [], 'requests, console messages or uncaught errors');
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

// How a colour is seen: CIE L*a*b* of what is left of it (Machado, Oliveira and Fernandes 2009).
const kVision = {
  protanopia: [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]],
  deuteranopia: [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.01182, 0.04294, 0.968881]],
  tritanopia: [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.3039]],
};
function seenAs(hex, kind) {
  const channels = [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16) / 255);
  const linear = channels.map((c) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4));
  const rgb = kVision[kind]?.map((row) => Math.min(1, Math.max(0, row.reduce((sum, x, i) => sum + x * linear[i], 0)))) ?? linear;
  const toXyz = [[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]];
  const white = [0.9505, 1, 1.089];
  const [x, y, z] = toXyz
    .map((row, i) => row.reduce((sum, part, k) => sum + part * rgb[k], 0) / white[i])
    .map((t) => (t > 0.008856 ? Math.cbrt(t) : 7.787 * t + 16 / 116));
  return kind === 'grey' ? [116 * y - 16] : [116 * y - 16, 500 * (x - y), 200 * (y - z)];
}

async function saved(page, button) {
  const [download] = await Promise.all([page.waitForEvent('download'), button.click()]);
  return { name: download.suggestedFilename(), bytes: readFileSync(await download.path()) };
}

// In a suite, because Node.js 18 runs hooks only there, and for `it` alone.
describe('a report', () => {
  before(async () => (browser = await launch(values.modules, values.chromium)));
  after(async () => browser?.close());

  for (const look of looks) {
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
        // Drawings are hidden from assistive technology; thousands of marks would take axe a minute.
        assert.deepEqual(await violations(page, axeSource, { exclude: ['.drawing'], rules: look.rules }), []);
        await openDetails(page, { all: true });
        const { page: body, view } = await page.evaluate(() => ({
          page: document.documentElement.scrollWidth,
          view: document.documentElement.clientWidth,
        }));
        assert.ok(readFileSync(report).length <= 2_500_000, 'the page has more than 2.5 MB');
        assert.ok(body <= view, `the page is ${body} px wide in a window of ${view} px`);
      });
    });
  }

  const ofSample = values.kith ? it.skip : it; // it has every kind of figure
  ofSample('every figure saves for print as SVG, PNG and CSV, drawn in light whatever the theme is', async () => {
    await withReport({ width: 1280, dark: true }, async ({ page }) => {
      const figures = await page.$$('figure[id]');
      for (const figure of figures) {
        const id = await figure.getAttribute('id');
        const svg = await saved(page, await figure.$('[data-save=svg]'));
        assert.match(svg.name, /\.svg$/);
        const text = svg.bytes.toString('utf8');
        assert.match(text, /^<svg [^>]*xmlns/, id);
        const [, mm, , pixels] = /width="([\d.]+)mm" height="[\d.]+mm" viewBox="0 0 (([\d.]+) [\d.]+)"/.exec(text) ?? [];
        assert.ok(mm > 100 && mm <= 183.01, `${id} is ${mm} mm wide`);
        const points = [...text.matchAll(/font-size="([\d.]+)px"/g)].map(([, px]) => (px * mm * 72) / 25.4 / pixels);
        assert.ok(Math.min(...points) >= 7 && Math.max(...points) <= 8, `${id}: text of ${Math.min(...points)} to ${Math.max(...points)} pt`);
        assert.ok(!text.includes('var(--'), `${id} leaves colours to a page`);
        const png = await saved(page, await figure.$('[data-save=png]'));
        assert.match(png.name, /\.png$/);
        assert.deepEqual([...png.bytes.subarray(0, 4)], [0x89, 0x50, 0x4e, 0x47], id);
        assert.equal(png.bytes.readUInt32BE(png.bytes.indexOf('pHYs') + 4), 11811, `${id} has 300 dpi`);
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
      const captions = await page.$$eval('figure[id] figcaption', (all) => all.map((caption) => caption.textContent));
      captions.forEach((caption, i) => assert.ok(caption.startsWith(`Figure ${i + 1}. `), caption));
      const ids = await page.$$eval('[id]', (all) => all.map(({ id }) => id));
      assert.deepEqual(ids.filter((id, i) => ids.indexOf(id) !== i), [], 'ids that occur twice');
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

  it('the finding comes first, then figures, then tests, and every table has rows under words', async () => {
    await withReport({ width: 1280, dark: false }, async ({ page }) => {
      assert.match(await page.textContent('h1'), /^[A-Z].{30,200}[.]$/);
      const answers = await page.$$eval('.answers tbody tr:not(.group)', (rows) => rows.map((row) => row.textContent));
      assert.ok(answers.some((text) => /any two differ by less than \d/.test(text)), 'a bound where nothing was found');
      assert.ok((await page.$$('.limits li')).length >= 2, 'what the study cannot say');
      for (const link of await page.$$eval('.answers a, .tests a', (all) => all.map(({ hash }) => hash))) {
        assert.ok(await page.$(link), `${link} is a test`);
      }
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
          heads.every((head) => /^(F|t|d|n|p|df|N|sd|95 % (low|high)|[A-Za-z].{2,})$/.test(head) && !/, (low|high)$/.test(head)),
          `${caption}: ${heads.join(' | ')}`,
        );
      }
      const tests = await page.$$eval('#findings tbody tr:not(.group)', (rows) =>
        rows.map((row) => [...row.children].map((cell) => cell.textContent)),
      );
      assert.ok(tests.length > 0);
      assert.ok(!tests.flat().some((cell) => /undefined|NaN|\[object/.test(cell)), 'a cell that is no value');
    });
  });

  ofSample('strategies stay apart in grey and for all kinds of colour vision, in both themes', async () => {
    for (const dark of [false, true]) {
      await withReport({ width: 320, dark }, async ({ page }) => {
        const colors = await page.evaluate(() =>
          [0, 1, 2, 3, 4].map((i) => getComputedStyle(document.documentElement).getPropertyValue(`--t${i}`)),
        );
        for (const [kind, least] of [['grey', 10], ['protanopia', 20], ['deuteranopia', 20], ['tritanopia', 20], ['all', 20]]) {
          const seen = colors.map((hex) => seenAs(hex, kind));
          const apart = seen.flatMap((a, i) => seen.slice(i + 1).map((b) => Math.hypot(...a.map((x, k) => x - b[k]))));
          assert.ok(Math.min(...apart) >= least, `${kind}: ${colors.join(' ')} are ${Math.min(...apart)} apart`);
        }
      });
    }
  });

  // The colour of a cell is mixed with the ground; the contrast is WCAG's.
  it('values of a heat map can be read on every colour', async () => {
    for (const dark of [false, true]) {
      await withReport({ width: 1280, dark }, async ({ page }) => {
        if (!(await page.$('#figure-matrix-1'))) return;
        const { cells, text, ground, values: shown, best } = await page.evaluate(() => {
          const figure = document.querySelector('#figure-matrix-1');
          const styles = [...figure.querySelectorAll('.mark-rect path')].map((path) => getComputedStyle(path));
          figure.querySelector('details').open = true;
          return {
            cells: styles.filter(({ fill }) => fill !== 'none').map(({ fill, fillOpacity }) => ({ fill, opacity: Number(fillOpacity) })),
            text: getComputedStyle(figure.querySelector('.mark-text.role-mark text')).fill,
            ground: getComputedStyle(document.body).backgroundColor,
            values: figure.querySelectorAll('svg .mark-text text').length,
            best: figure.querySelector('.chart').getAttribute('aria-label'),
          };
        });
        const channels = (color) => color.match(/[\d.]+/g).slice(0, 3).map((part) => Number(part) / 255);
        const light = (rgb) =>
          rgb.map((c) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4)).reduce((sum, c, i) => sum + c * [0.2126, 0.7152, 0.0722][i], 0);
        assert.ok(cells.length >= 18 && new Set(cells.map(({ opacity }) => opacity)).size > 4, `${cells.length} cells`);
        for (const { fill, opacity } of cells) {
          const under = channels(ground);
          const mixed = channels(fill).map((c, i) => opacity * c + (1 - opacity) * under[i]);
          const [high, low] = [light(channels(text)), light(mixed)].sort((a, b) => b - a);
          assert.ok((high + 0.05) / (low + 0.05) >= 4.5, `${text} on ${fill} at ${opacity}`);
        }
        assert.ok(shown > cells.length, 'a value in every cell');
        assert.match(best, /best in each row: bayesian: common 0[.]030; /);
      });
    }
  });

  it('a dot of a figure, and the list, open a team with its boards and answers', async () => {
    await withReport({ width: 1280, dark: false }, async ({ page }) => {
      const title = () => page.textContent('#team h3');
      const before = await title();
      await page.click('#figure-periods svg path[opacity="0.38"] >> nth=-1');
      assert.notEqual(await title(), before);
      assert.match(await title(), /^Team \d+: .+, [NP]+, replicate \d+$/);
      assert.equal(await page.evaluate(() => document.activeElement.id), 'team-choice');
      assert.ok((await page.$$('#team .thumb svg')).length > 1, 'boards');
      assert.match(await page.textContent('#team .ticks'), /member \d .*: (right|wrong)/);
      assert.match(await page.textContent('#team .smalls'), /(costs|is worth) /);
      const opened = await title();
      await page.click('#team button[aria-label="Next team"]');
      assert.notEqual(await title(), opened);
    });
  });

  it('belief spheres follow the slider, the arrow keys and the choice of team', async () => {
    await withReport({ width: 1280, dark: false, reducedMotion: true }, async ({ page }) => {
      if (!(await page.$('#figure-beliefs'))) return;
      const label = () => page.getAttribute('#sphere-period', 'aria-valuetext');
      const path = () => page.$eval('#figure-beliefs .globes svg', (svg) => svg.innerHTML);
      assert.match(await label(), /after period (\d+) of \1/);
      const first = await path();
      await page.focus('#sphere-period');
      await page.keyboard.press('Home');
      assert.match(await label(), /before teaching/);
      await page.waitForFunction((before) => document.querySelector('#figure-beliefs .globes svg').innerHTML !== before, first);
      const second = await path();
      await page.focus('#figure-beliefs .globes');
      await page.keyboard.press('ArrowRight');
      await page.waitForFunction(
        (before) => document.querySelector('#figure-beliefs .globes svg').innerHTML !== before,
        second,
      );
      const third = await path();
      await page.focus('#figure-beliefs .turners input >> nth=2');
      await page.keyboard.press('ArrowRight');
      await page.waitForFunction((before) => document.querySelector('#figure-beliefs .globes svg').innerHTML !== before, third);
      assert.equal(
        await page.locator('#figure-beliefs button', { hasText: 'Play' }).count(),
        0,
        'no motion for who asks for less',
      );
      await page.selectOption('#sphere-team', { index: (await page.$$('#sphere-team option')).length - 1 });
      assert.match(await label(), /after period (\d+) of \1/);
    });
  });

  it('an audit says who needs what first, in words, and fits a phone', async () => {
    if (!values.kith) return;
    const audit = join(folder, 'audit.html');
    execFileSync(values.kith, ['audit', '-q', join(folder, 'run'), '-o', audit], { stdio: 'inherit' });
    for (const look of [{ width: 1280, dark: true }, { width: 320, dark: false }]) {
      const { context, page, trouble } = await openPage(browser, pathToFileURL(audit).href, look);
      const people = await page.$$eval('.person', (all) => all.map((one) => [...one.querySelectorAll('.verdict')].map((verdict) => verdict.textContent)));
      assert.ok(people.length > 10 && people.every((verdicts) => verdicts.length === 3), `${people.length} people`);
      const worst = people.map((verdicts) => verdicts.includes('has a misconception'));
      assert.deepEqual(worst, [...worst].sort((a, b) => Number(b) - Number(a)), 'those who need something first are on top');
      assert.match(await page.textContent('.first'), /^Show that .+[.] Probably thinks that .+[.]$/);
      assert.ok(await page.$('.evidence svg .way.own'), 'the robot\u2019s path on the board to show');
      assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= document.documentElement.clientWidth));
      assert.deepEqual(await violations(page, axeSource, { exclude: ['.board'] }), []);
      assert.deepEqual(trouble, []);
      await context.close();
    }
  });

  // The last one, as it leaves the page in another theme.
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
});
