// Opens a lesson that the program makes as a reader would, and checks what a reader needs.
//
//   node tests/lesson_test.mjs TEMPLATE.html --kith PROGRAM [--screenshots DIR] [--modules DIR] [--chromium FILE]
//
// --picture writes the picture of the README, which is checked otherwise.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdirSync, mkdtempSync, readFileSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { dirname, join, resolve } from 'node:path';
import { after, before, describe, it } from 'node:test';
import { fileURLToPath, pathToFileURL } from 'node:url';
import { parseArgs } from 'node:util';
import { pictureOf } from '../picture.mjs';
import { fillPage } from '../sample/fill_page.mjs';
import { launch, openPage, reads, requireFrom, violations } from './browser.mjs';
import { drawn, endless, hugeLesson, mapless, uncertain } from './lessons.mjs';

const here = dirname(fileURLToPath(import.meta.url));
const { values, positionals } = parseArgs({
  allowPositionals: true,
  options: {
    kith: { type: 'string' },
    screenshots: { type: 'string' },
    picture: { type: 'boolean', default: false },
    modules: { type: 'string', default: join(here, '..') },
    chromium: { type: 'string', default: '/usr/bin/chromium' },
  },
});
if (positionals.length !== 1 || !values.kith) {
  console.error('usage: node tests/lesson_test.mjs TEMPLATE.html --kith PROGRAM; see its first lines');
  process.exit(2);
}
const template = readFileSync(resolve(positionals[0]), 'utf8');
const folder = mkdtempSync(join(tmpdir(), 'kith-lesson-'));
const sample = JSON.parse(execFileSync(values.kith, ['lesson', 'item-delivery', '--json', '-q'], { encoding: 'utf8' }));
const axeSource = readFileSync(requireFrom(values.modules).resolve('axe-core/axe.min.js'), 'utf8');

