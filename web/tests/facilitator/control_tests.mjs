// What facilitators do: controls, rooms, export.
import assert from 'node:assert/strict';
import { it } from 'node:test';
import { openTab, openRoom, received, until } from './harness.mjs';

export function controlTests({ withPage, shoot }) {
  it('asks for a reason before it does anything, by keyboard alone', async () => {
    await withPage({}, async (page, mock) => {
      await openRoom(page, 'Room A1');
      await page.focus('.room-buttons button:text-is("Pause")');
      await page.keyboard.press('Enter');
      await page.waitForSelector('dialog[open]');
      await page.keyboard.press('Enter');
      assert.match(await page.textContent('dialog .problem'), /give a reason/);
      await page.keyboard.type('go');
      await page.keyboard.press('Enter');
      assert.match(await page.textContent('dialog .problem'), /"go" is too short: a reason has at least 3 letters/);
      assert.deepEqual(received(mock, 'pause'), []);
      await page.keyboard.press('ControlOrMeta+A');
      await page.keyboard.type('Fire alarm');
      await page.keyboard.press('Enter');
      await page.waitForSelector('dialog', { state: 'detached' });
      assert.deepEqual(received(mock, 'pause'), [{ room: 'a1', reason: 'Fire alarm' }]);
      await page.waitForSelector('.badge.paused');
      assert.match(await page.textContent('.room-log'), /Paused the room.*Fire alarm/s);
      assert.ok(await page.evaluate(() => document.activeElement !== document.body), 'the focus is lost');
    });
  });

  it('closes a dialog on Escape, does nothing, and gives the focus back', async () => {
    await withPage({}, async (page, mock) => {
      await openRoom(page, 'Room A1');
      await page.focus('.room-buttons button:text-is("End")');
      await page.keyboard.press('Enter');
      await page.keyboard.type('No');
      await page.keyboard.press('Escape');
      await page.waitForSelector('dialog', { state: 'detached' });
      assert.deepEqual(received(mock, 'end'), []);
      assert.equal(await page.evaluate(() => document.activeElement?.textContent), 'End');
    });
  });

  it('sends every command with what it needs', async () => {
    await withPage({}, async (page, mock) => {
      await openRoom(page, 'Room A1');
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
      assert.equal(received(mock, 'extend')[0].seconds, 90);
      assert.equal(received(mock, 'message')[0].text, 'Five more minutes');
      assert.equal(received(mock, 'strategy')[0].name, 'individual-low');
      await page.click('button.seat >> nth=1');
      await page.click('dialog button:text-is("Replace by a simulated learner")');
      await page.selectOption('dialog select', 'P');
      await page.fill('dialog input[type=text]', 'Ben had to leave');
      await page.click('dialog button[type=submit]');
      await page.waitForSelector('dialog', { state: 'detached' });
      assert.deepEqual(received(mock, 'simulate')[0], { room: 'a1', reason: 'Ben had to leave', seat: 2, type: 'P' });
      await page.click('button.seat >> nth=0');
      await page.click('dialog button:text-is("Revoke link")');
      await page.click('.suggestions button >> nth=0');
      await page.click('dialog button[type=submit]');
      await page.waitForSelector('dialog', { state: 'detached' });
      assert.match(received(mock, 'link-revoke')[0].token, /^a1seat1-/);
      await act('End');
      await page.waitForSelector('.badge.ended');
      for (const command of mock.commands) assert.match(command.id, /^[0-9a-f-]{36}$/);
      assert.equal(new Set(mock.commands.map(({ id }) => id)).size, mock.commands.length);
    });
  });

  it('makes a new link for a seat whose link is not known any more', async () => {
    await withPage({}, async (page, mock) => {
      for (const seat of mock.view.rooms[0].seats) delete seat.link;
      mock.showAll();
      await openRoom(page, 'Room A1');
      await page.click('button.seat >> nth=0');
      await page.click('dialog button:text-is("New link")');
      await page.click('.suggestions button >> nth=0');
      await page.click('dialog button[type=submit]');
      await page.waitForSelector('dialog', { state: 'detached' });
      assert.deepEqual(received(mock, 'readmit'), [{ room: 'a1', reason: 'The link was lost', seat: 1 }]);
    });
  });

  it('says why the server refuses, and keeps what was typed', async () => {
    await withPage({}, async (page, mock) => {
      mock.refusals.extend = { reason: 'no-limit', text: 'This stage has no time limit.' };
      await openRoom(page, 'Room A1');
      await page.click('.room-buttons button:text-is("Extend")');
      await page.fill('dialog input[type=text]', 'Slow typing');
      await page.click('dialog button[type=submit]');
      await page.waitForFunction(() => document.querySelector('dialog .problem')?.textContent.includes('no time limit'));
      assert.equal(await page.inputValue('dialog input[type=text]'), 'Slow typing');
    });
  });

  it('sends a command again after a lost connection, with the same id', async () => {
    await withPage({ expected: ['WebSocket connection'] }, async (page, mock) => {
      await openRoom(page, 'Room A1');
      mock.holdAcks = true;
      await page.click('.room-buttons button:text-is("Pause")');
      await page.click('.suggestions button >> nth=0');
      await page.click('dialog button[type=submit]');
      await until('the command', () => received(mock, 'pause').length === 1);
      mock.holdAcks = false;
      for (const socket of mock.ws.clients) socket.terminate();
      await page.waitForSelector('dialog', { state: 'detached' });
      const ids = mock.commands.filter(({ t }) => t === 'pause').map(({ id }) => id);
      assert.equal(ids.length, 2);
      assert.equal(ids[0], ids[1]);
    });
  });

  it('makes rooms with people and simulated learners, and shows their links with QR codes', async () => {
    await withPage({ rooms: 0 }, async (page, mock) => {
      await page.waitForSelector('.make');
      await page.selectOption('#make-strategy', 'common');
      await page.fill('#make-size', '4');
      await page.fill('#make-count', '2');
      await page.selectOption('.seat-choices select >> nth=3', 'P');
      assert.match(await page.textContent('fieldset'), /3 of 4 seats are for people/);
      await page.click('.make button[type=submit]');
      await until('the rooms', () => mock.view.rooms.length === 2);
      const [made] = received(mock, 'room-make');
      assert.deepEqual(made, { strategy: 'common', seats: ['person', 'person', 'person', 'P'], count: 2, reason: 'Set-up' });
      await page.waitForSelector('.room-links .link-box input');
      assert.match(await page.inputValue('.room-links .link-box input >> nth=0'), /\/j#t=/);
      const images = await page.locator('.qr img').count();
      await page.click('.room-links .link-box >> nth=0 >> button:has-text("QR")');
      await until('the code', async () => (await page.locator('.qr img').count()) === images + 1);
      const drawn = await page.$$eval('.qr img', (all) => all.every((image) => image.naturalWidth > 0));
      assert.ok(drawn, 'a QR code is not drawn');
    });
  });

  it('says when data are at risk, checks them, and exports', async () => {
    await withPage({}, async (page, mock) => {
      await openTab(page, 'Data');
      assert.match(await page.textContent('main'), /Everything that was acknowledged is on disk/);
      await page.click('button:text-is("Check now")');
      await page.waitForSelector('text=no problem found');
      const [download] = await Promise.all([page.waitForEvent('download'), page.click('button:text-is("Export")')]);
      assert.equal(download.suggestedFilename(), 'delivery-live.tar');
      mock.view.integrity = { ...mock.view.integrity, free_mb: 120, problems: ['Room A1: event 7 is damaged.'] };
      mock.showAll();
      await page.waitForSelector('.banner');
      assert.match(await page.textContent('.banner'), /event 7 is damaged/);
      assert.match(await page.textContent('.problems'), /120 MB/);
      await shoot(page, 'problems-light');
    });
  });
}
