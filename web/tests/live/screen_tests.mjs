// Every screen, from views as a server sends them: narrow and wide, light and dark, for assistive technology, and
// with hostile texts.
import assert from 'node:assert/strict';
import { mkdirSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, describe, it } from 'node:test';
import { serve, until } from '../kith.mjs';
import { openPerson } from './person.mjs';
import { hostileView, kHostile, kScreens, makeViews } from './views.mjs';

// `rules`: those of axe that a look may break; without, all of them.
const kLooks = [
  { name: 'light-1280', width: 1280, height: 900 },
  { name: 'dark-1280', width: 1280, height: 900, dark: true, rules: ['color-contrast'] },
  { name: 'light-320', width: 320, height: 640, rules: ['scrollable-region-focusable'] },
  { name: 'zoom-200', width: 640, height: 450, rules: [] }, // 1280 x 900 at 200 %
  { name: 'rtl-320', width: 320, height: 640, rules: [], language: { lang: 'ar', dir: 'rtl', strings: { 'page.skip': 'Skip' } } },
  { name: 'german-320', width: 320, height: 640, rules: [], language: { lang: 'de', dir: 'ltr', strings: {} } },
];

// Ids that more than one element has: whatever refers to them finds the first.
export const repeatedIds = () => {
  const ids = [...document.querySelectorAll('[id]')].map(({ id }) => id);
  return ids.filter((id, i) => ids.indexOf(id) !== i);
};

// Textures that a board is filled with and the page lacks, so that nothing is to be seen there.
export const missingTextures = () => {
  const names = [...document.querySelectorAll('[fill^="url(#"]')].map((shape) => shape.getAttribute('fill').slice(5, -1));
  return [...new Set(names)].filter((name) => !document.getElementById(name));
};

// Buttons, links and fields that are smaller than a finger.
const smallTargets = () =>
  [...document.querySelectorAll('#page button, #page a, #page select, #page summary, #page textarea, #page input')]
    .map((target) => (target.matches('[type=radio], [type=checkbox]') ? target.closest('label') : target))
    .filter((target) => target.getClientRects().length > 0)
    .map((target) => ({ target, box: target.getBoundingClientRect() }))
    .filter(({ box }) => box.height < 43.5 || box.width < 43.5)
    .map(({ target, box }) => `${target.outerHTML.slice(0, 80)}: ${Math.round(box.width)} x ${Math.round(box.height)}`);

// The server that all share, and what it has shown.
const shared = {};

// A page of somebody who has just joined, that is shown what the test says from then on.
async function withViews(setting, body, look = {}) {
  const { views, tables, running } = shared;
  const person = await openPerson(setting.browser, running.server.join, { reducedMotion: true, ...look });
  const { page, wire } = person;
  const json = (route, value) => route.fulfill({ contentType: 'application/json', body: JSON.stringify(value) });
  try {
    if (look.language) await page.route('**/api/texts', (route) => json(route, look.language));
    await page.route('**/api/world/*', (route) => {
      const table = tables[route.request().url().split('/').at(-1)];
      return table ? json(route, table) : route.continue();
    });
    await person.join();
    await person.atStage('consent');
    wire.answers = () => ({ t: 'ack' });
    wire.show(views.consent);
    await body({ views, wire, person, page });
    assert.deepEqual(person.trouble, [], 'requests, console messages or uncaught errors');
  } finally {
    await person.close();
  }
}

// A view that is new to the page, also if the screen before it was of the same kind.
async function show({ person, page }, view) {
  await page.evaluate(() => {
    for (const name of ['drive', 'seen', 'sketch', 'feedback', 'dismissed', 'introduced']) sessionStorage.removeItem(`kith.${name}`);
  });
  const { progress } = view;
  show.count = (show.count ?? 0) + 1;
  const marked = { ...view, study: { ...view.study, title: `${view.study.title} ${show.count}` } };
  person.view = progress ? { ...marked, progress: { ...progress, round: show.count } } : marked;
  person.wire.show(person.view);
  await page.waitForFunction((text) => document.querySelector('.study-title')?.textContent === text, marked.study.title);
}

