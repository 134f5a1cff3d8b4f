// What facilitators do: controls, rooms, export.
import assert from 'node:assert/strict';
import { it } from 'node:test';
import { openTab, openRoom, received, until } from './harness.mjs';

export function controlTests({ withPage, shoot, titles, room }) {
  it('asks for a reason before it does anything, by keyboard alone', async () => {
    await withPage({}, async (page, wire) => {
      await openRoom(page, await room({}));
      await page.focus('.room-buttons button:text-is("Pause")');
      await page.keyboard.press('Enter');
      await page.waitForSelector('dialog[open]');
      await page.keyboard.press('Enter');
      assert.match(await page.textContent('dialog .problem'), /give a reason/);
      await page.keyboard.type('go');
      await page.keyboard.press('Enter');
      assert.match(await page.textContent('dialog .problem'), /"go" is too short: a reason has at least 3 letters/);
      assert.deepEqual(received(wire, 'pause'), []);
      await page.keyboard.press('ControlOrMeta+A');
      await page.keyboard.type('Fire alarm');
      await page.keyboard.press('Enter');
      await page.waitForSelector('dialog', { state: 'detached' });
      assert.deepEqual(received(wire, 'pause').map(({ reason }) => reason), ['Fire alarm']);
      await page.waitForSelector('.badge.paused');
      assert.match(await page.textContent('.room-log'), /Paused the room.*Fire alarm/s);
      assert.ok(await page.evaluate(() => document.activeElement !== document.body), 'the focus is lost');
    });
  });

  it('closes a dialog on Escape, does nothing, and gives the focus back', async () => {
    await withPage({}, async (page, wire) => {
      await openRoom(page, titles.three);
      await page.focus('.room-buttons button:text-is("End")');
      await page.keyboard.press('Enter');
      await page.keyboard.type('No');
      await page.keyboard.press('Escape');
      await page.waitForSelector('dialog', { state: 'detached' });
      assert.deepEqual(received(wire, 'end'), []);
      assert.equal(await page.evaluate(() => document.activeElement?.textContent), 'End');
    });
  });

  it('sends every command with what it needs', async () => {
    await withPage({}, async (page, wire) => {
      await openRoom(page, await room({}));
      const act = async (label, fill, verb = label) => {
        await page.click(`.room-buttons button:text-is("${label}")`);
        await fill?.();
        await page.click('.suggestions button >> nth=0');
        assert.equal(await page.textContent('dialog button[type=submit]'), verb);
        await page.click('dialog button[type=submit]');
        await page.waitForSelector('dialog', { state: 'detached' });
      };
      await act('Extend', () => page.fill('dialog input[type=number]', '90'));
      await act('Message', async () => {
        assert.equal(await page.evaluate(() => document.activeElement.tagName), 'TEXTAREA', 'the focus is in the message');
        await page.fill('dialog textarea', 'Five more minutes');
      }, 'Send');
      await act('Strategy', () => page.selectOption('dialog select', 'individual-low'), 'Switch');
      assert.equal(received(wire, 'extend')[0].seconds, 90);
      assert.equal(received(wire, 'message')[0].text, 'Five more minutes');
      assert.equal(received(wire, 'strategy')[0].name, 'individual-low');
      await page.click('button.seat >> nth=1');
      await page.click('dialog button:text-is("Replace by a simulated learner")');
      await page.selectOption('dialog select', 'P');
      await page.fill('dialog input[type=text]', 'Ben had to leave');
      await page.click('dialog button[type=submit]');
      await page.waitForSelector('dialog', { state: 'detached' });
      const [{ room: _, ...simulate }] = received(wire, 'simulate');
      assert.deepEqual(simulate, { reason: 'Ben had to leave', seat: 2, type: 'P' });
      await page.click('button.seat >> nth=0');
      await page.click('dialog button:text-is("Revoke link")');
      await page.click('.suggestions button >> nth=0');
      await page.click('dialog button[type=submit]');
      await page.waitForSelector('dialog', { state: 'detached' });
      assert.match(received(wire, 'link-revoke')[0].token, /^[\w-]{22}$/);
      await act('End');
      await page.waitForSelector('.badge.ended');
      for (const command of wire.sent) assert.match(command.id, /^[0-9a-f-]{36}$/);
      assert.equal(new Set(wire.sent.map(({ id }) => id)).size, wire.sent.length);
    });
  });

  it('makes a new link for a seat whose link is not known any more', async () => {
    await withPage({}, async (page, wire) => {
      const unknown = ({ link: _, ...seat }) => seat;
      wire.bend = (view) => ({ ...view, rooms: view.rooms?.map((one) => ({ ...one, seats: one.seats.map(unknown) })) });
      wire.again();
      await openRoom(page, await room({}));
      await page.click('button.seat >> nth=0');
      await page.click('dialog button:text-is("New link")');
      await page.click('.suggestions button >> nth=0');
      await page.click('dialog button[type=submit]');
      await page.waitForSelector('dialog', { state: 'detached' });
      assert.deepEqual(received(wire, 'readmit').map(({ reason, seat }) => ({ reason, seat })), [{ reason: 'The link was lost', seat: 1 }]);
    });
  });

  it('says why the server refuses, and keeps what was typed', async () => {
    await withPage({}, async (page, wire) => {
      wire.answers = ({ t }) => t === 'extend' && { t: 'nak', reason: 'no-limit', text: 'This stage has no time limit.' };
      await openRoom(page, titles.three);
      await page.click('.room-buttons button:text-is("Extend")');
      await page.fill('dialog input[type=text]', 'Slow typing');
      await page.click('dialog button[type=submit]');
      await page.waitForFunction(() => document.querySelector('dialog .problem')?.textContent.includes('no time limit'));
      assert.equal(await page.inputValue('dialog input[type=text]'), 'Slow typing');
    });
  });

  it('sends a command again after a lost connection, with the same id', async () => {
    await withPage({ expected: ['WebSocket connection'] }, async (page, wire) => {
      await openRoom(page, await room({}));
      wire.holdsAcks = true;
      await page.click('.room-buttons button:text-is("Pause")');
      await page.click('.suggestions button >> nth=0');
      await page.click('dialog button[type=submit]');
      await until(() => received(wire, 'pause').length === 1);
      wire.holdsAcks = false;
      wire.cut();
      await page.waitForSelector('dialog', { state: 'detached' });
      const ids = wire.of('pause').map(({ id }) => id);
      assert.equal(ids.length, 2);
      assert.equal(ids[0], ids[1]);
    });
  });

  it('makes rooms with people and simulated learners, and shows their links with QR codes', async () => {
    await withPage({}, async (page, wire) => {
      await until(() => wire.last?.rooms);
      const known = new Set(wire.last.rooms.map(({ id }) => id));
      const coded = (room) => ({ ...room, code: 'QRCQRC' }); // codes are random: one may read like a button
      wire.bend = (view) => ({ ...view, rooms: view.rooms?.filter(({ id }) => !known.has(id)).map(coded) });
      wire.again();
      await openTab(page, 'Set-up');
      await page.waitForSelector('.make');
      await page.selectOption('#make-strategy', 'common');
      await page.fill('#make-size', '4');
      await page.fill('#make-count', '2');
      await page.selectOption('.seat-choices select >> nth=3', 'P');
      assert.match(await page.textContent('fieldset'), /3 of 4 seats are for people/);
      await page.click('.make button[type=submit]');
      await until(() => received(wire, 'room-make').length === 1);
      const [made] = received(wire, 'room-make');
      assert.deepEqual(made, { strategy: 'common', seats: ['person', 'person', 'person', 'P'], count: 2, reason: 'Set-up' });
      await page.waitForSelector('.room-links .link-box input');
      assert.match(await page.inputValue('.room-links .link-box input >> nth=0'), /\/j#t=/);
      const first = page.locator('.room-links .link-box').first();
      await first.locator('button[aria-pressed]').click();
      await first.locator('.qr img').waitFor();
      await until(() => page.$$eval('.qr img', (all) => all.every((image) => image.naturalWidth > 0)));
    });
  });

  it('says when data are at risk, checks them, and exports', async () => {
    await withPage({}, async (page, wire) => {
      await openTab(page, 'Data');
      assert.match(await page.textContent('main'), /Everything that was acknowledged is on disk/);
      await page.click('button:text-is("Check now")');
      await page.waitForSelector('text=no problem found');
      const [download] = await Promise.all([page.waitForEvent('download'), page.click('button:text-is("Export")')]);
      assert.match(download.suggestedFilename(), /\.tar$/);
      wire.bend = (view) => ({ ...view, integrity: { ...view.integrity, free_mb: 120, problems: ['Room A1: event 7 is damaged.'] } });
      wire.again();
      await page.waitForSelector('.banner');
      assert.match(await page.textContent('.banner'), /event 7 is damaged/);
      assert.match(await page.textContent('.problems'), /120 MB/);
      await shoot(page, 'problems-light');
    });
  });
}
