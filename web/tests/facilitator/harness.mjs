// Opens the facilitator page on a real `kith serve`, whose rooms simulated people have been taught in, and watches it.
import assert from 'node:assert/strict';
import { mkdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { launch, requireFrom, violations } from '../browser.mjs';
import { Client, play, serve, until, Wire } from '../kith.mjs';

export { until };

export const openTab = (page, name) => page.click(`nav button:text-is("${name}")`);

export async function openRoom(page, title) {
  await openTab(page, 'Rooms');
  await page.click(`.rooms button:text-is("${title}")`);
  await openDeep(page);
}

// What is for researchers.
export async function openDeep(page) {
  const deep = page.locator('.deep');
  await deep.waitFor();
  if (!(await deep.evaluate((box) => box.open))) await deep.locator('summary').first().click();
  await page.waitForSelector('.live .globe .ball');
}

export const received = (wire, type) => wire.of(type).map(({ body }) => body);

const kStudy = {
  size: 3,
  group: 'ask_name = true',
  keys: ['design.strategies=["joint", "common", "individual-low"]', 'stop.max_periods=40', 'group.time.predict_s=3600'],
};
const kNames = ['Ada', 'Ben'];

// `screenshots`: where pictures go, or nothing.
export class Harness {
  constructor({ kith, screenshots, modules, chromium }) {
    Object.assign(this, { kith, screenshots, modules, chromium, titles: {} });
    // From the debugger, so that the page's policy stays as it is.
    this.axe = readFileSync(requireFrom(modules).resolve('axe-core/axe.min.js'), 'utf8');
    for (const name of ['withPage', 'violations', 'shoot', 'room', 'facilitatorLink']) this[name] = this[name].bind(this);
  }

  async open() {
    this.browser = await launch(this.modules, this.chromium);
    this.running = await serve(this.kith, kStudy);
    this.facilitator = await Client.open(this.modules, this.running.server.facilitator);
    this.people = [];
    this.titles.three = await this.room({});
    this.titles.twelve = await this.room({ seats: [...kNames.map(() => 'person'), ...Array(10).fill('P')], periods: 4, areRight: true });
    this.titles.one = await this.room({ seats: ['person'], periods: 2 });
    this.titles.paused = await this.room({});
    await this.facilitator.ask('pause', { room: this.facilitator.view.rooms.at(-1).id, reason: 'A question' });
    this.titles.lobby = await this.room({ periods: 0 });
  }

  async close() {
    for (const person of this.people) person.close();
    this.facilitator?.close();
    await this.browser?.close();
    await this.running?.close();
  }

  facilitatorLink() {
    return this.running.server.facilitator;
  }

  // A new room whose people have completed some periods, were wrong in the first, and are answering: its title.
  async room({ seats = ['person', 'person', 'P'], periods = 1, areRight = false }) {
    const { facilitator, running, modules } = this;
    const known = new Set(facilitator.view.rooms.map(({ id }) => id));
    const made = () => facilitator.view.rooms.find(({ id }) => !known.has(id));
    await facilitator.ask('room-make', { strategy: 'joint', seats, count: 1, reason: 'a test' });
    await until(() => made()?.seats.every(({ kind, link }) => kind === 'simulated' || link));
    await facilitator.ask('room-select', { room: made().id, reason: 'a test' }); // what else could be shown is shown
    const links = made().seats.flatMap(({ link }) => link ?? []);
    const people = periods === 0 ? [] : links.map((link) => new Client(modules, running.server, link.split('#t=')[1]));
    await until(() => people.every(({ view }) => view !== null));
    for (const [i, person] of people.entries()) {
      await person.step();
      await person.ask('name', { name: kNames[i] });
    }
    const isOver = () => people.every(({ view }) => view.stage === 'predict' && view.progress.round > periods);
    const short = (world, start) => [world.table.next[start].findIndex((to) => to >= 0)];
    await play(people, (i) => (!areRight && people[i].view.progress?.round === 1 ? short : undefined), isOver);
    this.people.push(...people);
    return `Room ${made().code}`;
  }

  // A page that is connected to the server, and the wire between them; afterwards no request may have left the server,
  // and nothing may have been written to the console. `expected` are console messages that belong to the test.
  async withPage(look, body) {
    const { role = 'facilitator', token, width = 1280, dark = false, calm = false, expected = [] } = look;
    const { origin } = this.running.server;
    const context = await this.browser.newContext({
      viewport: { width, height: 800 },
      colorScheme: dark ? 'dark' : 'light',
      reducedMotion: calm ? 'reduce' : 'no-preference',
      acceptDownloads: true,
    });
    const trouble = [];
    await context.route('**/*', (route) => {
      const url = route.request().url();
      if (url.startsWith(origin) || /^(data|blob):/.test(url)) return route.continue();
      trouble.push(`request: ${url}`);
      return route.abort();
    });
    const wire = await new Wire().between(context);
    context.setDefaultTimeout(90_000); // machines that test are busy
    const page = await context.newPage();
    page.on('console', (message) => {
      const isExpected = expected.some((text) => message.text().includes(text));
      if (['error', 'warning'].includes(message.type()) && !isExpected) trouble.push(`console: ${message.text()}`);
    });
    page.on('pageerror', (error) => trouble.push(`uncaught: ${error.message}`));
    try {
      await page.goto(token === undefined ? this.running.server[role] : `${origin}/f${token === '' ? '' : `#t=${token}`}`);
      await page.waitForSelector('main');
      await body(page, wire, context);
      assert.deepEqual(trouble, [], 'requests, console messages or uncaught errors');
    } finally {
      await context.close();
    }
  }

  // Of all rules of axe, or of some.
  violations(page, rules) {
    return violations(page, this.axe, { rules });
  }

  async shoot(page, name) {
    if (!this.screenshots) return;
    mkdirSync(this.screenshots, { recursive: true });
    await page.screenshot({ path: join(this.screenshots, `facilitator-${name}.png`) });
  }
}
