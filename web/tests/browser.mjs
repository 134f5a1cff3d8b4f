// Debian's Chromium without network, watched: requests that leave the page, console errors and
// uncaught errors are collected.
import assert from 'node:assert/strict';
import { createRequire } from 'node:module';
import { join, resolve } from 'node:path';
import { setTimeout } from 'node:timers/promises';

const kPatience = 120_000; // milliseconds: the machine may be busy; nothing here is about time

const kFlags = [
  '--headless',
  '--no-sandbox',
  '--disable-gpu',
  '--no-first-run',
  '--disable-background-networking',
  '--disable-component-update',
  '--disable-sync',
];

export function requireFrom(modules) {
  return createRequire(join(resolve(modules), 'package.json'));
}

export async function launch(modules, executablePath) {
  const { chromium } = requireFrom(modules)('playwright-core');
  return chromium.launch({ executablePath, args: kFlags });
}

// A page with the file open in it.
export async function openPage(browser, address, { width, dark, reducedMotion = false }) {
  const context = await browser.newContext({
    viewport: { width, height: 900 },
    colorScheme: dark ? 'dark' : 'light',
    reducedMotion: reducedMotion ? 'reduce' : 'no-preference',
    acceptDownloads: true,
  });
  await context.setOffline(true);
  const trouble = [];
  await context.route('**/*', (route) => {
    const url = route.request().url();
    if (/^(file|blob|data):/.test(url)) return route.continue();
    trouble.push(`request: ${url}`);
    return route.abort();
  });
  const page = await context.newPage();
  page.setDefaultTimeout(kPatience);
  page.on('console', (message) => {
    if (['error', 'warning'].includes(message.type())) trouble.push(`console: ${message.text()}`);
  });
  page.on('pageerror', (error) => trouble.push(`uncaught: ${error.message}`));
  await page.goto(address);
  await page.waitForSelector('main section');
  return { context, page, trouble };
}

// The same for a report, with its charts drawn.
export async function openReport(browser, address, look) {
  const opened = await openPage(browser, address, look);
  await opened.page.waitForFunction(() =>
    [...document.querySelectorAll('.drawing')].every((box) => box.dataset.drawn && box.querySelector('svg')),
  );
  return opened;
}

// That a part of a page comes to read so: what a click leads to is drawn after the click has been handled.
export async function reads(part, pattern) {
  const end = Date.now() + kPatience;
  let text = await part.textContent();
  while (!pattern.test(text) && Date.now() < end) {
    await setTimeout(50);
    text = await part.textContent();
  }
  assert.match(text, pattern);
}

// What people who depend on assistive technology could not use: of all rules, or of some.
export async function violations(page, axeSource, { exclude = [], rules } = {}) {
  if (rules?.length === 0) return [];
  // From the debugger, so that the page's policy stays as it is.
  if (!(await page.evaluate(() => 'axe' in window))) await page.evaluate(axeSource);
  const { violations: found } = await page.evaluate(
    ([hidden, runOnly]) => window.axe.run({ exclude: hidden }, { resultTypes: ['violations'], ...(runOnly ? { runOnly } : {}) }),
    [exclude, rules],
  );
  return found
    .filter(({ impact }) => impact === 'serious' || impact === 'critical')
    .map(({ id, nodes }) => `${id}: ${nodes.slice(0, 3).map(({ html }) => html.slice(0, 160))}`);
}
