// The doors of lesson files against learning systems that refuse what breaks the rules for content: every rule is
// refused when it is broken, and nothing that a lesson does is. Without a browser; doors_test.mjs plays whole lessons.
//
//   node tests/door_rules_test.mjs [--modules DIR]
import assert from 'node:assert/strict';
import { createRequire } from 'node:module';
import { dirname, join, resolve } from 'node:path';
import { before, beforeEach, describe, it } from 'node:test';
import { fileURLToPath } from 'node:url';
import { parseArgs } from 'node:util';
import { Cmi5Player, kCmi5Rules } from './doors/cmi5_player.mjs';
import { kScormRules, ScormSystem } from './doors/scorm_system.mjs';

const here = dirname(fileURLToPath(import.meta.url));
const { values } = parseArgs({ options: { modules: { type: 'string', default: join(here, '..') } } });
let doors;
before(async () => {
  const { build } = createRequire(join(resolve(values.modules), 'package.json'))('esbuild');
  const names = ['doors/cmi5', 'doors/door', 'doors/reporter', 'doors/scorm', 'log'].map((name) => `export * from './${name}';`);
  const stdin = { contents: names.join('\n'), resolveDir: join(here, '../src/file') };
  const { outputFiles } = await build({ stdin, bundle: true, write: false, format: 'esm', platform: 'browser' });
  doors = await import(`data:text/javascript;base64,${Buffer.from(outputFiles[0].text).toString('base64')}`);
});

// As much of a browser as a door sees. A tab keeps its session storage, and knows whether its page was loaded again.
class Storage {
  setItem(key, text) {
    this[key] = String(text);
  }
  getItem(key) {
    return Object.hasOwn(this, key) ? this[key] : null;
  }
  removeItem(key) {
    delete this[key];
  }
}
let listeners;
const define = (name, value, of = globalThis) => Object.defineProperty(of, name, { value, configurable: true, writable: true });
// A window tells nothing of itself to other sites.
const windowOf = (parts = {}) => {
  const made = { opener: null, listeners: {}, addEventListener: (type, call) => (listeners[type] ??= []).push(call), ...parts };
  made.parent ??= made;
  return made;
};
const foreign = (parts) => new Proxy(windowOf(parts), { get: (on, name) => (['parent', 'opener'].includes(name) ? on[name] : assert.fail('another site')) });
function load(around, isAgain) {
  listeners = {};
  define('window', windowOf(around));
  define('getEntriesByType', () => [{ type: isAgain ? 'reload' : 'navigate' }], performance);
}
beforeEach(() => {
  define('sessionStorage', new Storage());
  define('localStorage', new Storage());
  define('location', { search: '' });
  console.warn = () => undefined;
});
const settle = () => new Promise((done) => setTimeout(done, 0));

const progress = (n, isFinished, right = true) => ({
  predictions: Array.from({ length: n }, (_, i) => ({ period: Math.floor(i / 2), test: i % 2, right, regret: right ? 0 : 1, ms: 900 })),
  components: [{ name: 'mud', status: isFinished && right ? 'learned' : 'open' }],
  isFinished,
});

