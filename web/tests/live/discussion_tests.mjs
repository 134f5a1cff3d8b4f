// A group that discusses its predictions in the demonstration of `kith serve`: three people, two discussions.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { describe, it } from 'node:test';
import { Client, until } from '../kith.mjs';
import { reach, withDemonstration } from './kith_tests.mjs';
import { openPerson, Person } from './person.mjs';

const kNames = ['Ada Lovelace', 'Blaise Pascal', 'Carl Gauss'];
const kLooks = [{}, {}, { width: 320, height: 640, dark: true }];
// Somebody counts as away after 10 s, and is no longer waited for 2 s later. The limit is that of the last discussion;
// those before it get more time.
const kKeys = ['group.discussion.model="majority"', 'group.ask_name=true', 'group.time.discuss_s=6', 'group.dropout.grace_s=2'];

// Gives the discussion more time.
async function extend({ modules }, { facilitator }) {
  const client = await Client.open(modules, facilitator);
  await client.ask('extend', { room: client.view.rooms[0].id, seconds: 600, reason: 'a test' });
  client.close();
}

const shownTo = ({ view }) => view.discuss.predictions;
const withoutOwn = (predictions) => predictions.map(({ own, ...rest }) => rest);

// Decides about everything that the person is asked about: the own prediction, or the first other one.
async function decide(person, keeps) {
  while (person.view.stage === 'discuss') {
    const { index } = person.view.discuss;
    await decideOnce(person, keeps);
    await until(() => person.view.stage !== 'discuss' || person.view.discuss.index > index);
  }
}

async function decideOnce(person, keeps) {
  const { index } = person.view.discuss;
  const letter = String.fromCharCode(65 + shownTo(person).findIndex(({ own }) => !own));
  await person.page.waitForFunction((i) => document.querySelector('.kicker')?.textContent.startsWith(`Task ${i} `), index + 1);
  await person.button(keeps ? 'Keep mine' : `Change to ${letter}`).click();
}

// The stage as somebody sees it: all predictions, the own one marked, nothing about who gave the others.
async function examine(setting, person, name, others) {
  const { page } = person;
  await person.at('What your group predicted');
  const shown = shownTo(person);
  assert.equal(await page.locator('.predictions li').count(), shown.length);
  assert.equal(await page.locator('.predictions .way').count(), shown.length);
  const own = shown.findIndex((one) => one.own);
  assert.match(await page.locator('.predictions li').nth(own).textContent(), /Yours.*Keep mine/s);
  assert.equal(await page.locator('.predictions .own .tag').count(), 1);
  const told = `${await page.textContent('body')} ${JSON.stringify(person.frames)}`;
  for (const one of others) assert.ok(!told.includes(one), one);
  assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= document.documentElement.clientWidth));
  if (setting.screenshots) {
    mkdirSync(setting.screenshots, { recursive: true });
    await page.screenshot({ path: join(setting.screenshots, `kith-discuss-${name}.png`), fullPage: true });
  }
  assert.deepEqual(await person.violations(setting.axe), []);
}

// The rows of tables that are exported while the server is running.
function exported(kith, { folder, session }) {
  const tables = join(folder, 'tables');
  execFileSync(kith, ['session', 'export', session, '-q', '-o', tables]);
  return (name) => {
    const [head, ...lines] = readFileSync(join(tables, name), 'utf8').trim().split('\n').map((line) => line.split(','));
    return lines.map((line) => Object.fromEntries(head.map((column, i) => [column, line[i]])));
  };
}

async function seesWhoChanged(setting, { facilitator }) {
  const { page } = await openPerson(setting.browser, facilitator);
  await page.goto(facilitator);
  await page.waitForSelector('.answer-cell.wrong', { state: 'attached' });
  const texts = await page.$$eval('.answer-cell [role=img]', (cells) => cells.map((cell) => cell.getAttribute('aria-label')));
  assert.deepEqual(texts.map((text) => /, then changed to a right one$/.test(text)), texts.map((text) => text.startsWith('wrong')));
  await page.context().close();
}

