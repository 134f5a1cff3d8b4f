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

// All examples and answers, without a guess, and the end.
async function seeAll(page) {
  for (const name of ['Watch without a guess', 'Show the answer']) {
    const buttons = page.getByRole('button', { name });
    for (let n = await buttons.count(); n > 0; n -= 1) await buttons.first().click();
  }
  await page.getByRole('button', { name: 'Show the robot in one page' }).click();
  await page.waitForSelector('.portrait');
}

const kKeys = { up: 'ArrowUp', down: 'ArrowDown', left: 'ArrowLeft', right: 'ArrowRight', pickup: ' ', dropoff: ' ' };

async function press(page, frames) {
  for (const { action } of frames) if (action) await page.keyboard.press(kKeys[action]);
}

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
          await seeAll(page);
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
          const alike = await page.$$eval('.legend', (all) =>
            all.filter((legend) => {
              const signs = [...legend.querySelectorAll('li svg')].map((svg) => {
                const id = /url\(#([^)]+)\)/.exec(svg.innerHTML)?.[1];
                return svg.innerHTML.replace(/url\([^)]+\)/, '') + (id ? document.getElementById(id).innerHTML : '');
              });
              return new Set(signs).size !== signs.length;
            }).length,
          );
          assert.equal(alike, 0, 'two things of a legend are drawn alike');
        });
      });
    }
  }

  it('shows every component, demonstration and test, says every board in words, and gives nothing away', async () => {
    await withLesson('sample', { width: 1280, dark: false }, async (page) => {
      const count = (selector) => page.$$eval(selector, (all) => all.length);
      const sum = (key) => sample.components.reduce((n, component) => n + component[key].length, 0);
      assert.equal(await count('section[id^=component-]'), sample.components.length);
      assert.equal(await count('.demonstration'), sum('demonstrations'));
      assert.equal(await count('.test'), sum('tests') + sample.fresh.length);
      assert.equal(await count('.way'), 0, 'a path before anybody has moved');
      const visible = await page.evaluate(() => document.body.innerText);
      for (const component of sample.components) {
        const told = [component.name, ...component.sentences.map(({ text }) => text)];
        for (const { reason, flip } of component.demonstrations) told.push(reason, ...(flip ? [flip.text] : []));
        for (const text of told) assert.ok(!visible.toLowerCase().includes(text.toLowerCase()), text);
      }
      assert.ok(!visible.includes(sample.domain.title) && !(await page.title()).includes(sample.domain.title));
      assert.ok(visible.includes(sample.domain.job));
      await seeAll(page);
      const labels = await page.$$eval('.board svg[role=img]', (all) => all.map((svg) => svg.getAttribute('aria-label') ?? ''));
      assert.ok(labels.length > 0 && labels.every((label) => label.length > 20), `labels: ${labels}`);
      const levels = await page.$$eval('h1, h2, h3, h4', (all) => all.map((heading) => Number(heading.tagName[1])));
      levels.forEach((level, i) => assert.ok(i === 0 || level <= levels[i - 1] + 1, `heading ${i} skips a level`));
      const lost = await page.$$eval('nav a', (all) =>
        all.map((a) => a.getAttribute('href')).filter((href) => !document.querySelector(href)),
      );
      assert.deepEqual(lost, []);
      const opened = await page.evaluate(() => document.body.innerText);
      assert.doesNotMatch(opened, /\(\d+,\d+\)|\bworld \d|\bMDP\b|half-space|not been taught|% would/i);
    });
  });

  it('asks for a guess, shows both paths with what each counts, and says why, by keyboard alone', async () => {
    await withLesson('sample', { width: 1280, dark: false, reducedMotion: true }, async (page) => {
      const [shown] = sample.components[0].demonstrations;
      const card = page.locator('.demonstration').first();
      await card.locator('.drive-area').focus();
      await press(page, shown.frames.slice(0, 1));
      await press(page, [{ action: { up: 'down', down: 'up', left: 'right', right: 'left' }[shown.frames[0].action] }]);
      await reads(card.locator('.ledger'), /Steps2/);
      await press(page, shown.frames); // the robot's path after a detour
      await card.getByRole('button', { name: 'This is my guess' }).press('Enter');
      await reads(card, /The robot does something else\..*accept 2 more steps for nothing/s);
      await reads(card.locator('.ledger'), /RobotYou/);
      assert.deepEqual(await card.locator('.chip text').allTextContents(), ['+2 steps']);
      assert.equal(await card.locator('.decisive').count(), 2, 'the fork is marked, and the mark is in the legend');
      assert.equal(await card.locator('.way.own .line').first().count(), 1);
      await reads(card.locator('.player .count'), /^Step (\d+) of \1$/); // nothing moves by itself
      await reads(card.locator('.bracket'), /crossing rubble costs/i);
      const duration = await page.$eval('.mover', (mover) => getComputedStyle(mover).transitionDuration);
      assert.equal(duration, '0s');
    });
  });

  it('plays both robots from where they separate, by itself', async () => {
    await withLesson('sample', { width: 1280, dark: false }, async (page) => {
      const [shown] = sample.components[0].demonstrations;
      const card = page.locator('.demonstration').first();
      await card.getByRole('button', { name: 'Watch without a guess' }).click();
      await card.locator('.mover.ghost').waitFor();
      await reads(card.locator('.player .count'), new RegExp(`^Step ${shown.frames.length - 1} of`));
      await reads(card.locator('.reasons'), new RegExp(shown.reason.slice(4, 30)));
    });
  });

  it('judges answers to tests, keeps the score of first answers, and ends with the robot in one page', async () => {
    await withLesson('sample', { width: 1280, dark: false, reducedMotion: true }, async (page) => {
      const tests = sample.components.flatMap((component) => component.tests);
      for (const [i, test] of tests.entries()) {
        const card = page.locator('.test').nth(i);
        await card.locator('.drive-area').focus();
        if (i === 0) await press(page, [{ action: 'up' }, { action: 'down' }].concat(test.frames[0].robot[1] === 1 ? [{ action: 'down' }, { action: 'up' }] : []));
        await press(page, test.frames);
        await card.getByRole('button', { name: 'Submit' }).click();
        await reads(card.locator('.verdict'), i === 0 ? /Not quite/ : /Correct/);
        const reasons = card.locator('.reasons');
        if (i === 0) await reads(reasons, /What the robot has shown/);
        else if (test.is_shortest_wrong) await reads(reasons, /This fits:/);
        else assert.doesNotMatch(await reasons.textContent(), /This fits/, 'the shortest path tells nothing');
      }
      const again = page.locator('.test').first();
      await again.getByRole('button', { name: 'Try again' }).click();
      await again.locator('.drive-area').focus();
      await press(page, tests[0].frames);
      await again.getByRole('button', { name: 'Submit' }).click();
      await reads(again.locator('.verdict'), /Correct/);
      await reads(page.locator('#end [role=status]').first(), new RegExp(`correctly in ${tests.length - 1} of ${tests.length} tests\\.`));
      await page.getByRole('button', { name: 'Show the robot in one page' }).click();
      const portrait = page.locator('.portrait');
      for (const fold of await portrait.locator('summary').all()) await fold.click();
      for (const { text } of sample.components.flatMap(({ sentences }) => sentences)) await reads(portrait, new RegExp(text.slice(1)));
      await reads(portrait, /Your first prediction.*Your last prediction/s);
      const lines = await portrait.locator('.lines li').count();
      assert.equal(await portrait.locator('.lines .board').count(), lines, 'a sentence without a board');
      const robot = sample.fresh[0];
      const fresh = page.locator('#end .test').first();
      await fresh.locator('.drive-area').focus();
      await press(page, robot.frames);
      await fresh.getByRole('button', { name: 'Submit' }).click();
      await reads(fresh.locator('.verdict'), /Correct/);
    });
  });

  it('prints paths and reasons, with the answers on the last page', async () => {
    await withLesson('sample', { width: 1280, dark: false }, async (page) => {
      await page.emulateMedia({ media: 'print' });
      await page.waitForSelector('.answers .way.own');
      const n = sample.components.reduce((sum, { tests }) => sum + tests.length, 0);
      assert.equal(await page.locator('.answers figure').count(), n);
      assert.equal(await page.locator('.test .way').count(), 0, 'an answer beside its test');
      const shown = sample.components.flatMap(({ demonstrations }) => demonstrations);
      assert.equal(await page.locator('.demonstration .reasons').count(), shown.length);
      assert.equal(await page.locator('.pad, .player').count(), 0);
    });
  });

  it('shows a path that never ends as its way in and its cycle, and says so', async () => {
    await withLesson('endless', { width: 1280, dark: false, reducedMotion: true }, async (page) => {
      const card = page.locator('.demonstration').first();
      await card.getByRole('button', { name: 'Watch without a guess' }).click();
      await card.locator('.way.own .round').waitFor();
      for (let step = 5; step > 1; step -= 1) await card.getByRole('button', { name: 'Previous step' }).click();
      for (let step = 1; step < 5; step += 1) await card.getByRole('button', { name: 'Next step' }).click();
      await reads(card.locator('.log p').last(), / And so on: it never delivers the parcel\.$/);
    });
  });

  it('lists states and actions where there is no map', async () => {
    await withLesson('mapless', { width: 1280, dark: false }, async (page) => {
      assert.equal(await page.locator('.board').count(), 0);
      const example = page.locator('.demonstration').first();
      await reads(example, /This world: weekday\..*dock/s);
      assert.equal(await page.locator('.step-list').count(), 0, 'listed before the reader has decided');
      await example.getByRole('button', { name: 'Watch without a guess' }).click();
      await reads(example.locator('.step-list .differs').first(), /dock.*wait.*different from here/);
    });
  });

  it('enlarges small cells, and shows the part of the map around the robot', async () => {
    await withLesson('huge', { width: 390, dark: false, reducedMotion: true }, async (page) => {
      const shown = page.locator('.demonstration');
      await shown.getByRole('button', { name: 'Watch without a guess' }).click();
      await shown.locator('.player').waitFor();
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
      assert.ok(first.cell >= 27.5, `cells of ${first.cell} px`);
      assert.ok(first.isRobotInside);
      for (let step = 1; step < 50; step += 7) {
        for (let i = 0; i < 7; i += 1) await shown.locator('.step-button').first().click();
        assert.ok((await look()).isRobotInside, `step ${step}`);
      }
      const last = await look();
      assert.ok(last.left < first.left && last.seen < first.seen);
      await shown.locator('.pan').focus();
      await page.keyboard.press('Shift+ArrowRight');
      await page.waitForFunction((left) => document.querySelector('.demonstration .pan').scrollLeft > left, last.left);
      const { x, y } = await shown.locator('.pan').boundingBox();
      const before = (await look()).left;
      await page.mouse.move(x + 200, y + 100);
      await page.mouse.down();
      await page.mouse.move(x + 100, y + 100, { steps: 4 });
      await page.mouse.up();
      await page.waitForFunction((left) => document.querySelector('.demonstration .pan').scrollLeft >= left + 80, before);
      await shown.locator('.overview').click({ position: { x: 4, y: 4 } });
      await page.waitForFunction(() => document.querySelector('.demonstration .pan').scrollLeft === 0);
      await shown.getByRole('button', { name: 'Show the whole board' }).click();
      assert.equal(await shown.locator('.pan.enlarged').count(), 0);
      await shown.getByRole('button', { name: 'Enlarge the board' }).click();
      assert.equal(await shown.locator('.pan.enlarged').count(), 1);
    });
  });

  it('shows several runs where chance has a part', async () => {
    await withLesson('uncertain', { width: 1280, dark: false }, async (page) => {
      const shown = page.locator('.demonstration').first();
      assert.equal(await shown.locator('.runs').count(), 0, 'run before the reader has decided');
      await shown.getByRole('button', { name: 'Watch without a guess' }).click();
      await reads(shown, /Here are 2 of its runs.*Run 1 of 2.*the most common path in 1\./s);
      await shown.locator('.ends').getByRole('button').nth(1).click();
      await reads(shown, /Run 2 of 2/);
      const test = page.locator('.test').first();
      await test.getByRole('button', { name: 'Show the answer' }).click();
      await reads(test, /Run 1 of 2/);
      assert.doesNotMatch(await test.textContent(), /A right answer shows/);
    });
  });

  it('draws walls and what states place, and says where the robot slips', async () => {
    await withLesson('drawn', { width: 390, dark: true }, async (page) => {
      const shown = page.locator('.demonstration').first();
      await reads(shown, /This world: wet ice\./);
      assert.equal(await shown.locator('.board .destination').count(), 1);
      assert.equal(await shown.locator('.board .fence').getAttribute('d'), 'M80 0v40');
      await shown.getByRole('button', { name: 'Watch without a guess' }).click();
      const next = shown.getByRole('button', { name: 'Next step' });
      const said = shown.locator('.log p').last();
      await next.click();
      await reads(said, /The robot tries to go right but slips up/);
      assert.equal(await shown.locator('.live-board:not(.small) .tried').count(), 1, 'where it tried to go is drawn');
      await next.click();
      await reads(said, /The robot tries to go down but stays where it is\./);
      await next.click();
      await reads(said, /The robot moves down/);
    });
  });
});
