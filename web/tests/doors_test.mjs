// Lessons in a file as learning systems and pages around them have them: a package played under scorm-again, statements
// checked by xapi-validation, messages to the page of a frame.
//
//   node tests/doors_test.mjs --kith PROGRAM [--modules DIR] [--chromium FILE]
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { createServer } from 'node:http';
import { tmpdir } from 'node:os';
import { dirname, join } from 'node:path';
import { after, before, describe, it } from 'node:test';
import { fileURLToPath } from 'node:url';
import { parseArgs } from 'node:util';
import { launch, requireFrom } from './browser.mjs';
import { reach, until } from './live/kith_tests.mjs';
import { Reader } from './live/reader.mjs';

const here = dirname(fileURLToPath(import.meta.url));
const { values } = parseArgs({
  options: {
    kith: { type: 'string' },
    modules: { type: 'string', default: join(here, '..') },
    chromium: { type: 'string', default: '/usr/bin/chromium' },
  },
});
if (!values.kith) {
  console.error('usage: node tests/doors_test.mjs --kith PROGRAM [--modules DIR] [--chromium FILE]');
  process.exit(2);
}
const folder = mkdtempSync(join(tmpdir(), 'kith-doors-'));
const require = requireFrom(values.modules);
const validate = require('xapi-validation').default;
const kRoom = 4096; // characters of suspend data
let browser, server, origin;

// Whoever keeps statements and states: what it is told is checked and remembered.
class Store {
  statements = [];
  states = new Map();
  trouble = [];
  isDown = false;

  answer(request, url, body) {
    if (url.pathname === '/fetch') return [200, { 'auth-token': 'a-token' }];
    if (this.isDown) return [503, {}];
    assert.equal(request.headers.authorization, 'Basic a-token');
    assert.equal(request.headers['x-experience-api-version'], '1.0.3');
    if (url.pathname === '/store/statements') {
      const all = JSON.parse(body);
      for (const one of all) assert.deepEqual(validate(one).map(String), []);
      this.statements.push(...all);
      return [200, all.map(({ id }) => id)];
    }
    const name = url.searchParams.get('stateId');
    assert.ok(url.searchParams.get('activityId') && url.searchParams.get('agent') && url.searchParams.get('registration'));
    if (request.method === 'PUT') this.states.set(name, body);
    else if (!this.states.has(name)) return [404, {}];
    return [200, this.states.get(name)];
  }
}
let store;

const kLearningSystem = `<!doctype html><title>A learning system</title><script src="/scorm12.js"></script>
<script>window.API = new Scorm12API({ autocommit: false, logLevel: 5 });</script>`;
const around = (lesson) => `<!doctype html><title>A survey</title><iframe src="${lesson}" width="1000" height="800"></iframe>
<script>window.told = []; addEventListener('message', ({ data }) => window.told.push(data));</script>`;

// What the page does wrong is said at the end of the test.
function answerOfStore(request, url, body) {
  try {
    return store.answer(request, url, body);
  } catch (error) {
    store.trouble.push(error.message);
    return [400, {}];
  }
}

function serve(request, response, body) {
  const url = new URL(request.url, 'http://here');
  const send = (status, type, content) => response.writeHead(status, { 'Content-Type': type }).end(content);
  if (url.pathname === '/system.html') return send(200, 'text/html', kLearningSystem);
  if (url.pathname === '/survey.html') return send(200, 'text/html', around(`${origin}/framed.html`));
  if (url.pathname === '/scorm12.js') return send(200, 'text/javascript', readFileSync(join(values.modules, 'node_modules/scorm-again/dist/scorm12.min.js')));
  if (url.pathname === '/lesson.html' || url.pathname === '/framed.html') return send(200, 'text/html; charset=utf-8', readFileSync(join(folder, url.pathname)));
  if (url.pathname === '/favicon.ico') return send(204, 'image/png', '');
  const [status, content] = answerOfStore(request, url, body);
  return send(status, 'application/json', typeof content === 'string' ? content : JSON.stringify(content));
}

