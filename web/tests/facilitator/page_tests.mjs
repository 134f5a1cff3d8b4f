// Links, roles, lost connections, many rooms, hostile text.
import assert from 'node:assert/strict';
import { it } from 'node:test';
import { kTokens } from '../facilitator_mock.mjs';
import { openDeep, openTab, openRoom } from './harness.mjs';

export function pageTests({ withPage, violations, shoot }) {
  it('takes the token out of the address and keeps it for a reload', async () => {
    await withPage({}, async (page, mock) => {
      await openRoom(page, 'Room A2');
      assert.equal(await page.evaluate(() => location.href), `${mock.origin}/f`);
      await page.reload();
      await openDeep(page);
      assert.match(await page.textContent('.room-bar'), /Room A2/);
      assert.ok(mock.requests.every((request) => !request.includes(kTokens.facilitator)), 'the token is in a request');
    });
  });

  it('keeps the last view while the server is away, without controls, and comes back by itself', async () => {
    await withPage({ expected: ['WebSocket connection', 'ERR_'] }, async (page, mock) => {
      await openRoom(page, 'Room A2');
      mock.sayAll({ t: 'bye', reason: 'server-stops' });
      const { port } = mock;
      await mock.stop();
      await page.waitForSelector('.banner');
      await shoot(page, 'stopped-light');
      assert.match(await page.textContent('.banner'), /server has stopped/);
      assert.match(await page.textContent('.link-mark'), /Not connected/);
      assert.equal(await page.locator('.globe').count(), 14);
      assert.equal(await page.locator('.room-buttons').count(), 0);
      await mock.start(port);
      await page.evaluate(() => document.querySelector('.banner button')?.click()); // it may be back already
      await page.waitForSelector('.banner', { state: 'detached' });
      await page.waitForSelector('.room-buttons');
      await page.waitForSelector('.globe .ball');
      assert.equal(await page.locator('.globe').count(), 14, 'the room is selected again');
    });
  });

  it('explains a link that is not valid, and takes another one', async () => {
    await withPage({ token: 'nonsense-0123456789' }, async (page) => {
      await page.waitForSelector('h1:text-is("This link is not valid")');
      assert.deepEqual(await violations(page), []);
      await page.fill('#ask-link', 'hello');
      await page.click('form button');
      assert.match(await page.textContent('.problem'), /not a link/);
      await page.fill('#ask-link', `http://example.org/f#t=${kTokens.facilitator}`);
      await page.click('form button');
      await page.waitForSelector('header.top');
    });
    await withPage({ token: '' }, async (page) => {
      assert.match(await page.textContent('main'), /needs a facilitator or observer link/);
    });
  });

  it('shows observers no names, links, codes or controls', async () => {
    await withPage({ role: 'observer', rooms: 3 }, async (page, mock) => {
      await page.waitForSelector('.badge.observer');
      let seen = '';
      for (const tab of ['Set-up', 'Rooms', 'Data', 'Log']) {
        await openTab(page, tab);
        seen += await page.textContent('body');
        assert.equal(await page.locator('form, .link-box, button.primary, button.danger').count(), 0, tab);
      }
      await openTab(page, 'Rooms');
      await page.click('.rooms button >> nth=0');
      await openDeep(page);
      seen += await page.textContent('body');
      assert.equal(await page.locator('.room-buttons').count(), 0);
      await page.click('button.seat >> nth=0');
      seen += await page.textContent('dialog');
      assert.equal(await page.locator('dialog .dialog-buttons').count(), 0);
      assert.doesNotMatch(seen, /Ada|Ben|KITH-|#t=/);
      assert.deepEqual([...new Set(mock.commands.map(({ t }) => t))], ['room-select']);
    });
  });

  it('filters and finds rooms, also among two hundred', async () => {
    await withPage({ rooms: 200 }, async (page) => {
      await openTab(page, 'Rooms');
      const rows = () => page.locator('.rooms tbody tr').count();
      assert.equal(await rows(), 200);
      await page.click('.chips button:has-text("Need attention")');
      assert.equal(await rows(), 25);
      assert.match(await page.textContent('.rooms tbody'), /Learner B away/);
      await page.click('.chips button:has-text("All")');
      await page.fill('#rooms-find', 'a17');
      assert.equal(await rows(), 11);
      await page.fill('#rooms-find', 'nowhere');
      assert.match(await page.textContent('.nothing'), /No room matches/);
    });
  });

  it('shows text of people as text', async () => {
    await withPage({}, async (page, mock) => {
      const evil = '<img src=x onerror=alert(1)><script>alert(1)</script>';
      Object.assign(mock.view.rooms[0].seats[0], { name: evil });
      mock.view.log.push({ at_ms: Date.now(), room: 'a1', actor: evil, what: evil, reason: evil });
      mock.showAll();
      await openRoom(page, 'Room A1');
      assert.ok((await page.textContent('.group')).includes(evil));
      assert.ok((await page.textContent('.room-log')).includes(evil));
      assert.equal(await page.locator('main img, main script').count(), 0);
    });
  });

  it('measures time by the clock of the server', async () => {
    await withPage({ calm: true }, async (page, mock, context) => {
      await context.addInitScript(() => {
        const real = Date.now.bind(Date);
        Date.now = () => real() + 86_400_000; // this computer is a day ahead: it would be hours
      });
      await page.reload();
      await openRoom(page, 'Room A1');
      assert.match(await page.textContent('.room-bar'), /Running for \d\d:\d\d(?!:)/);
    });
  });
}
