// Links, roles, lost connections, many rooms, hostile text.
import assert from 'node:assert/strict';
import { it } from 'node:test';
import { openDeep, openTab, openRoom } from './harness.mjs';

export function pageTests({ withPage, violations, shoot, titles, facilitatorLink }) {
  it('takes the token out of the address and keeps it for a reload', async () => {
    await withPage({}, async (page, wire) => {
      const requests = [];
      page.on('request', (request) => requests.push(request.url()));
      await openRoom(page, titles.twelve);
      assert.match(await page.evaluate(() => location.href), /\/f$/);
      await page.reload();
      await openDeep(page);
      assert.match(await page.textContent('.room-bar'), new RegExp(titles.twelve));
      const token = facilitatorLink().split('#t=')[1];
      assert.ok(requests.length > 0 && requests.every((request) => !request.includes(token)), 'the token is in a request');
    });
  });

  it('keeps the last view while the server is away, without controls, and comes back by itself', async () => {
    await withPage({ expected: ['WebSocket connection', 'ERR_'] }, async (page, wire) => {
      await openRoom(page, titles.twelve);
      wire.say({ t: 'bye', reason: 'server-stops' });
      wire.isDown = true;
      wire.cut();
      await page.waitForSelector('.banner');
      await shoot(page, 'stopped-light');
      assert.match(await page.textContent('.banner'), /server has stopped/);
      assert.match(await page.textContent('.link-mark'), /Not connected/);
      assert.equal(await page.locator('.globe').count(), 14);
      assert.equal(await page.locator('.room-buttons').count(), 0);
      wire.isDown = false;
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
      await page.fill('#ask-link', facilitatorLink().replace(/^http:\/\/[^/]*/, 'http://example.org'));
      await page.click('form button');
      await page.waitForSelector('header.top');
    });
    await withPage({ token: '' }, async (page) => {
      assert.match(await page.textContent('main'), /needs a facilitator or observer link/);
    });
  });

  it('shows observers no names, links, codes or controls', async () => {
    await withPage({ role: 'observer' }, async (page, wire) => {
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
      assert.deepEqual([...new Set(wire.sent.map(({ t }) => t))], ['room-select']);
    });
  });

  it('filters and finds rooms, also among two hundred', async () => {
    await withPage({}, async (page, wire) => {
      const well = ({ needs_help: _, ...seat }) => seat;
      const away = (seat) => (seat.label === 'Learner B' ? { ...seat, presence: 'away' } : seat);
      wire.bend = ({ rooms, ...view }) => {
        const room = rooms?.find(({ code }) => titles.three.endsWith(code));
        const seats = room?.seats.map(well);
        const many = Array.from({ length: 200 }, (_, i) => ({ ...room, id: `a${i + 1}`, code: `A${i + 1}`, seats: i % 8 === 4 ? seats.map(away) : seats }));
        return { ...view, ...(rooms ? { rooms: many } : {}) };
      };
      wire.again();
      await openTab(page, 'Rooms');
      await page.waitForSelector('.rooms button:text-is("Room A200")');
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
    await withPage({}, async (page, wire) => {
      const evil = '<img src=x onerror=alert(1)><script>alert(1)</script>';
      wire.bend = (view) => ({
        ...view,
        rooms: view.rooms?.map((room) => ({ ...room, seats: room.seats.map((seat) => ({ ...seat, name: evil })) })),
        log: [...view.log, { at_ms: Date.now(), room: view.room?.id, actor: evil, what: evil, reason: evil }],
      });
      wire.again();
      await openRoom(page, titles.three);
      assert.ok((await page.textContent('.group')).includes(evil));
      assert.ok((await page.textContent('.room-log')).includes(evil));
      assert.equal(await page.locator('main img, main script').count(), 0);
    });
  });

  it('measures time by the clock of the server', async () => {
    await withPage({ calm: true }, async (page, wire, context) => {
      await context.addInitScript(() => {
        const real = Date.now.bind(Date);
        Date.now = () => real() + 86_400_000; // this computer is a day ahead: it would be hours
      });
      await page.reload();
      await openRoom(page, titles.three);
      assert.match(await page.textContent('.room-bar'), /Running for \d+:\d\d(?!:)/);
    });
  });
}
