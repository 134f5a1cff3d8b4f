// Lessons in a file as learning systems and pages around them have them: a package played under scorm-again, statements
// checked by xapi-validation, messages to the page of a frame.
//
//   node tests/doors_test.mjs --kith PROGRAM [--screenshots DIR] [--modules DIR] [--chromium FILE]
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
import { Cmi5Player } from './doors/cmi5_player.mjs';
import { until } from './kith.mjs';
import { reach } from './live/kith_tests.mjs';
import { Reader } from './live/reader.mjs';

const here = dirname(fileURLToPath(import.meta.url));
const { values } = parseArgs({
  options: {
    kith: { type: 'string' },
    modules: { type: 'string', default: join(here, '..') },
    screenshots: { type: 'string' },
    chromium: { type: 'string', default: '/usr/bin/chromium' },
  },
});
if (!values.kith) {
  console.error('usage: node tests/doors_test.mjs --kith PROGRAM [--screenshots DIR] [--modules DIR] [--chromium FILE]');
  process.exit(2);
}
const folder = mkdtempSync(join(tmpdir(), 'kith-doors-'));
const require = requireFrom(values.modules);
const validate = require('xapi-validation').default;
const kRoom = 4096; // characters of suspend data
let browser, server, origin;

let player; // of cmi5

const kLearningSystem = `<!doctype html><title>A learning system</title><script src="/scorm12.js"></script>
<script>window.API = new Scorm12API({ autocommit: false, logLevel: 5 });</script>`;
const around = (lesson) => `<!doctype html><title>A survey</title><iframe src="${lesson}" width="1000" height="800"></iframe>
<script>window.told = []; addEventListener('message', ({ data }) => window.told.push(data));</script>`;

function serve(request, response, body) {
  const url = new URL(request.url, 'http://here');
  const send = (status, type, content) => response.writeHead(status, { 'Content-Type': type }).end(content);
  if (url.pathname === '/system.html') return send(200, 'text/html', kLearningSystem);
  if (url.pathname === '/survey.html') return send(200, 'text/html', around(`${origin}/framed.html`));
  if (url.pathname === '/scorm12.js') return send(200, 'text/javascript', readFileSync(join(values.modules, 'node_modules/scorm-again/dist/scorm12.min.js')));
  if (url.pathname === '/lesson.html' || url.pathname === '/framed.html') return send(200, 'text/html; charset=utf-8', readFileSync(join(folder, url.pathname)));
  if (url.pathname === '/favicon.ico') return send(204, 'image/png', '');
  const [status, content] = player.answer(url.href, { method: request.method, headers: request.headers, body });
  if (url.pathname === '/lrs/statements' && status === 200) {
    for (const one of JSON.parse(body)) player.refused.push(...validate(one).map(String));
  }
  return send(status, 'application/json', content);
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
    assert.equal(await system.evaluate(() => window.API.isInitialized()), false, 'nothing is read before consent');
    await reader.page.getByText('Once you agree, the learning system').waitFor();
    if (values.screenshots) await reader.page.screenshot({ path: join(values.screenshots, 'consent_scorm.png'), fullPage: true });
    await reader.consent();
    await until(() => reader.view.stage !== 'consent');
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
      await reader.page.waitForFunction(() => window.opener.API.getCMIValue('cmi.core.lesson_status') === 'incomplete');
      assert.equal(await value('cmi.core.lesson_status'), 'incomplete');
    });
    assert.ok(left.suspend_data.length > 100 && left.suspend_data.length <= kRoom, `${left.suspend_data.length} characters`);
    assert.equal(left.core.exit, 'suspend');

    const done = await visit({ cmi: { suspend_data: left.suspend_data, core: { lesson_status: 'incomplete', entry: 'resume' } } }, async (reader, value) => {
      await until(() => reader.view.stage === before.stage);
      assert.deepEqual(reader.view.progress, before.progress);
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

  it('tells a cmi5 system every prediction and component, each end once, and nothing that it refuses', async () => {
    player = new Cmi5Player({ returnURL: `${origin}/system.html` });
    const visitPlayer = async (body) => {
      const context = await browser.newContext({ reducedMotion: 'reduce' });
      await Reader.listen(context);
      const reader = new Reader(context, await context.newPage(), player.launch(`${origin}/lesson.html`, origin));
      reader.expects.push(/404/);
      const { requests } = player;
      await reader.open();
      assert.equal(player.requests, requests, 'nothing is asked before consent');
      await reader.page.getByText('Once you agree, it is told each of your predictions').waitFor();
      await reader.consent();
      await until(() => reader.view.stage !== 'consent');
      await body(reader);
      assert.deepEqual([...player.refused, ...reader.trouble], []);
      await context.close();
    };
    let before;
    await visitPlayer(async (reader) => {
      await reach([reader], ['feedback']);
      await reader.reload();
      await reach([reader], ['watch']);
      before = reader.view.progress;
      await reader.button('Leave the lesson').click();
      await reader.page.waitForURL('**/system.html');
      assert.equal(player.verbs.at(-1), 'terminated');
    });
    await visitPlayer(async (reader) => {
      await until(() => reader.view.stage === 'watch');
      assert.deepEqual(reader.view.progress, before);
      await reach([reader], ['debrief', 'ended']);
      await until(() => player.states.get('kith').includes('"hasCompleted":true'));
      await reader.page.waitForLoadState('networkidle');
      await reader.page.goto('about:blank');
      await until(() => player.verbs.at(-1) === 'terminated');
    });
    const { verbs, statements } = player;
    const count = (verb) => verbs.filter((one) => one === verb).length;
    assert.deepEqual(['initialized', 'terminated', 'passed', 'failed', 'completed'].map(count), [2, 2, 1, 0, 1]);
    const answered = statements.filter(({ verb }) => verb.display.en === 'answered');
    assert.equal(new Set(answered.map(({ object }) => object.id)).size, answered.length, 'a prediction was told twice');
    for (const { result } of answered) {
      assert.equal(typeof Object.values(result.extensions)[0], 'number');
      assert.equal(result.success, true);
    }
    assert.ok(count('progressed') > 0);
    assert.equal(statements.find(({ verb }) => verb.display.en === 'passed').result.score.scaled, 1);
  });

  it('starts again in the same visit when the learner does', async () => {
    player = new Cmi5Player();
    const context = await browser.newContext({ reducedMotion: 'reduce' });
    await Reader.listen(context);
    const reader = new Reader(context, await context.newPage(), player.launch(`${origin}/lesson.html`, origin));
    reader.expects.push(/404/);
    await reader.open();
    await reach([reader], ['predict']);
    await reader.button('Start again').click();
    await Promise.all([reader.page.waitForEvent('load'), reader.button('Erase and start again').click()]);
    await reader.page.waitForSelector('main.stage-consent');
    await until(() => reader.view.stage === 'consent');
    await reach([reader], ['watch']);
    assert.deepEqual([...player.refused, ...reader.trouble], []);
    assert.equal(player.verbs.filter((verb) => verb === 'initialized').length, 1);
    await context.close();
  });
});

describe('a lesson in a frame', () => {
  it('tells the page around it, if the author named where that is from, and nobody else', async () => {
    for (const [name, isNamed] of [[origin, true], [origin.replace('127.0.0.1', 'localhost'), false]]) {
      const page = await browser.newPage();
      await page.goto(`${name}/survey.html`);
      const lesson = page.frameLocator('iframe');
      await lesson.getByText('Once you agree, the page around this lesson').waitFor();
      assert.deepEqual(await page.evaluate(() => window.told), [], 'nothing is told before consent');
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
