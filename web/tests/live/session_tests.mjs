// Journeys through whole sessions.
import assert from 'node:assert/strict';
import { describe, it } from 'node:test';
import { kQuestions, until, withServer } from '../kith.mjs';
import { withGroup } from './group.mjs';
import { reach } from './kith_tests.mjs';
import { openPerson } from './person.mjs';

const kForbidden = /"(weights|prior|bec|beliefs|particles|features|gain|runners_up)"/;
const kRedirect = 'completion = { redirect = "https://example.org/done?code={code}" }';

export function sessionTests(setting) {
  describe('a session', () => {
    it('takes three people from consent to their codes, with right and wrong answers, and tells nothing too early', async () => {
      await withGroup(setting, { size: 3, group: `${kRedirect}${kQuestions}` }, async ({ people }) => {
        const [first, second] = people;
        const seen = [];
        const look = async () => seen.push(await first.page.evaluate(() => `${document.title}\n${document.body.innerText}`));
        await look();
        for (const person of people) {
          await person.consent();
          await person.check();
        }
        for (const person of people) {
          const lengths = [];
          let left = await person.examples();
          await person.at('Watch the robot');
          assert.equal(await person.drawn('own'), 0);
          assert.equal(await person.button('Next').getAttribute('aria-disabled'), 'true');
          await person.watch(async () => lengths.push(await person.drawn('own')));
          assert.ok(lengths.every((n, i) => i === 0 || n >= lengths[i - 1]) && lengths[0] < lengths.at(-1), `drawn: ${lengths}`);
          for (left -= 1; left > 0; left -= 1) await person.watch();
        }
        await first.atStage('predict');
        await look();
        await first.answer((await first.best()).slice(0, 2));
        await first.at('Waiting for the others');
        assert.match(await first.page.textContent('main'), /2 people are still working.*You will see what the robot/s);
        for (const person of people.slice(1)) await person.answer();
        await first.at('Not quite');
        await second.at('Correct');
        await first.page.waitForSelector('.mover.ghost'); // both set out by themselves
        await reach(people, ['questions']);
        for (const person of people) await fillIn(person);
        const { summary, not_reached, right, tests, rounds, code } = first.view.debrief;
        assert.ok(right < tests && second.view.debrief.right === tests);
        const last = await first.page.textContent('main');
        assert.ok(last.includes(`in ${right} of ${tests} tasks, over ${rounds} rounds`) && last.includes(code), last);
        assert.match(last, /Your first prediction: the dashed line is yours.*Your last prediction: right\./s);
        assert.equal(await first.page.locator('.summary figure .live-board').count(), 2);
        await second.button('Copy the code').click();
        await second.page.waitForFunction(() => document.querySelector('.copied').textContent.includes('Copied'));
        assert.equal(await first.page.getAttribute('a.button', 'href'), `https://example.org/done?code=${code}`);

        for (const text of seen) {
          for (const secret of [...summary, ...not_reached]) assert.ok(!text.toLowerCase().includes(secret.toLowerCase()), secret);
          assert.doesNotMatch(text, /\(\d+,\d+\)|\bworld \d|\bMDP\b|half-space|knowledge component/i);
        }
        for (const { wire, frames } of people) {
          for (const { body } of wire.of('answer')) {
            assert.ok(body.ms > 0 && body.keys.length >= body.actions.length && body.round > 0);
            assert.ok(body.keys.every(([, ms], i) => ms >= 0 && (i === 0 || ms >= body.keys[i - 1][1])));
          }
          assert.deepEqual(wire.of('questions')[0].body.answers, { clear: 6, robots: 'sometimes', free: 'nothing' });
          const early = frames.filter(({ t, view }) => t === 'view' && !['feedback', 'debrief'].includes(view.stage));
          for (const frame of early) assert.doesNotMatch(JSON.stringify(frame), kForbidden);
        }
      });
    });

    it('works by keyboard alone', async () => {
      await withGroup(setting, { keys: ['stop.max_periods=1'], group: `ask_name = true${kQuestions}`, look: { stopped: true } }, async ({ person, page, wire }) => {
        const press = async (key, times = 1) => {
          for (let i = 0; i < times; i += 1) await page.keyboard.press(key);
        };
        const tabTo = async (name) => {
          for (let i = 0; i < 40; i += 1) {
            await press('Tab');
            const found = await page.evaluate(() => document.activeElement.textContent.trim() || document.activeElement.type);
            if (found === name) return;
          }
          assert.fail(`no way to '${name}' by Tab`);
        };
        const pressButton = async (name) => {
          await tabTo(name);
          const ring = await page.evaluate(() => getComputedStyle(document.activeElement).outlineStyle);
          assert.notEqual(ring, 'none', `no visible focus on '${name}'`);
          await press('Enter');
        };
        await person.at('Before you start');
        await tabTo('checkbox');
        await press('Space');
        await pressButton('Agree and continue');
        await person.at('What this is about');
        await tabTo('text');
        await page.keyboard.type('Ada');
        await pressButton('Continue');
        await person.at('Try the controls');
        await until(() => wire.of('name').some(({ body }) => body.name === 'Ada'));
        await page.waitForSelector('.drive-area'); // the robot can be driven once its world has loaded
        const pressAll = async (names) => {
          for (const name of names) await press(name.match(/pickup|dropoff/) ? ' ' : `Arrow${name[0].toUpperCase()}${name.slice(1)}`);
        };
        const names = await person.best();
        await pressAll(names.slice(0, 1));
        await press('Backspace');
        await pressAll(names);
        await person.said('puts down the parcel');
        await pressButton('Continue');
        const examples = await person.examples();
        for (let index = 1; index <= examples; index += 1) {
          await page.waitForFunction((i) => document.querySelector('.kicker')?.textContent.startsWith(`Example ${i}`), index);
          await press('ArrowRight', person.view.watch.frames.length - 1);
          await pressButton('Next');
        }
        await person.at('What will the robot do?');
        await page.waitForSelector('.drive-area');
        await pressAll(await person.best());
        assert.equal(await page.evaluate(() => window.scrollY), 0, 'the page scrolled');
        await pressButton('Submit');
        await person.at('Correct');
        await pressButton('Continue');
        await person.at('A few questions');
        await tabTo('radio');
        await press('ArrowRight');
        await tabTo('radio');
        await tabTo('radio');
        await press(' ');
        await tabTo('textarea');
        await page.keyboard.type('arrow keys');
        await pressButton('Submit');
        await person.at('Thank you');
      });
    });

    it('is driven by the pad and by clicks on cells, undone and reset', async () => {
      await withGroup(setting, {}, async ({ wire, person, page }) => {
        await person.toPredict();
        const { board } = person.view.predict;
        const { robot, items } = board.start;
        const click = async ([column, row]) => {
          const box = await page.locator('.board svg .floor').boundingBox();
          await page.mouse.click(box.x + ((column - 0.5) * box.width) / board.domain.width, box.y + ((row - 0.5) * box.height) / board.domain.height);
        };
        const held = await page.evaluate(() =>
          Array.from({ length: 10 }, () => {
            const init = { key: 'ArrowDown', repeat: true, bubbles: true, cancelable: true };
            return document.body.dispatchEvent(new KeyboardEvent('keydown', init));
          }),
        );
        assert.ok(held.every((scrolls) => !scrolls), 'the page would scroll');
        await person.button('Start over').click();
        await click(items[0].cell); // the robot goes there
        const steps = await page.textContent('.submit p');
        assert.doesNotMatch(steps, /^0 /);
        await click(items[0].cell); // the robot itself: it picks up
        await person.said('picks up the parcel');
        await page.keyboard.press('Backspace');
        await person.said('One step undone');
        await person.counts(steps);
        const wall = board.map.flatMap((line, y) => [...line].map((symbol, x) => [symbol, [x + 1, y + 1]])).find(([symbol]) => symbol === '#');
        if (wall) {
          await click(wall[1]);
          await person.said('cannot get there');
        }
        await person.button('Start over').click();
        await person.counts('0 steps');
        for (let i = 0; i < board.domain.height; i += 1) await person.button(robot[1] > 1 ? 'Up' : 'Down').click();
        await person.said('cannot do that here');
        await person.button('Submit').click();
        await person.counts('has not finished');
        await person.button('Keep going').click();
        await person.button('Submit').click();
        await person.button('Submit anyway').click();
        await until(() => wire.of('answer').length > 0);
        const { keys } = wire.of('answer')[0].body;
        assert.deepEqual(keys.map(([press]) => press).filter((press) => typeof press === 'string'), ['reset', 'undo', 'reset']);
      });
    });

    it('moves in single steps for people who ask for less motion', async () => {
      await withGroup(setting, { look: { reducedMotion: true } }, async ({ person, page }) => {
        await person.consent();
        await person.check();
        await person.at('Watch the robot');
        await person.button('Play').click();
        await page.waitForSelector('.live-board .way.own');
        assert.equal(await page.$eval('.mover', (mover) => getComputedStyle(mover).transitionDuration), '0s');
      });
    });

    it('is joined with a code; what the platform put into the link is kept, and a reload takes no second seat', async () => {
      await withServer(setting.kith, { group: 'collect_query = ["PROLIFIC_PID"]' }, async ({ server }) => {
        const person = await openPerson(setting.browser, `${server.origin}/?code=nope&PROLIFIC_PID=p%201`, {});
        const { page } = person;
        const joins = [];
        page.on('request', (request) => request.url().endsWith('/api/join') && joins.push(request.postDataJSON()));
        person.expectLosses();
        await person.open();
        await person.at('Join a session');
        await person.button('Join').click();
        await page.waitForFunction(() => document.querySelector('[role=alert]').textContent.startsWith('There is no session'));
        await page.fill('#code', '');
        await person.button('Join').click();
        await page.waitForFunction(() => document.querySelector('[role=alert]').textContent === 'Please enter the code.');
        await page.fill('#code', ` ${server.code.toLowerCase()} `);
        await person.button('Join').click();
        await person.at('Before you start');
        assert.deepEqual(joins.at(-1).query, { PROLIFIC_PID: 'p 1' });
        await page.reload();
        await person.at('Before you start');
        assert.equal(joins.length, 2, 'the wrong code and the right one');
        await page.goto(server.origin);
        await person.button('Return to your session').click();
        await person.consent();
        await until(() => person.wire.of('consent').length > 0);
        assert.deepEqual(person.wire.of('consent')[0].body.query, { PROLIFIC_PID: 'p 1' });
        assert.deepEqual(person.trouble, []);
        await person.close();
      });
    });

    it('can be declined, after a second question', async () => {
      await withGroup(setting, {}, async ({ person }) => {
        await person.at('Before you start');
        await person.button('Agree and continue').click();
        assert.match(await person.page.textContent('[role=alert].error'), /Tick the box/);
        const [download] = await Promise.all([person.page.waitForEvent('download'), person.button('Save a copy of this text').click()]);
        assert.equal(download.suggestedFilename(), 'consent.txt');
        await person.button('Do not take part').click();
        await person.button('Go back').click();
        await person.button('Do not take part').click();
        await person.button('End the session for me').click();
        await person.at('You are not taking part');
        assert.equal(person.view.stage, 'declined');
      });
    });

    it('speaks the language of the study, from right to left where that is how it is written', async () => {
      const own = { lang: 'ar', dir: 'rtl', strings: { 'consent.title': '\u0642\u0628\u0644 \u0623\u0646 \u062a\u0628\u062f\u0623' } };
      const speaking = (texts, look = {}) => ({ group: 'language = "texts.json"', files: { 'texts.json': JSON.stringify(texts) }, look });
      await withGroup(setting, speaking(own, { width: 320, height: 640 }), async ({ person, page }) => {
        await person.at(own.strings['consent.title']);
        assert.deepEqual(await page.evaluate(() => [document.documentElement.lang, document.documentElement.dir]), ['ar', 'rtl']);
        assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= document.documentElement.clientWidth));
      });
      await withGroup(setting, speaking({ lang: 'de', dir: 'ltr', strings: {} }), async ({ person }) => {
        await person.at('Bevor Sie beginnen');
      });
    });
  });
}

async function fillIn(person) {
  await person.at('A few questions');
  const { page } = person;
  await person.button('Submit').click();
  await page.waitForFunction(() => document.activeElement.type === 'radio');
  assert.match(await page.textContent('[role=alert].error'), /2 questions still need an answer/);
  await page.getByRole('radio', { name: '6', exact: true }).check();
  await page.getByRole('radio', { name: 'sometimes' }).check();
  await page.getByRole('textbox').fill('nothing');
  await page.reload();
  await person.at('A few questions');
  assert.equal(await page.getByRole('textbox').inputValue(), 'nothing');
  await person.button('Submit').click();
  await person.at('Thank you');
}
