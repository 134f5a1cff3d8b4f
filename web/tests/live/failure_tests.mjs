// What goes wrong around a session: nothing that somebody did may be lost, and no page may be left without a way on.
import assert from 'node:assert/strict';
import { describe, it } from 'node:test';
import { Client, kQuestions, until } from '../kith.mjs';
import { withGroup } from './group.mjs';
import { openPerson } from './person.mjs';

// What somebody does must not have to wait for the page: these journeys take place in a single moment.
const kStopped = { stopped: true };

// The link of a person's seat, as another browser opens it.
const linkOf = async ({ page, origin }) => `${origin}/j#t=${await page.evaluate(() => JSON.parse(sessionStorage.getItem('kith.token')))}`;

export function failureTests(setting) {
  describe('a session in trouble', () => {
    it('is where it was after a reload of any screen, and new for whoever comes next', async () => {
      await withGroup(setting, { keys: ['stop.max_periods=1', 'group.screening.tests=1'], group: kQuestions, look: kStopped }, async ({ person, page }) => {
        const reload = async (heading) => {
          const before = heading ?? (await person.heading());
          await person.at(before);
          await page.reload();
          await person.at(before);
        };
        await reload('Before you start');
        await person.consent();
        await reload('What this is about');
        await person.button('Continue').click();
        await reload('Try the controls');
        await person.drive(await person.best());
        await reload();
        await person.button('Continue').click();
        await person.at('A few tasks to begin with');
        await person.drive((await person.best()).slice(0, 1));
        await reload();
        await person.counts('1 step');
        await person.button('Submit').click();
        await person.button('Submit anyway').click();
        const examples = await person.examples();
        await reload('Watch the robot');
        await person.button('Next step').click();
        await page.keyboard.press('ArrowRight');
        for (let i = 2; i < person.view.watch.frames.length - 1; i += 1) await page.keyboard.press('ArrowRight');
        await reload();
        await person.button('Next').click(); // it has been watched once
        await until(() => person.view.stage !== 'watch' || person.view.watch.index === 1);
        for (let left = examples - 1; left > 0; left -= 1) await person.watch();
        await person.atStage('predict');
        await person.drive((await person.best()).slice(0, 2));
        await reload();
        await person.counts('2 steps');
        await person.button('Start over').click();
        await person.answer();
        await reload('Correct');
        await person.feedback();
        await reload('A few questions');
        await page.getByRole('radio', { name: '6', exact: true }).check();
        await page.getByRole('radio', { name: 'never' }).check();
        await person.button('Submit').click();
        await reload('Thank you');
        await person.open();
        await person.button('Join').click();
        await person.button('I am somebody else').click();
        await person.consent();
        await person.at('What this is about');
      });
    });

    it('is taken over by a second tab, and back', async () => {
      await withGroup(setting, { look: kStopped }, async ({ person, wire }) => {
        await person.at('Before you start');
        const other = await openPerson(setting.browser, await linkOf(person), {});
        await other.open();
        await other.at('Before you start');
        await person.at('Open in another tab');
        await person.pass(60_000); // it does not fight for the session
        assert.equal(wire.numOpened, 1);
        await other.at('Before you start');
        await person.button('Use this tab instead').click();
        await person.at('Before you start');
        await other.at('Open in another tab');
        assert.deepEqual(other.trouble, []);
        await other.close();
      });
    });

    it('continues a path in another browser from the last draft', async () => {
      await withGroup(setting, {}, async ({ wire, person }) => {
        await person.toPredict();
        const best = await person.best();
        const drafted = (at, n) =>
          until(() => at.of('draft').some(({ id, body }) => body.actions.length === n && at.acknowledged.has(id)));
        await person.drive(best.slice(0, 2));
        await drafted(wire, 2);
        const other = await openPerson(setting.browser, await linkOf(person), {});
        await other.open();
        await other.page.waitForSelector('.drive-area');
        await other.counts('2 steps');
        await other.drive(best.slice(2, 3));
        await drafted(other.wire, 3);
        await person.button('Use this tab instead').click();
        await person.page.waitForSelector('.drive-area');
        await person.counts('3 steps');
        await other.close();
      });
    });

    it('sends a draft of a path at once, and then every two seconds', async () => {
      await withGroup(setting, { look: kStopped }, async ({ wire, person }) => {
        const drafts = () => wire.of('draft').map(({ body }) => body.actions.length);
        await person.toPredict();
        const [one, two, three] = await person.best();
        await person.drive([one]);
        await person.pass(1);
        await until(() => drafts().length === 1);
        await person.drive([two]);
        await person.pass(1000);
        await person.drive([three]);
        await person.pass(1000);
        await until(() => drafts().length > 1);
        assert.deepEqual(drafts(), [1, 3]);
      });
    });

    it('loses no answer that is given offline, and sends it once', async () => {
      await withGroup(setting, { look: kStopped }, async ({ wire, person, page }) => {
        person.expectLosses();
        await person.toPredict();
        const best = await person.best();
        await person.drive(best.slice(0, 1));
        await person.context.setOffline(true);
        wire.isDown = true;
        wire.cut();
        await person.hasStatus('Reconnecting');
        await person.drive(best.slice(1));
        await person.button('Submit').click();
        await person.pass(3000);
        await page.waitForFunction(() => document.querySelector('.message.warning')?.textContent.includes('was lost'));
        await person.counts('being saved');
        wire.isDown = false;
        await person.context.setOffline(false);
        await until(() => wire.of('answer').length === 1);
        await person.hasStatus('Saved');
      });
    });

    it('sends again what was stored but not acknowledged, after a reload, with the same id', async () => {
      await withGroup(setting, {}, async ({ wire, person, page }) => {
        person.expectLosses();
        await person.toPredict();
        const { index } = person.view.predict;
        wire.holdsAcks = true;
        await person.drive(await person.best());
        await person.button('Submit').click();
        await until(() => person.view.predict?.index !== index); // it is stored
        assert.match(await page.textContent('.status'), /Saving/);
        wire.holdsAcks = false;
        await page.reload();
        await until(() => wire.of('answer').length > 1);
        assert.equal(new Set(wire.of('answer').map(({ id }) => id)).size, 1);
        await person.hasStatus('Saved');
      });
    });

    it('tries again after connections that break, and sends again what is not acknowledged', async () => {
      await withGroup(setting, { look: kStopped }, async ({ wire, person }) => {
        person.expectLosses();
        await person.at('Before you start');
        for (let i = 0; i < 3; i += 1) {
          wire.cut();
          await person.hasStatus('Reconnecting');
          await person.pass(500);
          await person.page.waitForSelector('.status.saved', { state: 'attached' }); // says nothing before the consent
        }
        wire.holdsAcks = true;
        await person.consent();
        await until(() => wire.sent.length === 1);
        wire.isDown = true; // until it has been seen that the page reconnects
        await person.pass(21_000);
        await person.hasStatus('Reconnecting');
        wire.isDown = wire.holdsAcks = false;
        await person.pass(8000);
        await until(() => wire.sent.length === 2);
        assert.equal(wire.sent[0].id, wire.sent[1].id);
        await person.hasStatus('Saved');
        await person.at('What this is about');
      });
    });

    it('says what to do when the link is wrong, when somebody was removed, and when a link is the organiser\'s', async () => {
      await withGroup(setting, {}, async ({ running, wire, person, page }) => {
        await person.at('Before you start');
        wire.say({ t: 'bye', reason: 'removed' });
        wire.cut();
        await person.at('You were removed from the session');
        await person.button('Try again').click();
        await person.at('Before you start');
        await page.goto('about:blank');
        await page.goto(`${running.server.origin}/j#t=0123456789abcdef`);
        await person.at('This link does not work');
        await person.button('Enter a code').click();
        await person.at('Join a session');
        await page.goto('about:blank');
        await page.goto(running.server.facilitator.replace('/f#', '/j#'));
        await page.waitForURL(`${running.server.origin}/f`);
      });
    });

    it('shows a pause, says a refusal, and takes messages of the organiser away when they are read', async () => {
      await withGroup(setting, {}, async ({ running, wire, person, page }) => {
        await person.toPredict();
        const facilitator = await Client.open(setting.modules, running.server.facilitator);
        const pause = { why: 'someone-away', since_ms: Date.now(), until_ms: Date.now() + 60_000, missing: 1 };
        wire.bend = (view) => ({ ...view, pause });
        wire.again();
        await page.waitForSelector('.pause');
        assert.match(await page.textContent('.pause'), /1 person in your group has lost the connection.*at the latest/s);
        await page.keyboard.press('ArrowDown');
        await person.counts('0 steps');
        wire.bend = (view) => view;
        await facilitator.ask('message', { room: 'r1', text: 'Five more minutes', reason: 'a test' });
        await page.waitForSelector('.message.notice');
        await person.button('OK').click();
        await page.waitForSelector('.message.notice', { state: 'detached' });
        await page.reload();
        await page.waitForSelector('.drive-area');
        assert.equal(await page.locator('.message.notice').count(), 0);
        wire.answers = ({ t }) => t === 'answer' && { t: 'nak', reason: 'too-late', text: 'the time is over' };
        await person.drive(await person.best());
        await person.button('Submit').click();
        await page.waitForSelector('.message.warning');
        assert.match(await page.textContent('.message.warning'), /not accepted.*The time is over\./s);
        assert.equal(await person.button('Submit').getAttribute('aria-disabled'), null);
        facilitator.close();
      });
    });

    it('counts on the server\'s clock, a day off in either direction', async () => {
      for (const skew of [-86_400_000, 86_400_000]) {
        await withGroup(setting, { look: kStopped }, async ({ wire, person, page }) => {
          await person.at('Before you start');
          const { consent, ...view } = wire.last;
          const now = Date.now() + skew;
          const lobby = { present: 1, size: 3, since_ms: now - 65_000, leave_after_ms: now + 235_000 };
          wire.show({ ...view, stage: 'lobby', lobby, server_ms: now });
          await person.at('Waiting for your group');
          await page.waitForFunction(() => /1:05/.test(document.querySelector('main .time')?.textContent));
          await person.pass(2100);
          await page.waitForFunction(() => /1:07/.test(document.querySelector('main .time').textContent));
          assert.match(await page.textContent('.next-step'), /leave in 3:52/);
        });
      }
    });
  });
}