export function discussionTests(setting) {
  describe('kith serve with a group that talks', () => {
    it('shows predictions without names, and loses no decision to a reload, another tab, a kill or somebody who leaves', async () => {
      await withDemonstration(setting, (people, running) => talk(setting, people, running), { keys: kKeys, looks: kLooks });
    });
  });
}

async function talk(setting, people, running) {
  const [first, second, third] = people;
  for (const [i, person] of people.entries()) {
    person.expectLosses();
    await person.consent();
    await person.at('What this is about');
    await person.page.fill('#name', kNames[i]);
  }
  const numTests = [];
  const reachStage = async (group, wrong) => {
    await reach(group, ['discuss'], (person) => person !== wrong);
    numTests.push(first.view.discuss.of);
  };

  await reachStage(people, second);
  await extend(setting, running.server);
  for (const person of people) assert.deepEqual(shownTo(person).map(({ n }) => n).sort(), [1, 2]);
  assert.deepEqual(shownTo(first), shownTo(third));
  assert.deepEqual(withoutOwn(shownTo(first)), withoutOwn(shownTo(second)));
  await examine(setting, first, 'light-1280', kNames.slice(1));
  await examine(setting, third, 'dark-320', kNames.slice(0, 2));

  const before = shownTo(first);
  first.view = null;
  await first.page.reload();
  await first.at('What your group predicted');
  assert.deepEqual(shownTo(first), before);
  const tab = await openTab(third);
  await tab.at('What your group predicted');
  await third.at('Open in another tab');
  await decide(second, false);
  await until(() => second.view.stage === 'wait');

  await running.server.stop('SIGKILL');
  await decideOnce(tab, true); // nobody is there to hear it
  await tab.page.waitForFunction(() => document.querySelector('.predictions ~ [role=status]').textContent.includes('saved'));
  for (const person of [first, second, tab]) person.view = null;
  const { facilitator } = running.server; // a second start cannot say it
  running.server = { ...(await running.start(running.server.port)), facilitator };
  await until(() => first.view?.stage === 'discuss' && second.view?.stage === 'wait' && tab.view && tab.view.discuss?.index !== 0);
  assert.equal(second.view.wait.for, 'discussion');
  assert.deepEqual(shownTo(first), before);
  for (const person of [tab, first]) await decide(person, true);
  for (const person of [first, second, tab]) await person.at('Correct');
  await seesWhoChanged(setting, running.server);

  await reachStage([first, second, tab], first);
  await extend(setting, running.server);
  await third.close(); // and the tab
  await decide(first, true);
  await decide(second, false);
  for (const person of [first, second]) await person.at('Not quite');

  await reachStage([first, second], first);
  await decide(second, true);
  await first.at('Not quite'); // did not decide
  await second.at('Correct');

  const table = exported(setting.kith, running);
  const given = table('discussions.csv').map((row) => `${row.period}/${row.seat}: ${row.correct} ${row.revised_correct} ${row.changed}`);
  assert.deepEqual([...new Set(given)], [
    '1/1: true true false',
    '1/2: false true true',
    '1/3: true true false',
    '2/1: false false false',
    '2/2: true false true',
    '2/3: true true false',
    '3/1: false false false',
    '3/2: true true false',
  ]);
  const decisions = table('events.csv').filter(({ type }) => type === 'discussed');
  assert.equal(decisions.length, 3 * numTests[0] + 2 * numTests[1] + numTests[2]);
  assert.deepEqual(tab.trouble, []);
}

// A second tab of the same browser.
async function openTab({ page, context, origin }) {
  const token = await page.evaluate(() => JSON.parse(sessionStorage.getItem('kith.token')));
  const tab = new Person(context, await context.newPage(), `${origin}/j#t=${token}`);
  tab.expectLosses();
  return tab.open();
}
