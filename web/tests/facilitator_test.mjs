// The facilitator page against a mock of the server: as facilitators and observers use it.
//
//   node tests/facilitator_test.mjs --app FOLDER [--screenshots DIR] [--modules DIR] [--chromium FILE]
import assert from 'node:assert/strict';
import { mkdirSync, readFileSync } from 'node:fs';
import { dirname, join, resolve } from 'node:path';
import { after, before, describe, it } from 'node:test';
import { fileURLToPath } from 'node:url';
import { parseArgs } from 'node:util';
import { launch, requireFrom } from './browser.mjs';
import { MockServer, kTokens } from './facilitator_mock.mjs';

const here = dirname(fileURLToPath(import.meta.url));
const { values } = parseArgs({
  options: {
    app: { type: 'string' },
    screenshots: { type: 'string' },
    modules: { type: 'string', default: join(here, '..') },
    chromium: { type: 'string', default: '/usr/bin/chromium' },
  },
});
if (!values.app) {
  console.error(
    'usage: node tests/facilitator_test.mjs --app FOLDER [--screenshots DIR] [--modules DIR] [--chromium FILE]',
  );
  process.exit(2);
}
const axeSource = readFileSync(requireFrom(values.modules).resolve('axe-core/axe.min.js'), 'utf8');

let browser;

