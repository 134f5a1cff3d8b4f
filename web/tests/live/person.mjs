// Somebody who takes part: a browser's page, watched, and what they do on it.
import assert from 'node:assert/strict';
import { kPatience, until, Wire } from '../kith.mjs';
import { bestPath, priced } from './delivery.mjs';

// A page in a context of its own; requests to elsewhere, console messages and uncaught errors are collected. With
// `stopped`, time passes on the page only when `pass` says so.
export async function openPerson(browser, address, look = {}) {
  const { width = 1280, height = 900, dark = false, reducedMotion = false, scale = 1, offline = false, stopped = false, hasTouch = false, locale = 'en-US' } = look;
  const context = await browser.newContext({
    viewport: { width, height },
    deviceScaleFactor: scale,
    colorScheme: dark ? 'dark' : 'light',
    reducedMotion: reducedMotion ? 'reduce' : 'no-preference',
    acceptDownloads: true,
    offline,
    hasTouch,
    locale,
  });
  if (stopped) {
    await context.clock.install({ time: 0 });
    await context.clock.pauseAt(1000);
  }
  const wire = look.isDirect ? null : await new Wire().between(context);
  return new Person(context, await context.newPage(), address, wire);
}

export class Person {
  constructor(context, page, address, wire) {
    const { origin } = new URL(address);
    Object.assign(this, { context, page, address, origin, wire, trouble: [], view: null, frames: [], expects: [] });
    page.on('request', (request) => {
      const url = request.url();
      if (new URL(url).origin !== origin && !/^(blob|data):/.test(url)) this.trouble.push(`request: ${url}`);
    });
    page.on('console', (message) => {
      const text = message.text();
      const isExpected = this.expects.some((pattern) => pattern.test(`${text} ${message.location().url}`));
      if (['error', 'warning'].includes(message.type()) && !isExpected) this.trouble.push(`console: ${text}`);
    });
    page.on('pageerror', (error) => this.trouble.push(`uncaught: ${error.message}`));
    page.on('websocket', (socket) => {
      if (new URL(socket.url()).host !== new URL(origin).host) this.trouble.push(`socket: ${socket.url()}`);
      socket.on('framereceived', ({ payload }) => {
        const frame = JSON.parse(payload);
        this.frames.push(frame);
        if (frame.t === 'view') this.view = frame.view;
      });
    });
    page.setDefaultTimeout(kPatience);
    // A study without texts of its own answers 404, which a browser reports.
    this.expects.push(/api\/texts/);
  }

  async open() {
    await this.page.goto(this.address);
    await this.page.waitForSelector('h1');
    return this;
  }

  async join() {
    await this.open();
    await this.page.locator('main button.primary').first().click(); // in any language
    await until(() => this.view !== null);
    return this;
  }

  // To the page with the first task.
  async toPredict() {
    await this.consent();
    await this.check();
    for (let left = await this.examples(); left > 0; left -= 1) await this.watch();
    await this.atStage('predict');
    await this.page.waitForSelector('.drive-area');
  }

  async examples() {
    await until(() => this.view.stage === 'watch');
    return this.view.watch.of;
  }

  async close() {
    await this.context.close();
  }

  // On the page's clock.
  pass(ms) {
    return this.page.clock.runFor(ms);
  }

  // Lost connections are reported by the browser, whatever the page does about them.
  expectLosses() {
    this.expects.push(/WebSocket|ERR_INTERNET_DISCONNECTED|ERR_EMPTY_RESPONSE|ERR_CONNECTION|Failed to load resource|net::/);
  }

  heading() {
    return this.page.textContent('h1');
  }

  async at(heading) {
    await this.page.waitForFunction((text) => document.querySelector('h1')?.textContent === text, heading);
  }

  async atStage(stage) {
    await this.page.waitForSelector(`main.stage-${stage}`);
  }

  button(name) {
    return this.page.getByRole('button', { name, exact: true });
  }

  async consent() {
    await this.atStage('consent');
    const box = this.page.getByRole('checkbox');
    if ((await box.count()) > 0) await box.check();
    await this.page.locator('main button.primary').first().click();
  }

  async check() {
    await this.at('What this is about');
    await this.button('Continue').click();
    await this.at('Try the controls');
    await this.drive(await this.best());
    await this.button('Continue').click();
  }

