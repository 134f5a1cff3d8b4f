// Opens the facilitator page on a mock of the server, and watches it.
import assert from 'node:assert/strict';
import { mkdirSync, readFileSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { launch, requireFrom, violations } from '../browser.mjs';
import { MockServer, kTokens } from '../facilitator_mock.mjs';

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

export const received = (mock, type) => mock.commands.filter(({ t }) => t === type).map(({ body }) => body);

export async function until(what, condition) {
  const end = Date.now() + 30_000;
  while (!(await condition())) {
    assert.ok(Date.now() < end, `waited in vain for ${what}`);
    await new Promise((done) => setTimeout(done, 25));
  }
}

// `app`: the built folder; `screenshots`: where pictures go, or nothing.
export class Harness {
  constructor({ app, screenshots, modules, chromium }) {
    Object.assign(this, { app: resolve(app), screenshots, modules, chromium });
    // From the debugger, so that the page's policy stays as it is.
    this.axe = readFileSync(requireFrom(modules).resolve('axe-core/axe.min.js'), 'utf8');
    this.withPage = this.withPage.bind(this);
    this.violations = this.violations.bind(this);
    this.shoot = this.shoot.bind(this);
  }

  async open() {
    this.browser = await launch(this.modules, this.chromium);
  }

  async close() {
    await this.browser?.close();
  }

  // A server, and a page that is connected to it; afterwards no request may have left the server, and nothing may
  // have been written to the console. `expected` are console messages that belong to the test.
  async withPage(look, body) {
    const { role = 'facilitator', token, width = 1280, dark = false, calm = false, expected = [], ...options } = look;
    const mock = new MockServer(this.app, this.modules, options);
    await mock.start();
    const context = await this.browser.newContext({
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
    context.setDefaultTimeout(90_000); // machines that test are busy
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
