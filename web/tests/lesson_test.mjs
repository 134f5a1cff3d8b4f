// Opens a lesson as a reader would and checks what a reader needs.
//
//   node tests/lesson_test.mjs TEMPLATE.html --document FILE [--screenshots DIR] [--modules DIR] [--chromium FILE]
import assert from 'node:assert/strict';
import { mkdirSync, mkdtempSync, readFileSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { dirname, join, resolve } from 'node:path';
import { after, before, describe, it } from 'node:test';
import { fileURLToPath, pathToFileURL } from 'node:url';
import { parseArgs } from 'node:util';
import { fillPage } from '../sample/fill_page.mjs';
import { launch, openPage, reads, requireFrom } from './browser.mjs';
import { drawn, endless, hugeLesson, largeLesson, mapless, uncertain } from './lessons.mjs';

const here = dirname(fileURLToPath(import.meta.url));
const { values, positionals } = parseArgs({
  allowPositionals: true,
  options: {
    document: { type: 'string' },
    screenshots: { type: 'string' },
    modules: { type: 'string', default: join(here, '..') },
    chromium: { type: 'string', default: '/usr/bin/chromium' },
  },
});
if (positionals.length !== 1 || !values.document) {
  console.error(
    'usage: node tests/lesson_test.mjs TEMPLATE.html --document FILE [--screenshots DIR] [--modules DIR] [--chromium FILE]',
  );
  process.exit(2);
}
const template = readFileSync(resolve(positionals[0]), 'utf8');
const folder = mkdtempSync(join(tmpdir(), 'kith-lesson-'));
const sample = JSON.parse(readFileSync(values.document, 'utf8'));
const axeSource = readFileSync(requireFrom(values.modules).resolve('axe-core/axe.min.js'), 'utf8');

function addressOf(name, lesson) {
  const file = join(folder, `${name}.html`);
  writeFileSync(file, fillPage(template, JSON.stringify(lesson)));
  return pathToFileURL(file).href;
}
const pages = {
  sample: addressOf('sample', sample),
  large: addressOf('large', largeLesson()),
  huge: addressOf('huge', hugeLesson()),
  mapless: addressOf('mapless', mapless()),
  uncertain: addressOf('uncertain', uncertain()),
  drawn: addressOf('drawn', drawn()),
  endless: addressOf('endless', endless(sample)),
};

let browser;

async function withLesson(name, look, body) {
  const lesson = await openPage(browser, pages[name], look);
  try {
    await body(lesson.page);
    assert.deepEqual(lesson.trouble, [], 'requests, console messages or uncaught errors');
  } finally {
    await lesson.context.close();
  }
}

async function violations(page) {
  await page.evaluate(axeSource); // from the debugger, so that the page's policy stays as it is
  const { violations: found } = await page.evaluate(() => axe.run(document, { resultTypes: ['violations'] }));
  return found
    .filter(({ impact }) => impact === 'serious' || impact === 'critical')
    .map(({ id, nodes }) => `${id}: ${nodes.slice(0, 3).map(({ html }) => html.slice(0, 160))}`);
}

const robotOf = (page) =>
  page.$eval('.demonstration .mover:not(.ghost)', (mover) => mover.style.transform.match(/[\d.]+/g).map(Number));

describe('a lesson', () => {
  before(async () => (browser = await launch(values.modules, values.chromium)));
  after(async () => browser?.close());

  for (const name of Object.keys(pages)) {
    for (const [width, dark] of [
      [1280, false],
      [768, true],
      [320, false],
    ]) {
      it(`of ${name} at ${width} px ${dark ? 'dark' : 'light'}: no overflow, no serious axe violation`, async () => {
        await withLesson(name, { width, dark }, async (page) => {
          if (values.screenshots) {
            mkdirSync(values.screenshots, { recursive: true });
            await page.screenshot({ path: join(values.screenshots, `${name}-${width}-closed.png`), fullPage: true });
          }
          await page.evaluate(() => document.querySelectorAll('.test details, .why, .watch').forEach((box) => (box.open = true)));
          await page.waitForSelector('.test .answer');
          await page.waitForSelector('.why .reason');
          if (values.screenshots) {
            await page.screenshot({ path: join(values.screenshots, `${name}-${width}.png`), fullPage: true });
          }
          assert.deepEqual(await violations(page), []);
          await page.evaluate(() => document.querySelectorAll('details').forEach((box) => (box.open = true)));
          const { body, view } = await page.evaluate(() => ({
            body: document.documentElement.scrollWidth,
            view: document.documentElement.clientWidth,
          }));
          assert.ok(body <= view, `the page is ${body} px wide in a window of ${view} px`);
          const ids = await page.$$eval('[id]', (all) => all.map(({ id }) => id));
          assert.deepEqual(ids.filter((id, i) => ids.indexOf(id) !== i), [], 'ids that more than one element has');
          const signs = await page.$$eval('.legend li svg', (all) =>
            all.map((svg) => {
              const id = /url\(#([^)]+)\)/.exec(svg.innerHTML)?.[1];
              return svg.innerHTML.replace(/url\([^)]+\)/, '') + (id ? document.getElementById(id).innerHTML : '');
            }),
          );
          assert.equal(new Set(signs).size, signs.length, 'two things of the legend are drawn alike');
        });
      });
    }
  }

  it('shows every component, demonstration and test, and says every board in words', async () => {
    await withLesson('sample', { width: 1280, dark: false }, async (page) => {
      const count = (selector) => page.$$eval(selector, (all) => all.length);
      const sum = (key) => sample.components.reduce((n, component) => n + component[key].length, 0);
      assert.equal(await count('section[id^=component-]'), sample.components.length);
      assert.equal(await count('.demonstration'), sum('demonstrations'));
      assert.equal(await count('.test'), sum('tests'));
      const labels = await page.$$eval('.board svg', (all) => all.map((svg) => svg.getAttribute('aria-label') ?? ''));
      assert.ok(labels.length > 0 && labels.every((label) => label.length > 40), `labels: ${labels}`);
      const reason = sample.components[0].demonstrations[0].reason;
      assert.equal(await page.locator('.reason').count(), 0);
      await page.click('.why summary');
      await page.waitForSelector('.reason');
      assert.equal((await page.textContent('.why summary')).trim(), 'Hide the reason');
      assert.match((await page.textContent('.reason')).toLowerCase(), new RegExp(reason.slice(3, 30)));
      const levels = await page.$$eval('h1, h2, h3, h4', (all) => all.map((heading) => Number(heading.tagName[1])));
      levels.forEach((level, i) => assert.ok(i === 0 || level <= levels[i - 1] + 1, `heading ${i} skips a level`));
      const lost = await page.$$eval('nav a', (all) =>
        all.map((a) => a.getAttribute('href')).filter((href) => !document.querySelector(href)),
      );
      assert.deepEqual(lost, []);
    });
  });

  it('shows a path that never ends as its way in and its cycle, twice, and says so', async () => {
    await withLesson('endless', { width: 1280, dark: false, reducedMotion: true }, async (page) => {
      const scene = page.locator('.demonstration').first();
      const said = () => scene.locator('.player .step').first().textContent();
      const next = scene.getByRole('button', { name: 'Next step' }).first();
      const points = async () => (await scene.locator('.way.own .line').first().getAttribute('points')).split(' ').length;
      for (let step = 1; step <= 3; step += 1) await next.click();
      assert.match(await said(), /^Step 3 of 5: it goes /, 'one step on the way in, two rounds of two');
      assert.equal(await scene.locator('.way.own .round').count(), 1);
      const once = await points();
      for (let step = 4; step <= 5; step += 1) await next.click();
      assert.match(await said(), / And so on: it never delivers the parcel\.$/);
      assert.equal(await points(), once, 'the cycle is drawn once');
      assert.match(await scene.locator('.board svg').first().getAttribute('aria-label'), /; then again and again: /);
      await page.evaluate(() => document.querySelectorAll('details').forEach((box) => (box.open = true)));
      assert.match(await scene.locator('.in-words').first().textContent(), /And so on: it never delivers the parcel\./);
    });
  });

  it('gives nothing away before the robot moves, and uses no terms of ours', async () => {
    await withLesson('sample', { width: 1280, dark: false }, async (page) => {
      const visible = await page.evaluate(() => document.body.innerText);
      for (const component of sample.components) {
        const told = [component.name, ...component.sentences.map(({ text }) => text)];
        for (const { reason, flip } of component.demonstrations) told.push(reason, ...(flip ? [flip.text] : []));
        for (const text of told) assert.ok(!visible.toLowerCase().includes(text.toLowerCase()), text);
      }
      assert.doesNotMatch(visible, /it (goes|picks|puts|leaves)/);
      assert.ok(!visible.includes(sample.domain.title) && !(await page.title()).includes(sample.domain.title));
      await page.evaluate(() => document.querySelectorAll('.test details, .why').forEach((box) => (box.open = true)));
      await page.waitForSelector('.why .reason');
      const opened = await page.evaluate(() => document.body.innerText);
      assert.doesNotMatch(opened, /\(\d+,\d+\)|\bworld \d|\bMDP\b|half-space|not been taught/i);
      assert.match(opened, /From this you can conclude:|Before this lesson, about/);
    });
  });

  it('draws the path only as far as the robot has gone', async () => {
    await withLesson('sample', { width: 1280, dark: false }, async (page) => {
      const drawn = () =>
        page.$$eval('.demonstration .way.own .line', (all) => all.slice(0, 1).map((line) => line.getAttribute('points').split(' ').length));
      assert.deepEqual(await drawn(), []);
      const step = '.demonstration button[aria-label="Next step"]';
      const lengths = [];
      for (let i = 0; i < sample.components[0].demonstrations[0].frames.length - 1; i += 1) {
        await page.click(step);
        lengths.push((await drawn())[0] ?? 0);
      }
      assert.ok(lengths.every((n, i) => i === 0 || n >= lengths[i - 1]) && lengths[0] < lengths[lengths.length - 1], `${lengths}`);
    });
  });

  it('plays, pauses and steps, by keyboard alone', async () => {
    await withLesson('sample', { width: 1280, dark: false }, async (page) => {
      const { frames } = sample.components[0].demonstrations[0];
      const step = page.locator('.demonstration .step').first();
      const play = page.locator('.demonstration .play').first();
      const first = await robotOf(page);
      await page.focus('.demonstration .play');
      await page.keyboard.press('Enter');
      await reads(play, /^Pause$/);
      await page.waitForFunction(() => document.querySelector('.demonstration .step').textContent.startsWith('Step 2'));
      await page.keyboard.press('Enter');
      await reads(play, /^Play$/);
      await page.focus('.demonstration input[type=range]');
      await page.keyboard.press('End');
      await reads(step, /The end\.$/);
      await page.keyboard.press('Home');
      assert.deepEqual(await robotOf(page), first);
      await page.keyboard.press('ArrowRight');
      await reads(step, new RegExp(`^Step 1 of ${frames.length - 1}`));
    });
  });

  it('has nothing that moves for who asks for less motion', async () => {
    await withLesson('sample', { width: 1280, dark: false, reducedMotion: true }, async (page) => {
      assert.equal(await page.locator('.play').count(), 0);
      await page.click('.demonstration button[aria-label="Next step"]');
      await reads(page.locator('.demonstration .step').first(), /^Step 1/);
      const duration = await page.$eval('.mover', (mover) => getComputedStyle(mover).transitionDuration);
      assert.equal(duration, '0s');
    });
  });

  it('keeps the answers of tests to itself until they are asked for', async () => {
    await withLesson('sample', { width: 1280, dark: false }, async (page) => {
      assert.equal(await page.locator('.test .way').count(), 0);
      await page.click('.test summary');
      await page.waitForSelector('.test .answer');
      assert.equal((await page.textContent('.test summary')).trim(), 'Hide the answer');
      assert.equal(await page.locator('.test .answer .way').count(), 0, 'drawn before it is walked');
      await page.click('.test .answer button[aria-label="Next step"]');
      await page.waitForSelector('.test .answer .way');
      assert.ok((await page.textContent('.test .answer .sentences')).length > 10);
    });
  });

  it('lists states and actions where there is no map', async () => {
    await withLesson('mapless', { width: 1280, dark: false }, async (page) => {
      assert.equal(await page.locator('.board').count(), 0);
      const example = page.locator('.demonstration').first();
      await reads(example, /This world: weekday\..*The robot starts here: dock\./s);
      assert.equal(await page.locator('.steps').count(), 0, 'listed before the reader has decided');
      await example.getByText('Show what the robot does').click();
      await page.waitForSelector('.steps');
      await page.click('.why summary');
      await reads(page.locator('.steps .parting').first(), /dock: wait.*here they separate/);
    });
  });

  it('enlarges small cells, and shows the part of the map around the robot', async () => {
    await withLesson('huge', { width: 390, dark: false, reducedMotion: true }, async (page) => {
      const shown = page.locator('.demonstration');
      const look = () =>
        shown.evaluate((card) => {
          const box = (selector) => card.querySelector(selector).getBoundingClientRect();
          const [pan, svg, robot, seen] = [box('.pan'), box('.pan svg'), box('.mover'), card.querySelector('.overview .seen')];
          return {
            cell: svg.width / 60,
            isRobotInside: robot.left >= pan.left && robot.right <= pan.right && robot.top >= pan.top && robot.bottom <= pan.bottom,
            left: card.querySelector('.pan').scrollLeft,
            seen: Number(seen.getAttribute('x')),
          };
        });
      const first = await look();
      assert.ok(first.cell >= 16, `cells of ${first.cell} px`);
      assert.ok(first.isRobotInside);
      for (let step = 1; step < 50; step += 1) {
        await shown.locator('button[aria-label="Next step"]').click();
        assert.ok((await look()).isRobotInside, `step ${step}`);
      }
      const last = await look();
      assert.ok(last.left > first.left && last.seen > first.seen);
      await shown.locator('.pan').focus();
      await page.keyboard.press('ArrowLeft');
      await page.waitForFunction((left) => document.querySelector('.demonstration .pan').scrollLeft < left, last.left);
      const { x, y } = await shown.locator('.pan').boundingBox();
      const before = (await look()).left;
      await page.mouse.move(x + 100, y + 100);
      await page.mouse.down();
      await page.mouse.move(x + 200, y + 100, { steps: 4 });
      await page.mouse.up();
      await page.waitForFunction((left) => document.querySelector('.demonstration .pan').scrollLeft <= left - 80, before);
      await shown.locator('.overview').click({ position: { x: 4, y: 4 } });
      await page.waitForFunction(() => document.querySelector('.demonstration .pan').scrollLeft === 0);
      await page.emulateMedia({ media: 'print' });
      const printed = await shown.evaluate((card) => ({
        svg: card.querySelector('.pan svg').getBoundingClientRect().width,
        card: card.getBoundingClientRect().width,
        bar: getComputedStyle(card.querySelector('.pan-bar')).display,
      }));
      assert.ok(printed.svg <= printed.card && printed.bar === 'none', 'all of the map is printed');
      await page.emulateMedia({ media: 'screen' });
      await shown.getByRole('button', { name: 'Show the whole map' }).click();
      assert.equal(await shown.locator('.pan.enlarged').count(), 0);
      await shown.getByRole('button', { name: 'Enlarge the map' }).click();
      assert.equal(await shown.locator('.pan.enlarged').count(), 1);
    });
  });

  it('shows all of a map where its cells are large enough', async () => {
    for (const [name, width] of [['sample', 320], ['large', 768], ['huge', 1280]]) {
      await withLesson(name, { width, dark: false }, async (page) => {
        assert.equal(await page.locator('.pan.enlarged, .pan-bar').count(), 0, `${name} at ${width} px`);
      });
    }
  });

  it('shows several runs where chance has a part, and the most likely path only with the reason', async () => {
    await withLesson('uncertain', { width: 1280, dark: false }, async (page) => {
      const shown = page.locator('.demonstration').first();
      assert.equal(await shown.locator('.runs').count(), 0, 'run before the reader has decided');
      await shown.getByText('Show what the robot does').click();
      await page.waitForSelector('.runs');
      await reads(shown, /What will the robot do\?.*2 runs of the robot, just as they happened/s);
      assert.doesNotMatch(await shown.textContent(), /most likely path/i);
      await reads(shown.locator('.runs'), /Run 1 of 2.*the end.*the most common path in 1\./s);
      await shown.getByRole('button', { name: 'Next run' }).click();
      await reads(shown.locator('.runs'), /Run 2 of 2.*and so on/s);
      await page.click('.why summary');
      await shown.getByText('The most likely path').first().waitFor(); // drawn after the click has been handled
      const test = page.locator('.test').first();
      await reads(test, /here and wherever it may end up/);
      await test.locator('summary').click();
      await reads(test, /Run 1 of 2/);
      assert.doesNotMatch(await test.textContent(), /A correct answer shows/);
      assert.deepEqual(await violations(page), []);
    });
  });

  it('draws walls and what states place, and says where the robot slips', async () => {
    await withLesson('drawn', { width: 390, dark: true }, async (page) => {
      const shown = page.locator('.demonstration').first();
      await reads(shown, /This world: wet ice\./);
      assert.equal(await shown.locator('.board .destination').count(), 1);
      assert.equal(await shown.locator('.board .fence').getAttribute('d'), 'M80 0v40');
      assert.equal(await shown.locator('.runs').count(), 0, 'run before the reader has decided');
      await shown.getByText('Show what the robot does').click();
      const next = shown.locator('.runs').getByRole('button', { name: 'Next step' });
      await next.click();
      await reads(shown.locator('.runs'), /Step 1 of 4: it tries to go right but slips up\./);
      assert.equal(await shown.locator('.runs .tried').count(), 1, 'where it tried to go is drawn');
      await next.click();
      await reads(shown.locator('.runs'), /Step 2 of 4: it tries to go down but stays where it is\./);
      await next.click();
      await reads(shown.locator('.runs'), /Step 3 of 4: it goes down\./);
      assert.deepEqual(await violations(page), []);
    });
  });
});