// What is to be seen now: it fits, it can be touched, and it can be read by assistive technology.
async function examine(setting, person, name, look) {
  const { page } = person;
  if (setting.screenshots) {
    mkdirSync(setting.screenshots, { recursive: true });
    await page.screenshot({ path: join(setting.screenshots, `live-${name}-${look.name}.png`), fullPage: true });
  }
  const { body, wide } = await page.evaluate(() => ({
    body: document.documentElement.scrollWidth,
    wide: document.documentElement.clientWidth,
  }));
  assert.ok(body <= wide, `${name}: ${body} px in a window of ${wide} px`);
  assert.deepEqual(await page.evaluate(smallTargets), [], name);
  assert.deepEqual(await page.evaluate(repeatedIds), [], name);
  assert.deepEqual(await page.evaluate(missingTextures), [], name);
  assert.deepEqual(await person.violations(setting.axe, look.rules), [], name);
}

// Step by step, if the screen has a player.
const playToTheEnd = ({ page }) =>
  page.evaluate(async () => {
    const next = () => document.querySelectorAll('.step-button')[1];
    while (next() && !next().ariaDisabled) {
      next().click();
      await new Promise((resolve) => setTimeout(resolve));
    }
  });

export function screenTests(setting) {
  describe('every screen', () => {
    before(async () => {
      shared.running = await serve(setting.kith, kScreens);
      Object.assign(shared, await makeViews(setting.modules, shared.running.server));
    });
    after(() => shared.running?.close());

    for (const look of kLooks) {
      it(`at ${look.name} fits, is large enough to touch and has no serious axe violation`, async () => {
        await withViews(
          setting,
          async ({ views, person, page }) => {
            for (const [name, view] of Object.entries(views)) {
              await show({ person, page }, view);
              if (name === 'check') {
                await examine(setting, person, 'introduction', look);
                await page.click('.intro [type=submit]');
              }
              if (view.predict || view.check) await page.waitForSelector('.pad-row');
              if (/^feedback|^mapless-(w|f)/.test(name)) await playToTheEnd(person);
              await examine(setting, person, name, look);
            }
          },
          look,
        );
      });
    }

    for (const look of kLooks.filter(({ language }) => !language)) {
      it(`without a session, at ${look.name}`, async () => {
        await withViews(
          setting,
          async ({ wire, person, page }) => {
            const { server } = shared.running;
            const check = (name) => examine(setting, person, name, look);
            wire.say({ t: 'bye', reason: 'opened-elsewhere' });
            wire.cut();
            await person.at('Open in another tab');
            await check('elsewhere');
            await page.goto('about:blank');
            await page.goto(`${server.origin}/j#t=not-a-known-token`);
            await person.at('This link does not work');
            await check('bad-link');
            await person.button('Enter a code').click();
            await person.at('Join a session');
            await person.button('Join').click();
            await page.waitForFunction(() => document.querySelector('[role=alert]').textContent !== '');
            await page.click('summary');
            await check('landing');
            wire.isSilent = true;
            await page.clock.install();
            await page.goto(`${server.origin}/j#t=${'0'.repeat(22)}`);
            await person.at('Connecting');
            await person.pass(6000);
            await page.waitForSelector('text=has not answered');
            await check('connecting');
          },
          look,
        );
      });
    }

    it('has one heading of the first level, no missing text and nothing but words', async () => {
      await withViews(setting, async ({ views, person, page }) => {
        for (const [name, view] of Object.entries(views)) {
          await show({ person, page }, view);
          const levels = await page.$$eval('h1, h2, h3', (all) => all.map((heading) => Number(heading.tagName[1])));
          assert.equal(levels.filter((level) => level === 1).length, 1, name);
          const text = await page.evaluate(() => document.querySelector('#page').innerText);
          assert.ok(text.length > 60, name);
          assert.doesNotMatch(text, /undefined|NaN|\[object|\{\w+\}/, name);
          assert.doesNotMatch(text, /\b(wait|predict|watch|feedback|lobby|say|thing|legend|common|end|pause)\.[a-z]/, name);
          assert.ok((await page.title()).startsWith(await page.textContent('h1')), name);
        }
      });
    });

    it('keeps boards and arrows as they are where texts are written from right to left', async () => {
      const look = kLooks.find(({ language }) => language?.dir === 'rtl');
      await withViews(
        setting,
        async ({ views, person, page }) => {
          await show({ person, page }, views['predict-handling']);
          await page.waitForSelector('.pad-row');
          const left = (selector) => page.$eval(selector, (element) => element.getBoundingClientRect().left);
          assert.ok((await left('.pad .x1')) < (await left('.pad .x3')));
          const before = await left('.mover');
          await page.keyboard.press('ArrowRight');
          await page.waitForFunction((x) => document.querySelector('.mover').getBoundingClientRect().left > x, before);
        },
        look,
      );
    });

    it('shows all of a large board, and if asked the part around the robot, which can be driven and looked past', async () => {
      await withViews(
        setting,
        async ({ views, person, page }) => {
          await show({ person, page }, views['predict-huge']);
          await page.waitForSelector('.pad-row');
          const look = () =>
            page.evaluate(() => {
              const [pan, robot] = ['.pan', '.mover'].map((selector) => document.querySelector(selector).getBoundingClientRect());
              const isInside = robot.left >= pan.left && robot.right <= pan.right && robot.top >= pan.top && robot.bottom <= pan.bottom;
              return { isInside, cell: document.querySelector('.pan svg').getBoundingClientRect().width / 60 };
            });
          const whole = await look();
          assert.ok(whole.isInside && whole.cell < 16, JSON.stringify(whole));
          await person.button('Enlarge the board').click();
          const start = await look();
          assert.ok(start.isInside && start.cell >= 16, JSON.stringify(start));
          await person.drive(Array.from({ length: 30 }, () => 'down'));
          assert.ok((await look()).isInside);
          const steps = await page.textContent('.submit p');
          assert.doesNotMatch(steps, /^0 /);
          const left = await page.$eval('.pan', ({ scrollLeft }) => scrollLeft);
          await page.keyboard.press('Shift+ArrowRight');
          await page.waitForFunction((x) => document.querySelector('.pan').scrollLeft > x, left);
          assert.equal(await page.textContent('.submit p'), steps, 'only the board has moved');
          await page.locator('.overview').click({ position: { x: 40, y: 30 } });
          await page.waitForFunction(() => document.querySelector('.pan').scrollTop > 0);
          await person.button('Show the whole board').click();
          await person.button('Enlarge the board').click();
          assert.equal(await page.textContent('.submit p'), steps, 'nothing below the board drives the robot');
          assert.ok((await look()).isInside);
          await page.setViewportSize({ width: 700, height: 500 });
          await page.setViewportSize({ width: 390, height: 844 });
          await page.waitForFunction(() => {
            const [pan, robot] = ['.pan', '.mover'].map((selector) => document.querySelector(selector).getBoundingClientRect());
            return robot.left >= pan.left && robot.right <= pan.right && robot.top >= pan.top && robot.bottom <= pan.bottom;
          });
          const { x, y, width, height } = await page.locator('.mover').boundingBox();
          await page.touchscreen.tap(x + width / 2 + 20, y + height / 2); // the next cell
          await page.waitForFunction((text) => document.querySelector('.submit p').textContent !== text, steps);
        },
        { width: 390, height: 844, hasTouch: true },
      );
    });

    it('calls nothing saved while nothing is stored', async () => {
      await withViews(setting, async ({ views, person, page }) => {
        for (const name of ['consent', 'declined', 'full']) {
          await show({ person, page }, views[name]);
          assert.equal(await page.textContent('.status'), '', name);
        }
        await show({ person, page }, views.lobby);
        assert.match(await page.textContent('.status'), /Saved/);
      });
    });

    it('says that a prediction ends too early', async () => {
      await withViews(setting, async ({ views, person, page }) => {
        for (const [name, isShort] of [['feedback-short', true], ['feedback-wrong', false]]) {
          await show({ person, page }, views[name]);
          await playToTheEnd(person);
          assert.equal((await page.textContent('main')).includes('Your path ends before the robot has finished its job.'), isShort, name);
        }
      });
    });

    it('shows a station that has been used up, but pale', async () => {
      await withViews(setting, async ({ views, person, page }) => {
        const { watch } = views['watch-station'];
        await show({ person, page }, { ...views.watch, watch });
        assert.equal(await page.locator('.live-board .station').count(), 1);
        assert.equal(await page.locator('.live-board .used-up').count(), 0);
        assert.match(await page.textContent('.lead'), /guess where the robot will go/);
        await playToTheEnd(person);
        assert.equal(await page.locator('.live-board .used-up .station').count(), 1);
        assert.match(await page.textContent('.lead'), /Why do you think/);
      });
    });

    it('shows runs as they fell where chance has a part, and where the robot tried to go', async () => {
      await withViews(setting, async ({ views, person, page }) => {
        await show({ person, page }, views['watch-runs']);
        const text = () => page.textContent('main');
        assert.match(await text(), /Chance plays a part: here are 2 of its runs.*Run 1 of 2/s);
        assert.doesNotMatch(await text(), /In all:/);
        assert.equal(await page.locator('.tried').count(), 0, 'drawn before it is walked');
        await playToTheEnd(person);
        assert.equal(await page.locator('.live-board:not(.small) .tried').count(), 1);
        assert.match(await text(), /Why do you think the robot chose these moves\?.*Where the robot tried to go.*This is where the example ends\./s);
        assert.match(await text(), /In all: stopping at the charger in 1 of 2 runs; a different path in each of 2 runs\./);
        assert.ok((await page.locator('.live-board .intent').count()) > 0, 'where it means to go is not drawn');
        await page.getByRole('button', { name: /^Run 2: / }).click();
        assert.match(await text(), /Run 2 of 2/);
        await person.said('The robot has not moved yet.');
        await playToTheEnd(person);
        assert.match(await text(), /This is where the example ends\./);
      });
    });

    it('says what can follow from both moves at the fork where chance has a part', async () => {
      await withViews(setting, async ({ views, person, page }) => {
        await show({ person, page }, views['feedback-chance']);
        await page.waitForSelector('.fan');
        assert.equal(await page.locator('.fan .board').count(), 2);
        assert.match(await page.textContent('.fan'), /The robot tries to go .*2 of 3 tries.*You expected it to go .*cannot end in .*1 of 3 tries/s);
        assert.doesNotMatch(await page.textContent('.fan'), /on purpose/, 'it goes where it is free');
        await show({ person, page }, views['feedback-wrong']);
        assert.equal(await page.locator('.fan').count(), 0);
      });
    });

    it('says where a robot stops that has not finished its job, and names only keys that do something', async () => {
      await withViews(setting, async ({ views, person, page }) => {
        const { board } = views['predict-large'].predict;
        await show({ person, page }, { ...views.predict, predict: { ...views.predict.predict, board, world: 'hole', start: 0, draft: [] } });
        await page.waitForSelector('.pad-row');
        assert.doesNotMatch(await page.textContent('main'), /pick up or put down/);
        await page.keyboard.press('ArrowRight');
        await person.said('The robot cannot go on from here. Submit your answer, or undo some steps.');
      });
    });

    it('mentions no answer where there is only practice', async () => {
      await withViews(setting, async ({ views, person, page }) => {
        await show({ person, page }, views.check);
        await page.click('.intro [type=submit]');
        await person.drive(await person.best());
        await person.said('The robot has finished its job.');
        assert.doesNotMatch(await page.textContent('main'), /Submit|answer/i);
      });
    });

    it('says boards in words, without coordinates', async () => {
      await withViews(setting, async ({ views, person, page }) => {
        await show({ person, page }, views['feedback-wrong']);
        await playToTheEnd(person); // from where the paths part
        await person.button('Play again').click();
        await playToTheEnd(person);
        const log = await page.$$eval('[role=log] p', (all) => all.map(({ textContent }) => textContent));
        const said = log.slice(log.lastIndexOf('The robot has not moved yet.'));
        assert.ok(said.includes('The robot picks up the parcel.'), log.join(' '));
        assert.equal(said.length, views['feedback-wrong'].feedback.tests[0].robot.length, log.join(' '));
        await show({ person, page }, views.predict);
        const [first] = await person.best();
        await person.drive([first]);
        assert.match(await page.textContent('[role=log] p:last-child'), new RegExp(`^The robot moves ${first}\\b`));
        assert.match(await page.getAttribute('.board svg', 'aria-label'), /^Board with the robot, /);
        const cells = await page.$$eval('.in-words td', (all) => all.map(({ textContent }) => textContent));
        assert.equal(cells.length, 12);
        assert.ok(cells.some((cell) => /^the robot/.test(cell)) && cells.includes('a wall') && cells.includes('the parcel'), cells.join());
        const all = await page.evaluate(() => document.body.textContent);
        assert.doesNotMatch(all, /column \d|row \d|\(\d+,\d+\)/);
      });
    });

    it('draws no two things of a legend alike', async () => {
      await withViews(setting, async ({ views, person, page }) => {
        for (const name of ['patchwork', 'predict', 'predict-huge']) {
          await show({ person, page }, views[name]);
          await page.waitForSelector('.legend li');
          const drawn = await page.$$eval('.legend li svg', (all) =>
            all.map((svg) => {
              const id = /url\(#([^)]+)\)/.exec(svg.innerHTML)?.[1];
              const texture = id === undefined ? '' : document.getElementById(id).innerHTML;
              return svg.innerHTML.replace(/url\([^)]+\)/, '') + texture;
            }),
          );
          if (name === 'patchwork') assert.equal(drawn.length, 12, 'the terrains');
          assert.equal(new Set(drawn).size, drawn.length, name);
        }
      });
    });

    it('lets people leave the lobby when the time comes, without a word from the server', async () => {
      await withViews(
        setting,
        async ({ views, wire, person, page }) => {
          const at = Date.now();
          await show({ person, page }, { ...views.lobby, lobby: { ...views.lobby.lobby, leave_after_ms: at + 4000 }, server_ms: at });
          assert.match(await page.textContent('main'), /you can leave in/);
          assert.equal(await person.button('Leave the session').count(), 0);
          await person.pass(5000);
          await person.button('Leave the session').click();
          await page.locator('.sure').getByRole('button', { name: 'Leave the session' }).click();
          await until(() => wire.of('leave').length > 0);
        },
        { stopped: true },
      );
    });

    it('says how many moves are left before there are none', async () => {
      await withViews(setting, async ({ views, person, page }) => {
        await show({ person, page }, views['predict-handling']);
        const limit = () => page.textContent('.limit');
        await person.drive(['right', 'left']);
        assert.equal(await limit(), '', 'six are left');
        await person.drive(['right']);
        assert.equal(await limit(), '5 more moves are possible.');
        await person.drive(['left', 'right', 'left', 'right']);
        assert.equal(await limit(), '1 more move is possible.');
        await person.drive(['left']);
        assert.equal(await limit(), 'Your path cannot be longer. Submit it, or undo some steps.');
        await person.drive(['right']);
        await person.said('Your path cannot be longer.');
        await person.counts('8 steps');
        await person.button('Undo').click();
        assert.equal(await limit(), '1 more move is possible.');
      });
    });

    it('takes picking up and putting down at once for nothing', async () => {
      await withViews(setting, async ({ views, wire, person, page }) => {
        await show({ person, page }, views['predict-handling']);
        await page.waitForSelector('.pad-row');
        await page.locator('.mover').dblclick();
        await person.counts('0 steps');
        await page.locator('.mover').click();
        await person.counts('1 step');
        await person.drive(['right', 'left']);
        await page.locator('.mover').click();
        await person.counts('4 steps'); // what lies between is a path
        await person.button('Submit').click();
        await person.button('Submit anyway').click();
        await until(() => wire.of('answer').length > 0);
        const [{ body }] = wire.of('answer');
        assert.deepEqual(body.actions, [2, 1, 0, 3]);
        assert.deepEqual(body.keys.map(([key]) => key), [2, 'undo', 2, 1, 0, 3]);
      });
    });

    it('offers that it goes on for ever once a state occurs again, where that can be', async () => {
      await withViews(setting, async ({ views, wire, person, page }) => {
        const button = person.button('It goes on like this for ever');
        await show({ person, page }, views['predict-handling']);
        await person.drive(['right', 'left']);
        assert.equal(await button.count(), 0, 'here every path ends');
        await show({ person, page }, { ...views['predict-endless'], predict: { ...views['predict-endless'].predict, draft: [] } });
        await person.drive(['right']);
        assert.equal(await button.count(), 0, 'nothing has occurred again');
        await person.drive(['left']);
        assert.equal(await page.locator('.live-board .round').count(), 0);
        await button.click();
        assert.equal(await button.getAttribute('aria-pressed'), 'true');
        assert.deepEqual(await person.violations(setting.axe, ['color-contrast']), []);
        assert.equal(await page.locator('.live-board .round').count(), 1);
        await person.drive(['right']);
        assert.equal(await page.locator('.live-board .round').count(), 0, 'whoever goes on has said something else');
        await button.click();
        await button.click();
        assert.equal(await button.getAttribute('aria-pressed'), 'false');
        await button.click();
        await person.button('Submit').click();
        await until(() => wire.of('answer').length > 0);
        const [{ body }] = wire.of('answer');
        assert.deepEqual([body.actions, body.for_ever], [[1, 0, 1], true]);
      });
    });

    it('shows a path that never ends as its way in and its cycle, twice, and says so', async () => {
      await withViews(setting, async ({ views, person, page }) => {
        await show({ person, page }, views['watch-endless']);
        assert.match(await page.textContent('.count'), /Step 0 of 5/, 'one step on the way in, two rounds of two');
        const next = page.locator('.step-button').nth(1);
        for (let i = 0; i < 2; i += 1) await next.click();
        assert.equal(await page.locator('.live-board .round').count(), 0);
        await next.click();
        await person.said('And so on: it never delivers the parcel.');
        assert.equal(await page.locator('.live-board .round').count(), 1);
        const drawn = await person.drawn('own');
        await playToTheEnd(person);
        assert.equal(await person.drawn('own'), drawn, 'the cycle is drawn once');
        assert.match(await page.textContent('#watch-hint'), /^And so on: it never delivers the parcel\. You can/);
        await show({ person, page }, views['feedback-endless']);
        await playToTheEnd(person);
        await person.said('And so on: it never delivers the parcel.');
        assert.equal(await page.locator('.live-board .way.own .round').count(), 1);
        assert.equal(await page.locator('.live-board .way.other .round').count(), 0);
      });
    });

    it('asks for a sketch before an example, and shows what can be known, where the study wants it', async () => {
      await withViews(setting, async ({ views, person, page }) => {
        const [{ board, robot }] = views['feedback-wrong'].feedback.tests;
        const { world, start } = views.predict.predict;
        await show({ person, page }, { ...views.watch, watch: { index: 0, of: 1, board, frames: robot, world, state: start } });
        assert.match(await page.textContent('.lead'), /First sketch the path/);
        await person.drive([robot[0].action]);
        assert.match(await page.textContent('.ledger'), /Steps1/);
        await person.button('This is my guess').click();
        await person.button('Play').waitFor();
        assert.match(await page.textContent('main'), /The solid line is the path of the robot, the dashed line your guess\./);
        await page.keyboard.press('ArrowRight');
        await page.waitForSelector('.way.own');
        assert.equal(await person.drawn('other'), 2);
        const { feedback } = views['feedback-wrong'];
        const bracket = { feature: 0, reference: 2, low: [-4, 1], high: [-2, 1], ends: ['2', '4'], text: 'crossing rubble costs 2 to 4 steps' };
        await show({ person, page }, { ...views['feedback-wrong'], feedback: { ...feedback, brackets: [bracket] } });
        assert.match(await page.textContent('.bracket'), /Crossing rubble costs 2 to 4 steps\./);
        assert.equal(await page.locator('.bracket .end').count(), 2);
        assert.match(await page.textContent('.ledger'), /RobotYou/);
        assert.ok((await page.locator('.chip').count()) > 0);
      });
    });

    it('says why the group goes on to those who were right', async () => {
      await withViews(setting, async ({ views, person, page }) => {
        await show({ person, page }, views['feedback-others']);
        assert.match(await page.textContent('main'), /Some in your group are not sure yet; here is another example\./);
      });
    });

    it('ends with all that was taught, and apart from it what was not', async () => {
      await withViews(setting, async ({ views, person, page }) => {
        await show({ person, page }, views.debrief);
        const lists = await page.$$eval('.summary', (all) => all.map((one) => [one.querySelector('h2').textContent, one.querySelectorAll('li').length]));
        const { summary, not_reached } = views.debrief.debrief;
        assert.deepEqual(lists, [['What this robot is like', summary.length], ['What your session did not get to', not_reached.length]]);
      });
    });

    it('shows hostile texts as texts', async () => {
      await withViews(setting, async ({ views, person, page }) => {
        const tags = () =>
          page.evaluate(() => document.querySelectorAll('#page script, #page img, #page iframe, #page b, #page [onload], #page [onerror]').length);
        for (const text of kHostile) {
          for (const name of ['consent', 'lobby', 'watch', 'notice', 'feedback-wrong', 'questions', 'debrief', 'ended', 'mapless-watch']) {
            const { progress } = views[name];
            person.wire.show({ ...hostileView(views[name], text), stage: views[name].stage, ...(progress ? { progress } : {}) });
            await page.waitForSelector(`main.stage-${views[name].stage}`);
            await page.waitForFunction((title) => document.querySelector('.study-title')?.textContent === title, text);
            if (name === 'feedback-wrong') await playToTheEnd(person);
            assert.equal(await tags(), 0, `${name}: ${text}`);
            assert.equal(await page.locator('a[href^=javascript]').count(), 0);
          }
        }
        assert.equal(await page.evaluate(() => window.hacked), undefined);
      });
    });

    it('needs less than 200 kB of scripts, before compression', async () => {
      await withViews(setting, async ({ page }) => {
        const sizes = await page.evaluate(() =>
          performance.getEntriesByType('resource').flatMap(({ name, decodedBodySize }) => (/\.js$/.test(name) ? [decodedBodySize] : [])),
        );
        const sum = sizes.reduce((a, b) => a + b, 0);
        assert.ok(sum > 10_000 && sum < 200_000, `${sizes} bytes before compression`);
      });
    });
  });
}
