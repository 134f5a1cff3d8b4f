// A document may lack parts; the page leaves them out. And its strings are text, whatever is in them.
//
//   node tests/parts_test.mjs TEMPLATE DOCUMENT [--modules DIR] [--chromium FILE]
import assert from 'node:assert/strict';
import { mkdtempSync, readFileSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { dirname, join } from 'node:path';
import { after, before, describe, it } from 'node:test';
import { fileURLToPath, pathToFileURL } from 'node:url';
import { parseArgs } from 'node:util';
import { fillPage } from '../sample/fill_page.mjs';
import { launch, openReport } from './browser.mjs';

const { values, positionals } = parseArgs({
  allowPositionals: true,
  options: {
    modules: { type: 'string', default: join(dirname(fileURLToPath(import.meta.url)), '..') },
    chromium: { type: 'string', default: '/usr/bin/chromium' },
  },
});
if (positionals.length !== 2) {
  console.error('usage: node tests/parts_test.mjs TEMPLATE DOCUMENT [--modules DIR] [--chromium FILE]');
  process.exit(2);
}
const [template, sample] = positionals.map((file) => readFileSync(file, 'utf8'));
const folder = mkdtempSync(join(tmpdir(), 'kith-report-'));
let browser;

async function withDocument(change, body) {
  const document = JSON.parse(sample);
  change(document);
  const file = join(folder, 'report.html');
  writeFileSync(file, fillPage(template, JSON.stringify(document)));
  const report = await openReport(browser, pathToFileURL(file).href, { width: 800, dark: false });
  try {
    await body(report);
    assert.deepEqual(report.trouble, [], 'requests, console messages or uncaught errors');
  } finally {
    await report.context.close();
  }
}

const sections = (page) => page.$$eval('main section', (all) => all.map(({ id }) => id));
const numbers = (page) =>
  page.$$eval('figcaption strong', (all) => all.map(({ textContent }) => Number(/\d+/.exec(textContent)[0])));

// In a suite, because Node.js 18 runs hooks only there, and for `it` alone.
describe('a document', () => {
  before(async () => (browser = await launch(values.modules, values.chromium)));
  after(async () => browser?.close());

  for (const name of Object.keys(JSON.parse(sample).tables)) {
    it(`without the table ${name} the rest is shown`, async () => {
      await withDocument(
        (document) => delete document.tables[name],
        async ({ page }) => {
          const shown = await numbers(page);
          assert.deepEqual(
            shown,
            shown.map((_, i) => i + 1),
          );
          assert.ok(shown.length >= 9, `${shown.length} figures`);
        },
      );
    });
  }

  it('a document with nothing but its overview is a page', async () => {
    const needed = ['schema', 'title', 'study', 'domain', 'overview', 'tables'];
    const bare = (document) => {
      for (const key of Object.keys(document)) if (!needed.includes(key)) delete document[key];
      document.tables = {};
      document.overview = { strategies: [], compositions: [] };
    };
    await withDocument(bare, async ({ page }) => assert.deepEqual(await sections(page), ['summary', 'notices']));
  });

  it('what a study varies makes panels, with a row per strategy in each', async () => {
    const varied = (document) => {
      document.overview.factors = ['teacher.noise'];
      const { columns, rows } = document.tables.cells;
      const settings = [0.1, 0.5].flatMap((noise) => rows.map(([strategy, ...row]) => [`${strategy} [teacher.noise=${noise}]`, ...row]));
      document.tables.cells = { columns, rows: settings };
      const { strategies } = document.labels;
      document.labels.strategies = Object.fromEntries(
        settings.map(([code]) => [code, `${strategies[code.split(' ')[0]]}, noise ${/=(.*)\]/.exec(code)[1]}`]),
      );
      document.overview.strategies = Object.keys(document.labels.strategies);
    };
    await withDocument(varied, async ({ page }) => {
      const text = await page.textContent('#figure-knowledge svg');
      assert.match(text, /Common.*a  NNN, ?noise 0[.]1.*h  PPP, ?noise 0[.]5/);
      assert.doesNotMatch(text, /Common, noise/);
    });
  });

  it('missing values, single teams and unknown strategies do no harm', async () => {
    const odd = (document) => {
      const { cells, teams } = document.tables;
      for (const name of ['periods_low', 'periods_high', 'knowledge_mean'])
        cells.rows[0][cells.columns.indexOf(name)] = null;
      teams.rows = teams.rows.slice(0, 1);
      const rename = (row) => row.map((cell) => (cell === 'joint' ? 'own-strategy' : cell));
      for (const table of Object.values(document.tables)) table.rows = table.rows.map(rename);
      document.overview.strategies = rename(document.overview.strategies);
      document.beliefs.teams[0].mass[0][0] = null;
    };
    await withDocument(odd, async ({ page }) =>
      assert.match(await page.textContent('#figure-periods svg'), /own-strategy/),
    );
  });

  it('markup in a string of the document stays text', async () => {
    const attack = '</script><img src=x onerror="window.attacked=1"><script>window.attacked=1</script>';
    const hostile = (document) => {
      document.title = attack;
      document.overview.finding = attack;
      document.overview.answers[0].question = attack;
      document.labels.meanings.strategies.common = attack;
      document.notes = [attack];
      document.labels.strategies.joint = attack;
      document.findings[0].sentence = attack;
      document.beliefs.teams[0].title = attack;
      document.lessons.sentences[0].text = attack;
      document.lessons.boards[0].text = attack;
    };
    await withDocument(hostile, async ({ page }) => {
      assert.equal(await page.textContent('h1'), `${attack}.`);
      assert.equal(await page.title(), attack);
      assert.equal(await page.evaluate(() => window.attacked), undefined);
      const dots = page.locator('#figure-periods svg path[opacity="0.38"]');
      const hovered = async (dot) => {
        await dot.hover();
        return page.textContent('#vg-tooltip-element.visible');
      };
      const joint = await dots.evaluateAll((all) => all.findLastIndex((one) => one.__data__.datum.strategy.startsWith('<')));
      assert.ok((await hovered(dots.nth(joint))).includes(attack), 'the tooltip has the words');
      assert.match(await hovered(dots.last()), /Teams[NP]+Periods/, 'a row of the baseline is a composition');
      assert.equal(await page.$('img'), null);
    });
  });
});