// A server, and a page that is connected to it; afterwards no request may have left the server, and nothing may
// have been written to the console. `expected` are console messages that belong to the test.
async function withPage(look, body) {
  const { role = 'facilitator', token, width = 1280, dark = false, calm = false, expected = [], ...options } = look;
  const mock = new MockServer(resolve(values.app), values.modules, options);
  await mock.start();
  const context = await browser.newContext({
    viewport: { width, height: 800 },
    colorScheme: dark ? 'dark' : 'light',
    reducedMotion: calm ? 'reduce' : 'no-preference',
    acceptDownloads: true,
  });
  const trouble = [];
  await context.route('**/*', (route) => {
    const url = route.request().url();
    if (url.startsWith(mock.origin) || /^(data|blob):/.test(url)) return route.continue();
    trouble.push(`request: ${url}`);
    return route.abort();
  });
  const page = await context.newPage();
  page.on('console', (message) => {
    const isExpected = expected.some((text) => message.text().includes(text));
    if (['error', 'warning'].includes(message.type()) && !isExpected) trouble.push(`console: ${message.text()}`);
  });
  page.on('pageerror', (error) => trouble.push(`uncaught: ${error.message}`));
  try {
    await page.goto(`${mock.origin}/f${token === '' ? '' : `#t=${token ?? kTokens[role]}`}`);
    await page.waitForSelector('main');
    await body(page, mock, context);
    assert.deepEqual(trouble, [], 'requests, console messages or uncaught errors');
  } finally {
    await context.close();
    await mock.stop();
  }
}

const openTab = (page, name) => page.click(`nav button:text-is("${name}")`);

async function openRoom(page, title) {
  await openTab(page, 'Rooms');
  await page.click(`.rooms button:text-is("${title}")`);
  await page.waitForSelector('.live .globe svg');
}

async function violations(page) {
  await page.evaluate(axeSource); // from the debugger, so that the page's policy stays as it is
  const { violations: found } = await page.evaluate(() => axe.run(document, { resultTypes: ['violations'] }));
  return found
    .filter(({ impact }) => impact === 'serious' || impact === 'critical')
    .map(({ id, nodes }) => `${id}: ${nodes.slice(0, 3).map(({ html }) => html.slice(0, 160))}`);
}

async function shoot(page, name) {
  if (!values.screenshots) return;
  mkdirSync(values.screenshots, { recursive: true });
  await page.screenshot({ path: join(values.screenshots, `facilitator-${name}.png`) });
}

const received = (mock, type) => mock.commands.filter(({ t }) => t === type).map(({ body }) => body);

async function until(what, condition) {
  const end = Date.now() + 30_000;
  while (!(await condition())) {
    assert.ok(Date.now() < end, `waited in vain for ${what}`);
    await new Promise((done) => setTimeout(done, 25));
  }
}

describe('the facilitator page', () => {
  before(async () => (browser = await launch(values.modules, values.chromium)));
  after(async () => browser?.close());

  for (const dark of [false, true]) {
    const tone = dark ? 'dark' : 'light';
    it(`has no serious axe violation on any tab or dialog, ${tone}`, async () => {
      await withPage({ dark, calm: true }, async (page) => {
        const check = async (name) => {
          await shoot(page, `${name}-${tone}`);
          assert.deepEqual(await violations(page), [], name);
        };
        for (const tab of ['Set-up', 'Rooms', 'Data', 'Log']) {
          await openTab(page, tab);
          if (tab === 'Set-up') await page.waitForSelector('.qr img');
          await check(tab.toLowerCase());
        }
        for (const [title, name] of [['Room A1', '3'], ['Room A2', '12'], ['Room A3', '1'], ['Room A5', 'paused']]) {
          await openRoom(page, title);
          await check(`live-${name}`);
        }
        await page.click('.room-buttons button:text-is("Extend")');
        await check('dialog');
        await page.keyboard.press('Escape');
        await page.click('button.seat >> nth=1');
        await page.waitForSelector('dialog');
        await check('seat');
      });
    });
  }

  it('shows a group of twelve on a screen of 1280 x 800 without scrolling', async () => {
    await withPage({ calm: true }, async (page) => {
      await openRoom(page, 'Room A2');
      assert.equal(await page.locator('.globe').count(), 14);
      assert.equal(await page.locator('.group tbody tr').count(), 12);
      for (const part of ['.room-buttons', '.globes', '.group', '.curves', '.progress', '.lesson-now', '.runners']) {
        const box = await page.locator(part).boundingBox();
        assert.ok(box && box.y >= 0 && box.y + box.height <= 800, `${part} ends at ${box?.y + box?.height}`);
        assert.ok(box.x >= 0 && box.x + box.width <= 1280, `${part} ends at ${box.x + box.width}`);
      }
      const sizes = await page.$$eval('.globe svg', (all) => all.map((svg) => svg.getBoundingClientRect().width));
      assert.ok(Math.min(...sizes) >= 80, `spheres of ${Math.min(...sizes)} px`);
    });
  });

  it('shows the latest answers of a long session, with the names beside them', async () => {
    await withPage({ calm: true, periods: [30] }, async (page) => {
      await openRoom(page, 'Room A1');
      const group = await page.locator('.group').boundingBox();
      const last = await page.locator('.group tbody tr >> nth=1 >> .answer-cell').last().boundingBox();
      assert.ok(last.x + last.width <= group.x + group.width + 1, 'the latest answers are out of sight');
      const name = await page.locator('button.seat >> nth=1').boundingBox();
      assert.ok(name.x >= group.x && name.x < group.x + 40, 'the names are out of sight');
      await shoot(page, 'long-light');
    });
  });

  for (const width of [320, 640, 1024]) {
    it(`fits into ${width} px without scrolling sideways`, async () => {
      await withPage({ width, calm: true }, async (page) => {
        for (const tab of ['Set-up', 'Rooms', 'Data', 'Log']) {
          await openTab(page, tab);
          const wide = await page.evaluate(() => document.documentElement.scrollWidth - window.innerWidth);
          assert.ok(wide <= 0, `${tab} is ${wide} px too wide`);
        }
        await openRoom(page, 'Room A2');
        const wide = await page.evaluate(() => document.documentElement.scrollWidth - window.innerWidth);
        await shoot(page, `live-${width}`);
        assert.ok(wide <= 0, `Live is ${wide} px too wide`);
      });
    });
  }

  it('takes the token out of the address and keeps it for a reload', async () => {
    await withPage({}, async (page, mock) => {
      await openRoom(page, 'Room A2');
      assert.equal(await page.evaluate(() => location.href), `${mock.origin}/f`);
      await page.reload();
      await page.waitForSelector('.live .globe');
      assert.match(await page.textContent('.room-bar'), /Room A2/);
      assert.ok(mock.requests.every((request) => !request.includes(kTokens.facilitator)), 'the token is in a request');
    });
  });

  it('asks for a reason before it does anything, by keyboard alone', async () => {
    await withPage({}, async (page, mock) => {
      await openRoom(page, 'Room A1');
      await page.focus('.room-buttons button:text-is("Pause")');
      await page.keyboard.press('Enter');
      await page.waitForSelector('dialog[open]');
      await page.keyboard.press('Enter');
      assert.match(await page.textContent('dialog .problem'), /give a reason/);
      assert.deepEqual(received(mock, 'pause'), []);
      await page.keyboard.type('Fire alarm');
      await page.keyboard.press('Enter');
      await page.waitForSelector('dialog', { state: 'detached' });
      assert.deepEqual(received(mock, 'pause'), [{ room: 'a1', reason: 'Fire alarm' }]);
      await page.waitForSelector('.badge.paused');
      assert.match(await page.textContent('.room-log'), /Paused the room.*Fire alarm/s);
      const focused = await page.evaluate(() => document.activeElement !== document.body);
      assert.ok(focused || (await page.locator('.room-buttons button:text-is("Pause")').count()) === 0);
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
      const act = async (label, fill) => {
        await page.click(`.room-buttons button:text-is("${label}")`);
        await fill?.();
        await page.click('.suggestions button >> nth=0');
        await page.click('dialog button[type=submit]');
        await page.waitForSelector('dialog', { state: 'detached' });
      };
      await act('Extend', () => page.fill('dialog input[type=number]', '90'));
      await act('Message', () => page.fill('dialog textarea', 'Five more minutes'));
      await act('Strategy', () => page.selectOption('dialog select', 'individual-low'));
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
      await page.click('.banner button');
      await page.waitForSelector('.banner', { state: 'detached' });
      await page.waitForSelector('.room-buttons');
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
      await page.waitForSelector('.live .globe');
      seen += await page.textContent('body');
      assert.equal(await page.locator('.room-buttons').count(), 0);
      await page.click('button.seat >> nth=0');
      seen += await page.textContent('dialog');
      assert.equal(await page.locator('dialog .dialog-buttons').count(), 0);
      assert.doesNotMatch(seen, /Ada|Ben|KITH-|#t=/);
      assert.deepEqual([...new Set(mock.commands.map(({ t }) => t))], ['room-select']);
    });
  });

  it('turns all spheres by keys, sliders and dragging', async () => {
    await withPage({ calm: true }, async (page) => {
      await openRoom(page, 'Room A1');
      const shapes = () => page.$$eval('.globe .dots:not(.behind)', (all) => all.map((path) => path.getAttribute('d')));
      const first = await shapes();
      assert.equal(first.length, 5);
      const changed = async (what) => {
        const now = await shapes();
        now.forEach((path, i) => assert.notEqual(path, first[i], `${what} did not turn sphere ${i}`));
        await page.click('button:text-is("Reset view")');
        assert.deepEqual(await shapes(), first);
      };
      await page.focus('.globes');
      await page.keyboard.press('ArrowRight');
      await changed('a key');
      await page.focus('.turners input >> nth=1');
      await page.keyboard.press('ArrowUp');
      await changed('the slider');
      const box = await page.locator('.globe svg').nth(2).boundingBox();
      await page.mouse.move(box.x + 40, box.y + 60);
      await page.mouse.down();
      await page.mouse.move(box.x + 90, box.y + 80);
      await page.mouse.up();
      await changed('dragging');
    });
  });

  it('draws particles where they are: behind the ball or in front', async () => {
    await withPage({ calm: true }, async (page) => {
      await openRoom(page, 'Room A1');
      const counts = await page.$$eval('.globe', (all) =>
        all.map((globe) => [...globe.querySelectorAll('.dots')].reduce((n, path) => n + (path.getAttribute('d').match(/M/g) ?? []).length, 0)),
      );
      assert.deepEqual(counts, [300, 300, 300, 300, 300]);
      const outside = await page.$$eval('.globe .dots', (all) =>
        all.flatMap((path) =>
          [...path.getAttribute('d').matchAll(/M(-?[\d.]+) (-?[\d.]+)/g)].filter(([, x, y]) => Math.hypot(x, y) > 100.2),
        ).length,
      );
      assert.equal(outside, 0);
    });
  });

  it('explains terms and answers on hover and focus; Escape hides the explanation', async () => {
    await withPage({ calm: true }, async (page) => {
      await openRoom(page, 'Room A1');
      await page.hover('.answer-cell.wrong >> nth=0');
      assert.match(await page.textContent('#tip'), /Period \d+, test \d+: wrong.*regret \d\.\d\d, [\d.]+ s/);
      await page.focus('.chart .term');
      assert.match(await page.textContent('#tip'), /share of a belief/);
      assert.equal(await page.getAttribute('.chart .term', 'aria-describedby'), 'tip');
      await page.keyboard.press('Escape');
      assert.equal(await page.isVisible('#tip'), false);
    });
  });

  it('plays the demonstration that is shown, says why, and shows what came next', async () => {
    await withPage({}, async (page) => {
      await openRoom(page, 'Room A1');
      await page.waitForFunction(() => document.querySelector('.shown .step')?.textContent.startsWith('Step'));
      assert.match(await page.textContent('.why-text'), /joint belief still allows rubble/);
      assert.equal(await page.locator('.runners .board').count(), 5);
      await page.click('.picks button:text-is("Test 1")');
      assert.match(await page.textContent('.shown-facts'), /It tests that/);
    });
    await withPage({ calm: true }, async (page) => {
      await openRoom(page, 'Room A1');
      assert.equal(await page.locator('.shown .play').count(), 0);
      assert.match(await page.textContent('.shown .step'), /has not moved yet/);
    });
  });

  it('draws bars where there are not three features, and lists steps where there is no map', async () => {
    await withPage({ calm: true }, async (page, mock) => {
      mock.change = (detail) => {
        const states = ['home', 'hall', 'work'].map((state, i) => ({ state, action: i < 2 ? 'walk' : null }));
        const board = { domain: { id: 'walk' }, world: 1, start: states[0] };
        const shown = { board, frames: states, gain: 2, sentences: ['walking costs something'] };
        return {
          ...detail,
          beliefs: [],
          truth: { weights: [0.5, 0.5, 0.5, 0.5], bec: [], prior: [] },
          lesson: { ...detail.lesson, demonstrations: [shown], tests: [shown], runners_up: [{ board, gain: 1, sentences: [] }] },
        };
      };
      await openTab(page, 'Rooms');
      await page.click('.rooms button:text-is("Room A1")');
      await page.waitForSelector('.bars li');
      assert.equal(await page.locator('.bars li').count(), 5);
      assert.match(await page.textContent('.spheres'), /this domain has 4/);
      assert.match(await page.textContent('.steps'), /In home.*walk/s);
      assert.deepEqual(await violations(page), []);
      await shoot(page, 'bars-light');
    });
  });

  it('keeps what the reader is doing when a new view arrives', async () => {
    await withPage({ calm: true }, async (page, mock) => {
      await openRoom(page, 'Room A1');
      await page.click('.shown button[aria-label="Next step"]');
      await page.click('.shown button[aria-label="Next step"]');
      await page.focus('.globes');
      await page.keyboard.press('ArrowLeft');
      const path = await page.getAttribute('.globe .bec-region', 'd');
      mock.view.rooms[0].strategy = 'common';
      mock.showAll();
      await page.waitForFunction(() => document.querySelector('.room-bar').textContent.includes('common'));
      assert.match(await page.textContent('.shown .step'), /^Step 2/);
      assert.equal(await page.getAttribute('.globe .bec-region', 'd'), path);
      assert.ok(await page.evaluate(() => document.activeElement?.classList.contains('globes')));
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

  it('makes rooms with people and simulated learners, and shows their links with QR codes', async () => {
    await withPage({ rooms: 0 }, async (page, mock) => {
      await page.waitForSelector('.make');
      await page.selectOption('#make-strategy', 'common');
      await page.fill('#make-size', '4');
      await page.fill('#make-count', '2');
      await page.selectOption('.seat-choices select >> nth=3', 'P');
      assert.match(await page.textContent('fieldset'), /3 of 4 are people/);
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
        Date.now = () => real() + 86_400_000; // this computer is a day ahead
      });
      await page.reload();
      await openRoom(page, 'Room A1');
      assert.match(await page.textContent('.room-bar'), /Running for 14:\d\d/);
    });
  });
});
