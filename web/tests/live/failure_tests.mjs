// What goes wrong around a session: nothing that somebody did may be lost, and no page may be left without a way on.
import assert from 'node:assert/strict';
import { describe, it } from 'node:test';
import { begin, lesson, withGroup } from './group.mjs';
import { openPerson } from './person.mjs';
import { kQuestions, makeViews } from './views.mjs';

// What somebody does must not have to wait for the page: these journeys take place in a single moment.
const kStopped = { stopped: true };

const answersOf = (room) => room.log.filter(({ type }) => type === 'answer');

async function toPredict(person) {
  await begin([person]);
  await person.watch();
  await person.watch();
  await person.atStage('predict');
  await person.page.waitForSelector('.drive-area');
}

export function failureTests(setting) {
  describe('a session in trouble', () => {
    it('is where it was after a reload of any screen', async () => {
      await withGroup(setting, { parts: 1, screening: 1, questions: kQuestions, look: kStopped }, async ({ person, page }) => {
        const reload = async () => {
          const before = await person.heading();
          await page.reload();
          await person.at(before);
        };
        await person.at('Before you start');
        await reload();
        await person.consent();
        await person.at('What this is about');
        await reload();
        await person.button('Continue').click();
        await person.at('Try the controls');
        await reload();
        await person.drive(await person.best());
        await reload();
        await person.button('Continue').click();
        await person.at('A few tasks to begin with');
        await person.drive(['up']);
        await reload();
        await person.counts('1 step');
        await person.button('Submit').click();
        await person.button('Submit anyway').click();
        await person.at('Watch the robot');
        await reload();
        await person.button('Next step').click();
        await page.keyboard.press('ArrowRight');
        for (let i = 2; i < person.view.watch.frames.length - 1; i += 1) await page.keyboard.press('ArrowRight');
        await reload();
        await person.button('Next').click(); // it has been watched once
        await page.waitForFunction(() => document.querySelector('.kicker').textContent.startsWith('Example 2'));
        await person.watch();
        await person.atStage('predict');
        await person.drive(['down', 'right']);
        await reload();
        await person.counts('2 steps');
        await person.button('Start over').click();
        await person.answer();
        await person.at('Correct');
        await reload();
        await person.feedback();
        await person.at('A few questions');
        await reload();
        await page.getByRole('radio', { name: '6', exact: true }).check();
        await page.getByRole('radio', { name: 'never' }).check();
        await person.button('Submit').click();
        await person.at('Thank you');
        await reload();
      });
    });

    it('is taken over by a second tab, and back', async () => {
      await withGroup(setting, { look: kStopped }, async ({ mock, person }) => {
        await person.at('Before you start');
        const other = await openPerson(setting.browser, mock.link(1), {});
        await other.open();
        await other.at('Before you start');
        await person.at('Open in another tab');
        await person.pass(60_000); // it does not fight for the session
        assert.equal(mock.numHellos, 2);
        await other.at('Before you start');
        await person.button('Use this tab instead').click();
        await person.at('Before you start');
        await other.at('Open in another tab');
        assert.deepEqual(other.trouble, []);
        await other.close();
      });
    });

    it('continues a path in another browser from the last draft', async () => {
      await withGroup(setting, {}, async ({ mock, room, person }) => {
        await toPredict(person);
        await person.drive(['down', 'right']);
        await person.until(() => room.seats[0].draft.length === 2);
        const other = await openPerson(setting.browser, mock.link(1), {});
        await other.open();
        await other.page.waitForSelector('.drive-area');
        await other.counts('2 steps');
        await other.drive(['right']);
        await person.until(() => room.seats[0].draft.length === 3);
        await person.button('Use this tab instead').click();
        await person.page.waitForSelector('.drive-area');
        await person.counts('3 steps');
        await other.close();
      });
    });

    it('sends a draft of a path at once, and then every two seconds', async () => {
      await withGroup(setting, { look: kStopped }, async ({ mock, person }) => {
        const drafts = () => mock.received.filter(({ t }) => t === 'draft').map(({ body }) => body.actions.length);
        await toPredict(person);
        await person.drive(['down']);
        await person.pass(1);
        await person.until(() => drafts().length === 1);
        await person.drive(['right']);
        await person.pass(1000);
        await person.drive(['right']);
        await person.pass(1000);
        await person.until(() => drafts().length > 1);
        assert.deepEqual(drafts(), [1, 3]);
      });
    });

    it('loses no answer that is given offline, and sends it once', async () => {
      await withGroup(setting, { look: kStopped }, async ({ mock, room, person, page }) => {
        person.expectLosses();
        await toPredict(person);
        await person.drive(['down']);
        await person.context.setOffline(true);
        mock.isDown = true;
        mock.drop();
        await person.hasStatus('Reconnecting');
        await person.drive(['right', 'right', 'pickup', 'left', 'left', 'left', 'dropoff']);
        await person.button('Submit').click();
        await person.pass(3000);
        await page.waitForFunction(() => document.querySelector('.message.warning')?.textContent.includes('was lost'));
        await person.counts('being saved');
        mock.up();
        await person.context.setOffline(false);
        await person.at('Not quite');
        assert.equal(answersOf(room).length, 1);
        await person.hasStatus('Saved');
      });
    });

    it('survives a restart of the server, with a reload in between', async () => {
      await withGroup(setting, {}, async ({ mock, room, person, page }) => {
        person.expectLosses();
        await toPredict(person);
        mock.holdsAcks = true;
        await person.drive(await person.best());
        await person.button('Submit').click();
        await person.until(() => answersOf(room).length > 0);
        assert.match(await page.textContent('.status'), /Saving/);
        mock.down(); // committed, but not acknowledged
        mock.holdsAcks = false;
        mock.held = [];
        mock.up();
        await page.reload();
        await person.at('Correct');
        assert.equal(answersOf(room).length, 1);
        const sent = mock.received.filter(({ t }) => t === 'answer');
        assert.ok(sent.length >= 2 && sent.every(({ id }) => id === sent[0].id), 'not sent again with the same id');
        await person.hasStatus('Saved');
      });
    });

    it('tries again after connections that break, and sends again what is not acknowledged', async () => {
      await withGroup(setting, { look: kStopped }, async ({ mock, person }) => {
        person.expectLosses();
        await person.at('Before you start');
        for (let i = 0; i < 3; i += 1) {
          mock.drop();
          await person.hasStatus('Reconnecting');
          await person.pass(500);
          await person.page.waitForSelector('.status.saved', { state: 'attached' }); // says nothing before the consent
        }
        mock.holdsAcks = true;
        await person.consent();
        await person.until(() => mock.received.length === 1);
        await person.pass(21_000);
        await person.hasStatus('Reconnecting');
        await person.pass(500);
        await person.until(() => mock.received.length === 2);
        assert.equal(mock.received[0].id, mock.received[1].id);
        mock.releaseAcks();
        await person.hasStatus('Saved');
        await person.at('What this is about');
      });
    });

    it('says what to do when the link is wrong, when somebody was removed, and when a link is the organiser\'s', async () => {
      await withGroup(setting, {}, async ({ mock, person, page }) => {
        await person.at('Before you start');
        mock.bye(1, 'removed');
        await person.at('You were removed from the session');
        await person.button('Try again').click();
        await person.at('Before you start');
        await page.goto('about:blank');
        await page.goto(`${mock.address}/j#t=0123456789abcdef`);
        await person.at('This link does not work');
        await person.button('Enter a code').click();
        await person.at('Join a session');
        await page.goto('about:blank');
        await page.goto(`${mock.address}/j#t=facilitator-token`);
        await person.at('Facilitator');
      });
    });

    it('shows a pause, says a refusal, and takes messages of the organiser away when they are read', async () => {
      await withGroup(setting, {}, async ({ mock, room, person, page }) => {
        await toPredict(person);
        room.pause = { why: 'someone-away', since_ms: Date.now(), until_ms: Date.now() + 60_000, missing: 1 };
        mock.update();
        await page.waitForSelector('.pause');
        assert.match(await page.textContent('.pause'), /1 person in your group has lost the connection.*at the latest/s);
        await page.keyboard.press('ArrowDown');
        await person.counts('0 steps');
        room.pause = null;
        room.notices = [{ text: 'Five more minutes', at_ms: Date.now() }];
        mock.update();
        await page.waitForSelector('.message.notice');
        await person.button('OK').click();
        await page.waitForSelector('.message.notice', { state: 'detached' });
        await page.reload();
        await page.waitForSelector('.drive-area');
        assert.equal(await page.locator('.message.notice').count(), 0);
        room.answered = () => 'the time is over';
        await person.drive(await person.best());
        await person.button('Submit').click();
        await page.waitForSelector('.message.warning');
        assert.match(await page.textContent('.message.warning'), /not accepted.*The time is over\./s);
        assert.equal(await person.button('Submit').getAttribute('aria-disabled'), null);
      });
    });

    it('counts on the server\'s clock, a day off in either direction', async () => {
      for (const skew of [-86_400_000, 86_400_000]) {
        await withGroup(setting, { look: kStopped }, async ({ mock, person, page }) => {
          const { views } = makeViews(lesson, Date.now() + skew);
          mock.show(1, views.lobby);
          await person.at('Waiting for your group');
          assert.match(await page.textContent('main .time'), /1:05/);
          await person.pass(2100);
          assert.match(await page.textContent('main .time'), /1:07/);
          assert.match(await page.textContent('.next-step'), /leave in 3:52/);
        });
      }
    });
  });
}