  // The best path of what is to be driven now, by numbers of actions; [0 .. n) of the table.
  async best() {
    const task = this.view.predict ?? this.view.check;
    const table = await this.table(task.world);
    return bestPath(priced(table), task.start).actions.map((action) => table.actions[action].name);
  }

  // By the browser, which knows what to do when a connection that it kept is closed.
  async table(key) {
    const { status, table } = await this.page.evaluate(async (name) => {
      const token = JSON.parse(sessionStorage.getItem('kith.token'));
      const reply = await fetch(`/api/world/${name}`, { headers: { Authorization: `Bearer ${token}` } });
      return { status: reply.status, table: await reply.json() };
    }, key);
    assert.equal(status, 200);
    return table;
  }

  // With the keyboard, wherever the focus is.
  async drive(names) {
    const keys = { up: 'ArrowUp', down: 'ArrowDown', left: 'ArrowLeft', right: 'ArrowRight', pickup: 'Space', dropoff: 'Space' };
    await this.page.waitForSelector('.drive-area');
    await this.page.focus('.drive-area');
    for (const name of names) await this.page.keyboard.press(keys[name]);
  }

  // One example by keyboard, step by step; `look` is called after every step.
  async watch(look) {
    await this.at('Watch the robot');
    const { index, of } = this.view.watch;
    const kicker = `Example ${index + 1} of ${of}`;
    await this.page.waitForFunction((text) => document.querySelector('.kicker')?.textContent === text, kicker);
    for (let i = 1; i < this.view.watch.frames.length; i += 1) {
      await this.page.keyboard.press('ArrowRight');
      await look?.();
    }
    await this.button('Next').click();
    await this.page.waitForFunction(
      (text) => document.querySelector('.kicker')?.textContent !== text,
      kicker,
    );
  }

  drawn(kind) {
    return this.page.evaluate((name) => {
      const line = document.querySelector(`.live-board .way.${name} .line`);
      return line ? line.getAttribute('points').split(' ').length : 0;
    }, kind);
  }

  // The word at the top of the page: Saved, Saving or Reconnecting.
  async hasStatus(word) {
    await this.page.waitForFunction((text) => document.querySelector('.status')?.textContent.includes(text), word);
  }

  // Until the last sentence about the board says so.
  async said(text) {
    await this.page.waitForFunction((part) => document.querySelector('[role=log] p:last-child')?.textContent.includes(part), text);
  }

  // Until the submit button has this below it.
  async counts(text) {
    await this.page.waitForFunction((part) => document.querySelector('.submit p')?.textContent.includes(part), text);
  }

  // All tasks of a period; `names` per task, or the best path.
  async answer(names) {
    await this.atStage('predict');
    const { of } = this.view.predict;
    for (let index = this.view.predict.index; index < of; index += 1) {
      await this.page.waitForFunction((i) => document.querySelector('.kicker')?.textContent.startsWith(`Task ${i} `), index + 1);
      await this.drive(names ?? (await this.best()));
      await this.button('Submit').click();
      const anyway = this.button('Submit anyway');
      if (names && (await anyway.isVisible())) await anyway.click();
    }
  }

  async feedback() {
    await this.atStage('feedback');
    for (;;) {
      const isLast = await this.button('Continue').isVisible();
      await this.button(isLast ? 'Continue' : 'Next').click();
      if (isLast) return;
    }
  }

  // Of all rules, or of some. Text in the colour of its ground is no violation to axe, which takes it for hidden.
  async violations(axe, rules) {
    if (rules?.length === 0) return [];
    // From the debugger, so that the page's policy stays as it is.
    if (!(await this.page.evaluate(() => 'axe' in window))) await this.page.evaluate(axe);
    const { violations, incomplete } = await this.page.evaluate(
      (runOnly) => window.axe.run(document, { resultTypes: ['violations', 'incomplete'], ...(runOnly ? { runOnly } : {}) }),
      rules,
    );
    const isInvisible = ({ any }) => any.some(({ data }) => data?.messageKey === 'equalRatio');
    const unreadable = incomplete.map(({ id, nodes }) => ({ id, impact: 'serious', nodes: nodes.filter(isInvisible) }));
    return [...violations, ...unreadable.filter(({ nodes }) => nodes.length > 0)]
      .filter(({ impact }) => impact === 'serious' || impact === 'critical')
      .map(({ id, nodes }) => `${id}: ${nodes.slice(0, 3).map(({ html }) => html.slice(0, 160))}`);
  }
}
