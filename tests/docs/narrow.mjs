// node narrow.mjs SITE MODULES CHROMIUM: on a telephone no page of the documentation is wider than the screen, and the
// search, opened from a file, finds pages without an error.
import assert from 'node:assert/strict';
import { readdirSync } from 'node:fs';
import { launch } from '../../web/tests/browser.mjs';

const [site, modules, chromium] = process.argv.slice(2);
const browser = await launch(modules, chromium);
const page = await browser.newPage({ viewport: { width: 360, height: 800 } });
const trouble = [];
page.on('console', (message) => message.type() === 'error' && trouble.push(message.text()));
page.on('pageerror', (error) => trouble.push(error.message));

for (const name of readdirSync(`${site}/docs`).filter((file) => file.endsWith('.html'))) {
  await page.goto(`file://${site}/docs/${name}`);
  if ((await page.evaluate(() => document.documentElement.scrollWidth)) > 360) trouble.push(`${name} is too wide`);
}
await page.goto(`file://${site}/search.html?q=half-space`);
await page.waitForSelector('#search-results a[href$="notation.html"]');
await page.waitForLoadState('networkidle');
await browser.close();
assert.deepEqual(trouble, []);