function addressOf(name, lesson) {
  const file = join(folder, `${name}.html`);
  writeFileSync(file, fillPage(template, JSON.stringify(lesson)));
  return pathToFileURL(file).href;
}
// A part of many boards, of which one comes first.
const [part] = sample.components;
const copies = (shown, n) => Array.from({ length: n }, (_, i) => ({ ...shown, world: 1000 + i, first: i === 0 }));
const long = { ...sample, components: [part, { ...part, number: 2, demonstrations: copies(part.demonstrations[0], 11), tests: [] }] };
const all = sample.components.flatMap(({ demonstrations, tests }) => [...demonstrations, ...tests]);
const [boards, later] = [true, false].map((isFirst) => all.filter(({ first }) => first === isFirst));
const pages = {
  sample: addressOf('sample', sample),
  huge: addressOf('huge', hugeLesson()),
  mapless: addressOf('mapless', mapless()),
  uncertain: addressOf('uncertain', uncertain()),
  drawn: addressOf('drawn', drawn()),
  endless: addressOf('endless', endless(sample)),
  long: addressOf('long', long),
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

const kSkip = /^(Watch without a guess|Show the answer)$/;
const kGoOn = /^(Start|Next: another path|Next board|See what this robot is like|\d+ more boards?)$/;
const goOn = (page) => page.getByRole('button', { name: kGoOn });

// Every screen of a lesson without a guess, from the introduction to the end.
async function walk(page, look) {
  await look('introduction');
  for (let n = 0; n < 120 && (await goOn(page).count()) + (await page.getByRole('button', { name: kSkip }).count()) > 0; n += 1) {
    const skip = page.getByRole('button', { name: kSkip });
    if (await skip.count()) await skip.click();
    else await goOn(page).click();
    await look((await page.locator('#end').count()) ? 'end' : (await skip.count()) ? 'asked' : 'seen');
  }
}

// To the first board, or to a later one without a guess.
async function open(page, number = 1) {
  await page.getByRole('button', { name: 'Start' }).click();
  for (let i = 1; i < number; i += 1) {
    await page.getByRole('button', { name: kSkip }).click();
    await page.getByRole('button', { name: 'Next board' }).click();
  }
  const card = page.locator('.card');
  await card.waitFor();
  return card;
}

const kKeys = { up: 'ArrowUp', down: 'ArrowDown', left: 'ArrowLeft', right: 'ArrowRight', pickup: ' ', dropoff: ' ' };

async function press(page, frames) {
  for (const { action } of frames) if (action) await page.keyboard.press(kKeys[action]);
}

// A detour at the beginning, which costs two steps.
async function pressWithDetour(page, test) {
  const there = test.frames[0].robot[1] === 1 ? 'down' : 'up';
  await press(page, [{ action: there }, { action: there === 'up' ? 'down' : 'up' }, ...test.frames]);
}

describe('a lesson', () => {
  before(async () => (browser = await launch(values.modules, values.chromium)));
  after(async () => browser?.close());

  const kWide = { width: 1280, dark: false };
  const kDark = { width: 768, dark: true, rules: ['color-contrast'] };
  const kNarrow = { width: 320, dark: false, rules: ['scrollable-region-focusable'] };
  const kLooks = { sample: [kWide, kDark, kNarrow], huge: [kWide, kDark, kNarrow], mapless: [kWide, kNarrow], uncertain: [kWide, kNarrow], drawn: [kWide, kDark, kNarrow], endless: [kWide, kNarrow] };
  for (const [name, looks] of Object.entries(kLooks)) {
    for (const { width, dark, rules } of looks) {
      it(`of ${name} at ${width} px ${dark ? 'dark' : 'light'}: no overflow, no serious axe violation`, async () => {
        await withLesson(name, { width, dark, reducedMotion: true }, async (page) => {
          const known = new Set();
          let n = 0;
          await walk(page, async (what) => {
            n += 1;
            if (values.screenshots) {
              mkdirSync(values.screenshots, { recursive: true });
              await page.screenshot({ path: join(values.screenshots, `${name}-${width}-${n}-${what}.png`), fullPage: true });
            }
            await page.evaluate(() => document.querySelectorAll('details').forEach((box) => (box.open = true)));
            const { body, view, focus } = await page.evaluate(() => ({
              body: document.documentElement.scrollWidth,
              view: document.documentElement.clientWidth,
              focus: document.activeElement?.tagName,
            }));
            assert.ok(body <= view, `${what}: the page is ${body} px wide in a window of ${view} px`);
            assert.equal(focus, what === 'introduction' ? 'BODY' : 'H2', `the focus, ${what}`);
            if (!known.has(what)) assert.deepEqual(await violations(page, axeSource, { rules }), [], what);
            known.add(what);
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
          assert.ok(known.has('end'), 'the lesson comes to an end');
        });
      });
    }
  }

  it('shows one board at a time and each once, says it in words, and gives nothing away', async () => {
    await withLesson('sample', { width: 1280, dark: false }, async (page) => {
      const told = sample.components.flatMap((component) => [
        component.name,
        ...component.sentences.map(({ text }) => text),
        ...component.demonstrations.map(({ reason }) => reason),
      ]);
      const seen = new Set();
      await walk(page, async (what) => {
        const visible = await page.evaluate(() => document.body.innerText);
        assert.ok((await page.locator('.card').count()) <= 1);
        assert.ok(!visible.includes(sample.domain.title) && !(await page.title()).includes(sample.domain.title));
        assert.doesNotMatch(visible, /\(\d+,\d+\)|\bworld \d|\bMDP\b|half-space|not been taught|% would/i);
        const levels = await page.$$eval('h1, h2, h3, h4', (all) => all.map((heading) => Number(heading.tagName[1])));
        levels.forEach((level, i) => assert.ok(i === 0 || level <= levels[i - 1] + 1, `heading ${i} skips a level`));
        const labels = await page.$$eval('.board svg[role=img]', (all) => all.map((svg) => svg.getAttribute('aria-label') ?? ''));
        assert.ok((labels.length > 0) === (what !== 'introduction') && labels.every((label) => label.length > 20), `labels: ${labels}`);
        if (what === 'introduction') assert.ok(visible.includes(sample.domain.job));
        if (what !== 'asked') return;
        assert.equal(await page.locator('.way').count(), 0, 'a path before anybody has moved');
        for (const text of told) assert.ok(!visible.toLowerCase().includes(text.toLowerCase()), text);
        const board = await page.$eval('.live-board svg', (svg) => svg.innerHTML);
        assert.ok(!seen.has(board), 'a board that was shown before');
        seen.add(board);
      });
      assert.equal(seen.size, all.length + sample.fresh.length);
    });
  });

  it('begins with the boards that are first, and offers the others', async () => {
    await withLesson('long', { width: 1280, dark: false }, async (page) => {
      const [first, more] = [part.demonstrations.length + part.tests.length + 1, 10 + sample.fresh.length];
      await reads(page.locator('#introduction'), new RegExp(`${first} boards`));
      let asked = 0;
      await walk(page, async (what) => {
        if (what === 'asked') asked += 1;
        if (what === 'end' && asked === first) await reads(page.locator('#end'), new RegExp(`${more} more boards`));
      });
      assert.equal(asked, first + more);
    });
  });

  it('asks for a guess, shows both paths with what each counts, and says why: by keyboard alone, Enter going on', async () => {
    await withLesson('sample', { width: 1280, dark: false, reducedMotion: true }, async (page) => {
      const [shown] = sample.components[0].demonstrations;
      const card = page.locator('.card');
      await page.keyboard.press('Enter');
      await press(page, shown.frames.slice(0, 1));
      await press(page, [{ action: { up: 'down', down: 'up', left: 'right', right: 'left' }[shown.frames[0].action] }]);
      await reads(card.locator('.ledger'), /Steps2/);
      assert.doesNotMatch(await card.locator('.ledger').textContent(), /charger/, 'what is not on the board');
      await page.keyboard.press('Enter');
      await reads(card.locator('h2'), /Where will the robot go/); // the path is not whole
      await press(page, shown.frames); // the robot's path after a detour
      await page.keyboard.press('Enter');
      await reads(card, /Not quite.*It would rather not take 2 more steps/s);
      assert.equal(await page.evaluate(() => document.activeElement.textContent), 'Not quite');
      await reads(card.locator('.ledger'), /RobotYou/);
      assert.deepEqual(await card.locator('.chip text').allTextContents(), ['+2 steps']);
      assert.equal(await card.locator('.decisive').count(), 2, 'the fork is marked, and the mark is in the legend');
      assert.equal(await card.locator('.way.own .line').first().count(), 1);
      await reads(card.locator('.player .count'), /^Step (\d+) of \1$/); // nothing moves by itself
      assert.equal(await card.locator('.bracket').count(), 0, 'one comparison at a time');
      const duration = await page.$eval('.mover', (mover) => getComputedStyle(mover).transitionDuration);
      assert.equal(duration, '0s');
      await page.keyboard.press('Enter');
      await reads(card, /Now this one.*crossing rubble costs more than 2 steps/is);
      await reads(card.locator('.ledger'), /RobotOther/);
      assert.equal(await card.locator('.way.other, .chip.other').count(), 0, 'the colour of the reader on a path that is not theirs');
      assert.ok((await card.locator('.bracket').count()) > 0);
      await page.keyboard.press('Enter');
      await reads(page.locator('.kicker'), /board 2 of/);
      assert.deepEqual(await page.$$eval('.track button', (all) => all.slice(0, 3).map(({ className }) => className)), ['', 'done', '']);
    });
  });

  it('plays both robots from where they separate, by itself', async () => {
    await withLesson('sample', { width: 1280, dark: false }, async (page) => {
      const [shown] = sample.components[0].demonstrations;
      const card = await open(page);
      await card.getByRole('button', { name: 'Watch without a guess' }).click();
      await card.locator('.mover.ghost').waitFor();
      await reads(card.locator('.player .count'), new RegExp(`^Step ${shown.frames.length - 1} of`));
      await reads(card.locator('.reasons'), new RegExp(shown.reason.slice(4, 30)));
    });
  });

  it('judges answers, counts them, and ends with the robot in one page', async () => {
    await withLesson('sample', { width: 1280, dark: false, reducedMotion: true }, async (page) => {
      await page.keyboard.press('Enter');
      for (const [i, test] of boards.entries()) {
        const card = page.locator('.card');
        await reads(card.locator('.kicker'), new RegExp(`board ${i + 1} of ${boards.length}`));
        if (i === 0) await pressWithDetour(page, test);
        else await press(page, test.frames);
        await page.keyboard.press('Enter');
        await reads(card.locator('.verdict'), i === 0 ? /Not quite/ : /Correct/);
        if (i === 0) await page.keyboard.press('Enter');
        await page.keyboard.press('Enter');
      }
      await reads(page.locator('#end [role=status]').first(), new RegExp(`right on ${boards.length - 1} of ${boards.length} boards\\.`));
      assert.equal(await page.locator('.track .right').count(), boards.length - 1);
      const portrait = page.locator('.portrait');
      for (const fold of await portrait.locator('summary').all()) await fold.click();
      for (const { text } of sample.components.flatMap(({ sentences }) => sentences)) await reads(portrait, new RegExp(text.slice(1)));
      await reads(portrait, /Your first prediction.*Your last prediction/s);
      const lines = await portrait.locator('.lines li').count();
      assert.equal(await portrait.locator('.lines .board').count(), lines, 'a sentence without a board');
      for (const more of [...later, sample.fresh[0]]) {
        await page.keyboard.press('Enter');
        await press(page, more.frames);
        await page.keyboard.press('Enter');
        await reads(page.locator('.verdict'), /Correct/);
        if (more.covers) assert.doesNotMatch(await page.locator('.card .reasons').textContent(), /This fits/);
      }
    });
  });

  it('asks which of two paths it is after the second mistake of a kind, and then to draw again', async () => {
    await withLesson('sample', { width: 1280, dark: false, reducedMotion: true }, async (page) => {
      await page.keyboard.press('Enter');
      const card = page.locator('.card');
      let answered = 0;
      for (; answered < 2; answered += 1) {
        await reads(card.locator('h2'), /Where will the robot go/);
        await pressWithDetour(page, boards[answered]);
        for (let i = 0; i < 3; i += 1) await page.keyboard.press('Enter'); // the guess, another path, the next board
      }
      await reads(card.locator('h2'), /Which of these two paths/);
      assert.equal(await card.locator('.choices .way.plain').count(), 2, 'no path is anybody\u2019s yet');
      await card.getByRole('button', { name: 'Path A' }).click();
      await reads(card.locator('.verdict'), /Correct|Not quite/);
      for (let i = 0; i < 2; i += 1) if (/board 3/.test(await card.locator('.kicker').textContent())) await page.keyboard.press('Enter');
      await reads(card.locator('h2'), /Where will the robot go/);
    });
  });

  it('looks as the picture of the README says', async () => {
    await withLesson('sample', { width: 1280, dark: false, reducedMotion: true }, async (page) => {
      await open(page);
      await press(page, sample.components[0].demonstrations[0].alternative.frames);
      await page.keyboard.press('Enter');
      await reads(page.locator('.verdict'), /Not quite/);
      const file = join(here, '../../docs/pictures/lesson.svg');
      if (values.picture) writeFileSync(file, await pictureOf(page));
      assert.equal(await pictureOf(page), readFileSync(file, 'utf8'), 'run this test with --picture');
    });
  });

  it('prints paths and reasons, with the answers on the last page', async () => {
    await withLesson('sample', { width: 1280, dark: false }, async (page) => {
      await page.emulateMedia({ media: 'print' });
      await page.waitForSelector('.answers .way.own');
      assert.equal(await page.locator('.answers figure').count(), boards.filter(({ covers }) => covers).length);
      assert.equal(await page.locator('.test .way').count(), 0, 'an answer beside its test');
      assert.equal(await page.locator('.demonstration .reasons').count(), boards.filter(({ covers }) => !covers).length);
      assert.equal(await page.locator('.pad, .player').count(), 0);
    });
  });

  for (const [width, height] of [
    [320, 568],
    [390, 844],
  ]) {
    it(`shows board, pad and guess at ${width} x ${height} without scrolling`, async () => {
      await withLesson('sample', { width, dark: false, reducedMotion: true }, async (page) => {
        await page.setViewportSize({ width, height });
        await open(page);
        const boxes = await page.$$eval('.live-board .board svg, .pad .arrow, .submit button', (all) => all.map((one) => one.getBoundingClientRect().toJSON()));
        assert.ok(boxes.length > 6);
        for (const { top, bottom, left, right } of boxes) assert.ok(top >= 0 && left >= 0 && right <= width && bottom <= height, `${top} to ${bottom}`);
        await page.getByRole('button', { name: 'Watch without a guess' }).click();
        const { bottom } = await goOn(page).evaluate((button) => button.getBoundingClientRect());
        assert.ok(bottom <= height, 'what goes on is out of sight');
      });
    });
  }

  it('shows a path that never ends as its way in and its cycle, and says so', async () => {
    await withLesson('endless', { width: 1280, dark: false, reducedMotion: true }, async (page) => {
      const card = await open(page);
      await card.getByRole('button', { name: 'Watch without a guess' }).click();
      await card.locator('.way.own .round').waitFor();
      for (let step = 5; step > 1; step -= 1) await card.getByRole('button', { name: 'Previous step' }).click();
      for (let step = 1; step < 5; step += 1) await card.getByRole('button', { name: 'Next step' }).click();
      await reads(card.locator('.log p').last(), / And so on: it never delivers the parcel\.$/);
    });
  });

  it('lists states and actions where there is no map', async () => {
    await withLesson('mapless', { width: 1280, dark: false }, async (page) => {
      const example = await open(page);
      assert.equal(await page.locator('.board').count(), 0);
      await reads(example, /: weekday.*dock/s);
      assert.equal(await page.locator('.step-list').count(), 0, 'listed before the reader has decided');
      await example.getByRole('button', { name: 'Watch without a guess' }).click();
      await reads(example.locator('.step-list .differs').first(), /dock.*wait.*different from here/);
    });
  });

  it('enlarges small cells, and shows the place where paths separate, and then the part around the robot', async () => {
    await withLesson('huge', { width: 390, dark: false, reducedMotion: true }, async (page) => {
      const shown = await open(page);
      await shown.getByRole('button', { name: 'Watch without a guess' }).click();
      await shown.locator('.player').waitFor();
      const look = () =>
        shown.evaluate((card) => {
          const box = (selector) => card.querySelector(selector).getBoundingClientRect();
          const [pan, svg, seen] = [box('.pan'), box('.pan svg'), card.querySelector('.overview .seen')];
          const isInside = ({ left, right, top, bottom }) => left >= pan.left && right <= pan.right && top >= pan.top && bottom <= pan.bottom;
          return {
            cell: svg.width / 60,
            isForkInside: isInside(box('.decisive')),
            isRobotInside: isInside(box('.mover')),
            left: card.querySelector('.pan').scrollLeft,
            seen: Number(seen.getAttribute('x')),
          };
        });
      assert.ok((await look()).isForkInside, 'the place that tells why is out of sight');
      await shown.locator('.step-button').first().click();
      const first = await look();
      assert.ok(first.cell >= 27.5, `cells of ${first.cell} px`);
      assert.ok(first.isRobotInside);
      for (let step = 2; step < 44; step += 7) {
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
      const shown = await open(page);
      assert.equal(await shown.locator('.runs').count(), 0, 'run before the reader has decided');
      await shown.getByRole('button', { name: 'Watch without a guess' }).click();
      await reads(shown, /2 of its runs.*Run 1 of 2.*the most common path in 1\./s);
      await shown.locator('.ends').getByRole('button').nth(1).click();
      await reads(shown, /Run 2 of 2/);
      await goOn(page).click();
      const test = page.locator('.test');
      await test.getByRole('button', { name: 'Show the answer' }).click();
      await reads(test, /Run 1 of 2/);
      assert.doesNotMatch(await test.textContent(), /A right answer shows/);
    });
  });

  it('draws walls and what states place, and says where the robot slips', async () => {
    await withLesson('drawn', { width: 390, dark: true }, async (page) => {
      const shown = await open(page);
      await reads(shown, /: wet ice/);
      assert.equal(await shown.locator('.board .destination').count(), 1);
      assert.equal(await shown.locator('.board .fence').getAttribute('d'), 'M80 0v40');
      await shown.getByRole('button', { name: 'Watch without a guess' }).click();
      await reads(shown.locator('.in-words'), /ice; right: a wall/);
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