describe('the rules of cmi5', () => {
  function open(player, isAgain = false) {
    if (!isAgain) define('location', { search: new URL(player.launch()).search });
    define('fetch', async (address, init) => {
      const [status, text] = player.answer(address, init);
      return new Response(status === 204 ? null : text, { status });
    });
    load({}, isAgain);
    return doors.openCmi5();
  }

  it('are each refused when they are broken', async () => {
    const template = { context: { registration: new Cmi5Player().registration } };
    const kFull = (player, verb, more = {}) => {
      const isJudged = verb === 'passed' || verb === 'failed';
      const categories = ['cmi5', ...(isJudged || verb === 'completed' ? ['moveon'] : [])];
      const category = categories.map((name) => ({ id: `https://w3id.org/xapi/cmi5/context/categories/${name}` }));
      const result = { ...(isJudged ? { success: verb === 'passed', score: { scaled: verb === 'passed' ? 1 : 0 } } : {}), ...(verb === 'completed' ? { completion: true } : {}), duration: 'PT1S' };
      return {
        id: crypto.randomUUID(),
        timestamp: new Date().toISOString(),
        actor: JSON.parse(player.actor),
        verb: { id: `http://adlnet.gov/expapi/verbs/${verb}` },
        object: { id: player.activity },
        ...(verb === 'initialized' ? {} : { result }),
        context: {
          ...template.context,
          contextActivities: { grouping: [{ id: 'https://lms.example/course' }], category },
          extensions: { ...player.launched.contextTemplate.extensions, ...(isJudged && player.masteryScore !== undefined ? { 'https://w3id.org/xapi/cmi5/context/extensions/masteryscore': player.masteryScore } : {}) },
        },
        ...more,
      };
    };
    const seen = new Set();
    const session = ({ options = {}, told = ['initialized'], ever = [], preferences = true } = {}) => {
      const player = new Cmi5Player(options);
      player.launch();
      Object.assign(player, { told: [...told], toldEver: [...ever, ...told], hasPreferences: preferences, hasToken: true });
      return player;
    };
    const broken = (player, verb, change = () => undefined) => {
      const one = kFull(player, verb);
      change(one);
      player.take([one], (rule) => player.refused.push(rule));
      assert.equal(player.refused.length, 1, `${verb} ${change}`);
      seen.add(player.refused[0]);
    };
    broken(session(), 'completed', (one) => (one.id = 'no uuid'));
    broken(session(), 'completed', (one) => (one.actor = {}));
    broken(session({ told: [] }), 'completed');
    broken(session(), 'initialized');
    broken(session({ told: ['initialized', 'failed'] }), 'passed');
    broken(session({ ever: ['completed'] }), 'completed');
    broken(session({ ever: ['passed'] }), 'passed');
    broken(session({ ever: ['passed'] }), 'failed');
    broken(session({ options: { masteryScore: 0.8 } }), 'passed', (one) => (one.result.score.scaled = 0.5));
    broken(session({ options: { masteryScore: 0.8 } }), 'failed', (one) => (one.result.score.scaled = 0.9));
    broken(session({ told: ['initialized', 'terminated'] }), 'completed');
    broken(session(), 'completed', (one) => (one.object.id = 'urn:other'));
    broken(session(), 'completed', (one) => (one.result.score = { scaled: 1 }));
    broken(session(), 'passed', (one) => (one.result.score.scaled = 2));
    broken(session(), 'passed', (one) => (one.result.success = false));
    broken(session(), 'completed', (one) => delete one.result.completion);
    broken(session(), 'terminated', (one) => delete one.result.duration);
    broken(session(), 'completed', (one) => (one.context.registration = 'other'));
    broken(session(), 'completed', (one) => delete one.context.contextActivities.grouping);
    broken(session(), 'terminated', (one) => (one.context.contextActivities.category = []));
    broken(session(), 'completed', (one) => one.context.contextActivities.category.pop());
    broken(session(), 'completed', (one) => (one.context.extensions = {}));
    broken(session({ options: { masteryScore: 0.8 } }), 'passed', (one) => delete one.context.extensions['https://w3id.org/xapi/cmi5/context/extensions/masteryscore']);
    broken(session(), 'completed', (one) => (one.timestamp = '2026-01-01T10:00:00+01:00'));
    broken(session({ options: { launchMode: 'Browse' } }), 'completed');
    broken(session({ preferences: false }), 'completed');
    const asked = (path, init, hasToken = true) => {
      const player = session();
      player.hasToken = hasToken;
      player.answer(`https://lms.example${path}`, { headers: { Authorization: 'Basic a-token' }, ...init });
      assert.equal(player.refused.length, 1);
      seen.add(player.refused[0]);
    };
    asked('/elsewhere', {});
    asked('/fetch', {}, false);
    asked('/fetch', { method: 'POST' });
    asked('/lrs/statements', { headers: {} });
    asked('/lrs/activities/state?stateId=LMS.LaunchData', { method: 'PUT', body: '{}' });
    assert.deepEqual(new Set(kCmi5Rules.map(([, rule]) => rule)), seen);
  });

  it('are kept by a lesson that is left in the middle and finished in the next visit', async () => {
    const player = new Cmi5Player({ masteryScore: 0.8 });
    let door = await open(player);
    await door.report(progress(2, false), 'log');
    door.leave();
    door = await open(player);
    assert.equal(door.recalled, 'log');
    await door.report(progress(4, true), 'log2');
    door.leave();
    await settle();
    door.leave();
    await settle();
    assert.deepEqual(player.verbs, ['initialized', 'answered', 'answered', 'initialized', 'answered', 'answered', 'progressed', 'passed', 'completed', 'terminated']);
    assert.deepEqual(player.refused, []);
  });

  it('are kept over loading the page again: nothing after terminated, which comes once', async () => {
    const player = new Cmi5Player();
    let door = await open(player);
    await door.report(progress(2, false), 'log');
    door.leave();
    door = await open(player, true);
    await door.report(progress(4, true), 'log2');
    door.leave();
    await settle();
    door = await open(player, true);
    await assert.rejects(door.report(progress(5, true), 'log3'));
    await door.close();
    assert.deepEqual(player.verbs.filter((verb) => verb !== 'answered'), ['initialized', 'progressed', 'passed', 'completed', 'terminated']);
    assert.deepEqual(player.refused, []);
  });

  it('give the address to go to when the learner leaves', async () => {
    const player = new Cmi5Player({ returnURL: 'https://lms.example/back' });
    const door = await open(player);
    assert.equal(await door.close(), 'https://lms.example/back');
    assert.deepEqual(player.verbs, ['initialized', 'terminated']);
    assert.equal(await (await open(new Cmi5Player())).close(), '');
  });

  it('are kept by who starts again: the token lives on, and what is new is told', async () => {
    const player = new Cmi5Player();
    let door = await open(player);
    await door.report(progress(4, false, false), 'log');
    await door.restart();
    doors.eraseLog({ digest: 'd' }, door.learner);
    door.leave();
    door = await open(player, true);
    assert.equal(door.recalled, '');
    await door.report(progress(2, true), 'log2');
    assert.equal(player.verbs.filter((verb) => verb === 'answered').length, 6);
    assert.deepEqual(player.refused, []);
  });

  it('let a later pass be told, in the next visit', async () => {
    const player = new Cmi5Player({ masteryScore: 0.8 });
    let door = await open(player);
    await door.report(progress(4, true, false), 'log');
    await door.restart();
    door = await open(player, true);
    await door.report(progress(4, true), 'log2');
    assert.deepEqual(player.refused, []);
    assert.ok(!player.verbs.includes('passed'), 'a visit is told of one judgement');
    door = await open(player);
    await door.report(progress(4, true), door.recalled);
    await door.report(progress(4, true, false), door.recalled);
    assert.deepEqual(player.verbs.filter((verb) => ['passed', 'failed', 'completed'].includes(verb)), ['failed', 'completed', 'passed']);
    assert.deepEqual(player.refused, []);
  });

  for (const launchMode of ['Browse', 'Review']) {
    it(`are kept where a lesson is only looked at: ${launchMode}`, async () => {
      const player = new Cmi5Player({ launchMode });
      const door = await open(player);
      await door.report(progress(4, true), 'log');
      await door.restart();
      await door.close();
      assert.deepEqual(player.verbs, ['initialized', 'terminated']);
      assert.deepEqual(player.refused, []);
    });
  }

  it('let everything be told once, whichever answer is lost, on this page or when it is loaded again', async () => {
    for (let lost = 1; lost < 8; lost += 1) {
      define('sessionStorage', new Storage());
      const player = new Cmi5Player(), { answer } = player;
      player.answer = (...request) => [answer.apply(player, request), player.requests === lost + 1 && assert.fail('lost')][0];
      let door = null;
      const tell = async () => (door ??= await open(player, player.requests > 0)).report(progress(2, true), 'log');
      await tell().catch(() => lost % 2 === 0 && (door = null));
      await tell();
      assert.deepEqual([player.verbs, player.refused], [['initialized', 'answered', 'answered', 'progressed', 'passed', 'completed'], []], `${lost}`);
    }
  });

  it('leave a lesson unread and untold until somebody has agreed', async () => {
    const player = new Cmi5Player();
    define('location', { search: new URL(player.launch()).search });
    define('fetch', async () => assert.fail('asked'));
    load({}, false);
    const opening = doors.findDoor();
    assert.equal(opening.system, 'cmi5');
    const reporter = new doors.Reporter({ origins: [] }, () => undefined);
    await reporter.news({ stage: 'consent' });
    assert.equal(player.requests, 0);
  });
});

