// Journeys through whole sessions.
import assert from 'node:assert/strict';
import { describe, it } from 'node:test';
import { begin, lesson, withGroup } from './group.mjs';
import { openPerson } from './person.mjs';
import { kQuestions } from './views.mjs';

export function sessionTests(setting) {
  describe('a session', () => {
    it('takes three people from consent to their codes, with right and wrong answers', async () => {
      const options = { size: 3, parts: 2, questions: kQuestions, redirect: 'https://example.org/done' };
      await withGroup(setting, options, async ({ room, people }) => {
        await begin(people);
        for (const person of people) {
          const lengths = [];
          await person.watch(async () => lengths.push(await person.drawn('own')));
          assert.ok(lengths.every((n, i) => i === 0 || n >= lengths[i - 1]) && lengths[0] < lengths.at(-1), `drawn: ${lengths}`);
          await person.watch();
        }
        const wrong = ['right', 'down', 'right', 'pickup', 'left', 'left', 'left', 'dropoff'];
        await people[0].answer(wrong);
        await people[0].at('Waiting for the others');
        assert.match(await people[0].page.textContent('main'), /2 people are still working.*You will see what the robot/s);
        await people[1].answer();
        await people[2].answer();
        await people[0].at('Not quite');
        await people[1].at('Correct');
        await people[0].page.waitForSelector('.mover.ghost'); // both set out by themselves
        for (const person of people) await person.feedback();
        for (const [period, tests] of [[1, 1], [2, 2]]) {
          for (const person of people) {
            await person.until(() => person.view.stage === 'watch');
            for (let i = person.view.watch.of; i > 0; i -= 1) await person.watch();
          }
          for (const person of people) await person.answer();
          for (const person of people) {
            await person.at('Correct');
            assert.equal(person.view.feedback.tests.length, tests, `period ${period}`);
          }
          for (const person of people) await person.feedback();
        }
        for (const person of people) await fillIn(person);
        assert.match(await people[0].page.textContent('main'), /in 3 of 4 tasks, over 3 rounds.*MOCK-1X7Q/s);
        assert.match(await people[1].page.textContent('main'), /in 4 of 4 tasks/);
        const last = await people[0].page.textContent('main');
        assert.match(last, /Your first prediction: the dashed line is yours.*Your last prediction: right\./s);
        assert.equal(await people[0].page.locator('.summary figure .live-board').count(), 2);
        await people[1].button('Copy the code').click();
        await people[1].page.waitForFunction(() => document.querySelector('.copied').textContent.includes('Copied'));
        assert.equal(await people[0].page.getAttribute('a.button', 'href'), 'https://example.org/done');
        const answers = room.log.filter(({ type }) => type === 'answer');
        assert.equal(answers.length, 12);
        for (const { body } of answers) {
          assert.ok(body.ms > 0 && body.keys.length >= body.actions.length);
          assert.ok(body.keys.every(([, ms], i) => ms >= 0 && (i === 0 || ms >= body.keys[i - 1][1])));
        }
        assert.deepEqual(room.log.find(({ type }) => type === 'questions').body.answers, { clear: 6, robots: 'sometimes', free: 'nothing' });
      });
    });

    it('tells nothing before it is time, and nothing in terms of ours', async () => {
      await withGroup(setting, {}, async ({ person, page }) => {
        const seen = [];
        const look = async () => seen.push(await page.evaluate(() => `${document.title}\n${document.body.innerText}`));
        await look();
        await begin([person]);
        await person.at('Watch the robot');
        await look();
        assert.equal(await person.drawn('own'), 0);
        assert.equal(await person.button('Next').getAttribute('aria-disabled'), 'true');
        await person.button('Next step').click();
        await person.button('Previous step').click();
        assert.equal(await person.drawn('own'), 0);
        await person.watch();
        await person.watch();
        await person.atStage('predict');
        await look();
        const told = lesson.components.flatMap(({ name, sentences, demonstrations }) => [
          name,
          ...sentences.map(({ text }) => text),
          ...demonstrations.map(({ reason }) => reason),
        ]);
        for (const text of seen) {
          for (const secret of told) assert.ok(!text.toLowerCase().includes(secret.toLowerCase()), secret);
          assert.ok(!text.includes(lesson.domain.title));
        }
        await person.answer(['right', 'down', 'right', 'pickup', 'left', 'left', 'left', 'dropoff']);
        await person.at('Not quite');
        await page.waitForSelector('.reasons');
        await look();
        for (const text of seen) assert.doesNotMatch(text, /\(\d+,\d+\)|\bworld \d|\bMDP\b|half-space|knowledge component/i);
      });
    });

    it('works by keyboard alone', async () => {
      await withGroup(setting, { parts: 1, questions: kQuestions, askName: true, look: { stopped: true } }, async ({ room, person, page }) => {
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
        await person.until(() => room.seats[0].name === 'Ada');
        await page.waitForSelector('.drive-area'); // the robot can be driven once its world has loaded
        await press('ArrowUp', 2);
        await press('Backspace');
        await press('ArrowUp');
        await press(' ');
        await press('ArrowLeft');
        await press('ArrowDown', 2);
        await press('ArrowLeft');
        await press(' ');
        await person.said('puts down the parcel');
        await pressButton('Continue');
        for (const index of [1, 2]) {
          await page.waitForFunction((i) => document.querySelector('.kicker')?.textContent.startsWith(`Example ${i}`), index);
          await press('ArrowRight', person.view.watch.frames.length - 1);
          await pressButton('Next');
        }
        await person.at('What will the robot do?');
        const names = await person.best();
        await page.waitForSelector('.drive-area');
        for (const name of names) {
          await press(name.match(/pickup|dropoff/) ? ' ' : `Arrow${name[0].toUpperCase()}${name.slice(1)}`);
        }
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
      await withGroup(setting, {}, async ({ mock, person, page }) => {
        await begin([person]);
        await person.watch();
        await person.watch();
        await person.atStage('predict');
        const click = async (column, row) => {
          const box = await page.locator('.board svg .floor').boundingBox();
          await page.mouse.click(box.x + ((column - 0.5) * box.width) / 4, box.y + ((row - 0.5) * box.height) / 3);
        };
        await page.waitForSelector('.drive-area');
        const held = await page.evaluate(() =>
          Array.from({ length: 10 }, () => {
            const init = { key: 'ArrowDown', repeat: true, bubbles: true, cancelable: true };
            return document.body.dispatchEvent(new KeyboardEvent('keydown', init));
          }),
        );
        assert.ok(held.every((scrolls) => !scrolls), 'the page would scroll');
        await person.counts('1 step');
        await person.button('Undo').click();
        await person.counts('0 steps');
        await click(4, 3); // where the parcel is, three cells away
        await person.counts('3 steps');
        await click(1, 1); // a wall
        await person.said('cannot get there');
        await click(4, 3); // the robot itself: it picks up
        await person.said('picks up the parcel');
        await person.button('Undo').click();
        await person.counts('3 steps');
        await person.button('Start over').click();
        await person.counts('0 steps');
        await person.button('Up').click();
        await person.button('Up').click(); // the edge
        await person.said('cannot do that here');
        await person.button('Submit').click();
        await person.counts('has not finished');
        await person.button('Keep going').click();
        await person.counts('1 step');
        await person.button('Submit').click();
        await person.button('Submit anyway').click();
        await person.at('Not quite');
        const { keys } = mock.received.find(({ t }) => t === 'answer').body;
        assert.deepEqual(keys.map(([press]) => press).filter((press) => typeof press === 'string'), ['undo', 'undo', 'reset']);
      });
    });

    it('moves in single steps for people who ask for less motion', async () => {
      await withGroup(setting, { look: { reducedMotion: true } }, async ({ person, page }) => {
        await begin([person]);
        await person.at('Watch the robot');
        await person.button('Play').click();
        await page.waitForSelector('.live-board .way.own');
        assert.equal(await page.$eval('.mover', (mover) => getComputedStyle(mover).transitionDuration), '0s');
      });
    });

    it('is joined with a code; what the platform put into the link is kept, and a reload takes no second seat', async () => {
      await withGroup(setting, { size: 1, open: 0 }, async ({ mock, room }) => {
        const first = await openPerson(setting.browser, `${mock.address}/?code=nope&PROLIFIC_PID=p%201`, {});
        first.expectLosses();
        await first.open();
        await first.at('Join a session');
        await first.button('Join').click();
        await first.page.waitForFunction(() => document.querySelector('[role=alert]').textContent.startsWith('There is no session'));
        await first.page.fill('#code', '');
        await first.button('Join').click();
        await first.page.waitForFunction(() => document.querySelector('[role=alert]').textContent === 'Please enter the code.');
        await first.page.fill('#code', ' robot ');
        await first.button('Join').click();
        await first.at('Before you start');
        assert.deepEqual(room.seats[0].query, { PROLIFIC_PID: 'p 1' });
        await first.page.reload();
        await first.at('Before you start');
        assert.equal(mock.joined, 1);
        await first.page.goto(mock.address);
        await first.button('Return to your session').click();
        await first.at('Before you start');
        const second = await openPerson(setting.browser, `${mock.address}/j?code=ROBOT`, {});
        await second.open();
        await second.button('Join').click();
        await second.at('All places are taken');
        assert.match(await second.page.textContent('main'), /MOCK-FULL/);
        assert.deepEqual([...first.trouble, ...second.trouble], []);
        await first.close();
        await second.close();
      });
    });

    it('can be declined, after a second question', async () => {
      await withGroup(setting, {}, async ({ room, person }) => {
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
        assert.equal(room.seats[0].stage, 'declined');
      });
    });

    it('speaks the language of the study, from right to left where that is how it is written', async () => {
      const own = { lang: 'ar', dir: 'rtl', strings: { 'consent.title': '\u0642\u0628\u0644 \u0623\u0646 \u062a\u0628\u062f\u0623' } };
      await withGroup(setting, { language: own, look: { width: 320, height: 640 } }, async ({ person, page }) => {
        await person.at(own.strings['consent.title']);
        assert.deepEqual(await page.evaluate(() => [document.documentElement.lang, document.documentElement.dir]), ['ar', 'rtl']);
        assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= document.documentElement.clientWidth));
      });
      await withGroup(setting, { language: { lang: 'de', dir: 'ltr', strings: {} } }, async ({ person }) => {
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