before(async () => {
  browser = await launch(values.modules, values.chromium);
  server = createServer((request, response) => {
    let body = '';
    request.on('data', (piece) => (body += piece));
    request.on('end', () => serve(request, response, body));
  });
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
  origin = `http://127.0.0.1:${server.address().port}`;
  const kith = (...words) => execFileSync(values.kith, words, { encoding: 'utf8' });
  kith('lesson', 'item-delivery', '-o', join(folder, 'lesson.zip'));
  kith('lesson', 'item-delivery', '--origin', origin, '-o', join(folder, 'framed.html'));
  execFileSync('python3', ['-m', 'zipfile', '-e', join(folder, 'lesson.zip'), folder]);
});
after(async () => {
  await browser?.close();
  server?.close();
  rmSync(folder, { recursive: true, force: true });
});

describe('a package for learning systems', () => {
  it('is described as SCORM 1.2 and cmi5 want it', () => {
    const xml = (name) =>
      execFileSync('python3', ['-c', 'import sys, xml.etree.ElementTree as t; print(*[e.tag.split("}")[1] for e in t.parse(sys.argv[1]).iter()])', join(folder, name)], { encoding: 'utf8' });
    assert.match(xml('imsmanifest.xml'), /^manifest metadata schema schemaversion organizations organization title item title resources resource file/);
    assert.match(xml('cmi5.xml'), /^courseStructure course title langstring description langstring au title langstring description langstring url/);
  });

  // A visit to the learning system, which opens the lesson in a window of its own.
  async function visit(kept, body) {
    const context = await browser.newContext({ reducedMotion: 'reduce' });
    const system = await context.newPage();
    await system.goto(`${origin}/system.html`);
    await system.evaluate((json) => json && window.API.loadFromJSON(json, ''), kept);
    const opening = context.waitForEvent('page');
    await Reader.listen(context);
    await system.evaluate(() => void window.open('/lesson.html'));
    const reader = new Reader(context, await opening, origin);
    await reader.arrived();
    const value = (name) => system.evaluate((one) => window.API.cmi && window.API.getCMIValue(one), name);
    await body(reader, value, system);
    await reader.page.close({ runBeforeUnload: false });
    await until(() => reader.page.isClosed());
    const cmi = await system.evaluate(() => JSON.parse(JSON.stringify(window.API.cmi)));
    assert.deepEqual(reader.trouble, []);
    await context.close();
    return cmi;
  }

  it('is left in the middle under SCORM 1.2, gone on with elsewhere, and finished', async () => {
    let before;
    const left = await visit(null, async (reader, value) => {
      await reach([reader], ['feedback']);
      await reach([reader], ['watch']);
      await reach([reader], ['predict']);
      before = { stage: reader.view.stage, progress: reader.view.progress };
      assert.equal(await value('cmi.core.lesson_status'), 'incomplete');
    });
    assert.ok(left.suspend_data.length > 100 && left.suspend_data.length <= kRoom, `${left.suspend_data.length} characters`);
    assert.equal(left.core.exit, 'suspend');

    const done = await visit({ cmi: { suspend_data: left.suspend_data, core: { lesson_status: 'incomplete', entry: 'resume' } } }, async (reader, value) => {
      assert.deepEqual({ stage: reader.view.stage, progress: reader.view.progress }, before);
      await reach([reader], ['debrief', 'ended']);
      await reader.page.waitForFunction(() => window.opener.API.getCMIValue('cmi.core.lesson_status') !== 'incomplete');
      assert.equal(await value('cmi.core.lesson_status'), 'passed');
      assert.equal(await value('cmi.core.score.raw'), '100');
    });
    assert.ok(done.suspend_data.length <= kRoom, `${done.suspend_data.length} characters`);
    assert.match(done.core.session_time, /^\d{2,4}:\d{2}:\d{2}\.\d{2}$/);
    console.log(`suspend data: ${left.suspend_data.length} characters in the middle, ${done.suspend_data.length} at the end`);
  });

  it('says so where the learning system refuses what it is told, and goes on', async () => {
    await visit(null, async (reader, value, system) => {
      reader.expects.push(/cmi\.|LMSCommit/);
      await reach([reader], ['check']);
      await system.evaluate(() => Object.assign(window.API, { LMSSetValue: () => 'false' }));
      await reach([reader], ['watch']);
      await reader.page.getByText('The learning system did not take your result just now.').waitFor();
      await reach([reader], ['predict']);
    });
  });

  it('says so where there is no learning system', async () => {
    const context = await browser.newContext();
    await Reader.listen(context);
    const reader = new Reader(context, await context.newPage(), `${origin}/lesson.html`);
    await reader.open();
    await reader.page.getByText('The learning system was not found').waitFor();
    await context.close();
  });

  it('tells a cmi5 system every prediction and component, and each end once', async () => {
    store = new Store();
    const address = (session) => {
      const extensions = { 'https://w3id.org/xapi/cmi5/context/extensions/sessionid': session };
      const contextTemplate = { contextActivities: { grouping: [{ id: 'https://example.org/course' }] }, extensions };
      store.states.set('LMS.LaunchData', JSON.stringify({ contextTemplate, launchMode: 'Normal', moveOn: 'CompletedOrPassed' }));
      const query = { endpoint: `${origin}/store`, fetch: `${origin}/fetch?${session}`, registration: '7b0b6c1e-2f1a-4f0e-9d3a-0e4f6f1f3c11', activityId: 'urn:example:au' };
      const actor = JSON.stringify({ objectType: 'Agent', account: { homePage: 'https://example.org', name: '17' } });
      return `${origin}/lesson.html?${new URLSearchParams({ ...query, actor })}`;
    };
    const session = async (name, body) => {
      const context = await browser.newContext({ reducedMotion: 'reduce' });
      await Reader.listen(context);
      const reader = new Reader(context, await context.newPage(), address(name));
      reader.expects.push(/404/);
      await reader.open();
      assert.deepEqual(store.trouble, []);
      await body(reader);
      const last = () => store.statements[store.statements.length - 1].verb.display.en;
      await reader.page.goto('about:blank');
      await until(() => last() === 'terminated');
      assert.deepEqual([...store.trouble, ...reader.trouble], []);
      await context.close();
    };
    let before;
    await session('one', async (reader) => {
      await reach([reader], ['feedback']);
      await reach([reader], ['watch']);
      before = reader.view.progress;
    });
    await session('two', async (reader) => {
      assert.deepEqual(reader.view.progress, before);
      await reach([reader], ['debrief', 'ended']);
      await until(() => store.statements.some(({ verb }) => verb.display.en === 'completed'));
    });
    const verbs = store.statements.map(({ verb }) => verb.display.en);
    const count = (verb) => verbs.filter((one) => one === verb).length;
    assert.equal(verbs[0], 'initialized');
    assert.deepEqual(['initialized', 'terminated', 'passed', 'failed', 'completed'].map(count), [2, 2, 1, 0, 1]);
    const answered = store.statements.filter(({ verb }) => verb.display.en === 'answered');
    assert.equal(new Set(answered.map(({ object }) => object.id)).size, answered.length, 'a prediction was told twice');
    for (const { result } of answered) {
      assert.equal(typeof Object.values(result.extensions)[0], 'number');
      assert.equal(result.success, true);
    }
    assert.ok(count('progressed') > 0);
    assert.equal(store.statements.find(({ verb }) => verb.display.en === 'passed').result.score.scaled, 1);
  });
});

describe('a lesson in a frame', () => {
  it('tells the page around it, if the author named where that is from, and nobody else', async () => {
    for (const [name, isNamed] of [[origin, true], [origin.replace('127.0.0.1', 'localhost'), false]]) {
      const page = await browser.newPage();
      await page.goto(`${name}/survey.html`);
      const lesson = page.frameLocator('iframe');
      await lesson.getByRole('checkbox').check();
      await lesson.getByRole('button', { name: 'Agree and continue' }).click();
      await lesson.getByRole('heading', { name: 'What this is about' }).waitFor();
      if (isNamed) {
        await page.waitForFunction(() => window.told.length > 0);
        const [first] = await page.evaluate(() => window.told);
        assert.deepEqual([first.type, first.event, first.score], ['kith-lesson', 'progress', null]);
      } else {
        assert.deepEqual(await page.evaluate(() => window.told), []);
      }
      await page.close();
    }
  });
});