describe('the rules of SCORM', () => {
  function open(system, isAgain = false, place = (api) => ({ parent: windowOf({ [system.object]: api }) })) {
    if (!isAgain) system.api = system.visit();
    load(place(system.api), isAgain);
    return doors.openScorm();
  }

  it('are each refused when they are broken', () => {
    for (const version of ['1.2', '2004']) {
      const system = new ScormSystem(version);
      const { prefix } = system;
      const api = system.visit();
      api[`${prefix}GetValue`]('cmi.suspend_data');
      api[`${prefix}Initialize`]('x');
      api[`${prefix}Initialize`]('');
      api[`${prefix}Initialize`]('');
      api[`${prefix}GetValue`]('cmi.nothing');
      api[`${prefix}SetValue`]('cmi.suspend_data', 'x'.repeat(64001));
      assert.equal(system.refused.length, 5);
      assert.deepEqual(new Set(system.refused), new Set(kScormRules.map(([, rule]) => rule)));
    }
  });

  for (const version of ['1.2', '2004']) {
    it(`${version}: are kept by a lesson that is left in the middle and finished in the next visit`, async () => {
      const system = new ScormSystem(version);
      let door = open(system);
      assert.equal(door.learner, 'learner-7');
      await door.report(progress(3, false), 'log');
      assert.equal(system.status, 'incomplete');
      door.leave();
      door = open(system);
      assert.equal(door.recalled, 'log');
      await door.report(progress(4, true), 'log2');
      door.leave();
      assert.deepEqual([system.status, system.score, system.refused], ['passed', '100', []]);
    });

    it(`${version}: are kept by who looks again: what was reached is never lowered`, async () => {
      const system = new ScormSystem(version);
      let door = open(system);
      await door.report(progress(2, true), 'log');
      door.leave();
      system.kept.set('cmi.suspend_data', ''); // as systems may after a normal exit
      for (const again of [progress(0, false), progress(1, false, false), progress(2, true, false)]) {
        door = open(system);
        await door.report(again, 'log2');
        door.leave();
        assert.deepEqual([system.status, system.score, system.refused], ['passed', '100', []]);
      }
    });

    it(`${version}: are kept by who completes it, and passes it later`, async () => {
      const system = new ScormSystem(version);
      let door = open(system);
      await door.report({ ...progress(2, true), components: [{ name: 'mud', status: 'skipped' }] }, 'log');
      assert.equal(system.status, 'completed');
      door.leave();
      door = open(system);
      await door.report(progress(2, true), 'log');
      assert.deepEqual([system.status, system.refused], ['passed', []]);
    });

    it(`${version}: are kept by who starts again, on the same page`, async () => {
      const system = new ScormSystem(version);
      let door = open(system);
      await door.report(progress(2, false, false), 'log');
      await door.restart();
      doors.eraseLog({ digest: 'd' }, door.learner);
      door.leave();
      door = open(system, true);
      assert.equal(door.recalled, '');
      await door.report(progress(2, true), 'log2');
      door.leave();
      assert.deepEqual([system.status, system.kept.get('cmi.suspend_data'), system.refused], ['passed', 'log2', []]);
    });

    it(`${version}: lose nothing when the page is loaded again in the system's frame`, async () => {
      const system = new ScormSystem(version);
      let door = open(system);
      await door.report(progress(2, false), 'log');
      door.leave();
      door = open(system, true); // which has finished the visit, and says so
      assert.equal(door.learner, 'learner-7', 'the learner finds what the browser keeps of theirs');
      await assert.rejects(door.report(progress(3, false), 'log2'), { constructor: doors.VisitIsOver });
      door.leave();
      system.refused = [];
      door = open(system);
      await door.report(progress(4, true), 'log3');
      assert.deepEqual([system.status, system.kept.get('cmi.suspend_data'), system.refused], ['passed', 'log3', []]);
    });

    it(`${version}: are kept by who only looks`, async () => {
      const system = new ScormSystem(version);
      system.kept.set(version === '1.2' ? 'cmi.core.lesson_mode' : 'cmi.mode', 'review');
      const { status } = system;
      const door = open(system);
      await door.report(progress(2, true), 'log');
      await door.restart();
      await door.close();
      assert.deepEqual([system.status, system.refused], [status, []]);
    });
  }

  it('take every spelling of yes', async () => {
    for (const spelling of [['true', 'false'], [true, false], ['1', '0'], [1, 0], ['True', 'False'], ['TRUE', 'FALSE']]) {
      const system = new ScormSystem('1.2', spelling);
      const door = open(system);
      await door.report(progress(2, true), 'log');
      assert.deepEqual([system.status, system.refused], ['passed', []], String(spelling[0]));
      Object.assign(system.api, { LMSSetValue: () => spelling[1] });
      await assert.rejects(door.report(progress(2, true), 'log'));
    }
  });

  it('let the object be around the page, in what opened it, and around that', async () => {
    for (const version of ['1.2', '2004']) {
      const { object } = new ScormSystem(version);
      for (const place of [
        (api) => ({ parent: windowOf({ [object]: api }) }),
        (api) => ({ parent: windowOf({ parent: windowOf({ [object]: api }) }) }),
        (api) => ({ opener: windowOf({ [object]: api }) }),
        (api) => ({ opener: windowOf({ parent: windowOf({ [object]: api }) }) }),
        (api) => ({ parent: windowOf({ opener: windowOf({ [object]: api }) }) }),
        (api) => ({ parent: windowOf({ opener: windowOf({ parent: windowOf({ [object]: api }) }) }) }),
        (api) => ({ parent: foreign({ parent: windowOf({ [object]: api }) }) }),
        (api) => ({ parent: foreign({}), opener: windowOf({ [object]: api }) }),
      ]) {
        const system = new ScormSystem(version);
        const door = open(system, false, place);
        assert.equal(door?.learner, 'learner-7', String(place));
      }
    }
    load({ parent: windowOf({ parent: foreign({}) }) }, false);
    assert.equal(doors.openScorm(), null);
  });

  it('leave a lesson unread and untold until somebody has agreed', async () => {
    const system = new ScormSystem();
    system.api = system.visit();
    load({ parent: windowOf({ API: system.api }) }, false);
    const opening = doors.findDoor();
    assert.equal(opening.system, 'scorm');
    const reporter = new doors.Reporter({ origins: [] }, () => undefined);
    await reporter.news({ stage: 'consent' });
    assert.equal(system.calls, 0);
    reporter.connect(await opening.open());
    for (const leave of listeners.pagehide) leave();
    assert.ok(system.calls > 0);
  });
});

describe('a lesson in two tabs', () => {
  it('is held by the tab that opened it last', async () => {
    const file = { digest: 'd' };
    doors.holdLog(file, '');
    assert.ok(doors.holdsLog(file, ''));
    localStorage.setItem('kith.lesson.d.tab', 'another');
    assert.ok(!doors.holdsLog(file, ''));
    assert.ok(doors.holdsLog(file, 'somebody else'));
    doors.holdLog(file, '');
    assert.ok(doors.holdsLog(file, ''));
  });
});
