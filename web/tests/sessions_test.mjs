// Lessons in a page and in the program are the same: people of all kinds, and simulated crews, are taught by the engine
// of lesson files; then kith teaches each log again, and compares every lesson and the seal of all events.
//
//   node tests/sessions_test.mjs --kith PROGRAM --engine DIR [--count 200]
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { copyFileSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { tmpdir } from 'node:os';
import { dirname, join } from 'node:path';
import { after, describe, it } from 'node:test';
import { fileURLToPath } from 'node:url';
import { parseArgs } from 'node:util';

const here = dirname(fileURLToPath(import.meta.url));
const { values } = parseArgs({ options: { kith: { type: 'string' }, engine: { type: 'string' }, count: { type: 'string', default: '20' } } });
if (!values.kith || !values.engine) {
  console.error('usage: node tests/sessions_test.mjs --kith PROGRAM --engine DIR [--count N]');
  process.exit(2);
}
const kDomains = ['item-delivery', 'colored-tiles', 'two-goals', 'cookie-crumb', join(here, '../../domains/gallery/frozen_lake.toml')];
const kStrategies = ['plan', 'common', 'joint', 'individual-low'];
const folder = mkdtempSync(join(tmpdir(), 'kith-sessions-'));

async function startEngine() {
  const script = join(folder, 'engine.cjs');
  copyFileSync(join(values.engine, 'kith_engine.js'), script);
  const module = await createRequire(import.meta.url)(script)({ wasmBinary: readFileSync(join(values.engine, 'kith_engine.wasm')) });
  return (request) => {
    const text = JSON.stringify(request);
    const size = module.lengthBytesUTF8(text) + 1;
    const address = module._malloc(size);
    module.stringToUTF8(text, address, size);
    const reply = JSON.parse(module.UTF8ToString(module._kith_engine(address)));
    module._free(address);
    assert.equal(reply.error, undefined);
    return reply;
  };
}

function documentOf(domain) {
  const page = join(folder, 'lesson.html');
  execFileSync(values.kith, ['lesson', domain, '--set', `design.strategies=${JSON.stringify(kStrategies)}`, '--set', 'design.compositions=["NNN"]', '-q', '-o', page]);
  return JSON.parse(/id="kith-document">(.*?)<\/script>/s.exec(readFileSync(page, 'utf8'))[1]);
}

// Numbers in [0, 1) that are the same everywhere.
function chance(seed) {
  let state = seed + 1;
  return () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state / 2 ** 32;
  };
}

// A walk through the table of moves, which may stop short.
function walk({ next, end, max_actions }, from, random) {
  const actions = [];
  for (let state = from; !end[state] && actions.length < max_actions && random() > 0.04; ) {
    const possible = next[state].flatMap((to, action) => (to >= 0 ? [action] : []));
    if (possible.length === 0) break;
    const action = possible[Math.floor(random() * possible.length)];
    actions.push(action);
    state = next[state][action];
  }
  return actions;
}

// Everything that one session has happen to it. `seed` says who is taught.
function session(ask, { inputs, setup: own, kith, digest }, seed) {
  const random = chance(seed);
  const isCrew = seed % 2 === 1;
  const composition = isCrew ? 'N'.repeat(1 + (seed % 3)) : 'N';
  const strategy = isCrew ? kStrategies[(seed >> 1) % kStrategies.length] : own.strategy;
  const setup = { ...own, id: `session ${seed}`, composition, strategy, simulated: [...composition].map(() => isCrew), replicate: 1 + seed };
  let now_us = 1_700_000_000_000_000 + seed;
  const [events, lessons] = [[], []];
  let view = null;
  const take = (reply) => {
    events.push(...reply.events);
    if (reply.lesson) lessons.push(reply.lesson);
    view = reply.view;
    return reply;
  };
  const send = (type, body) => {
    now_us += 2_000_000;
    const { refusal } = take(ask({ do: 'ask', type, body, now_us }));
    assert.equal(refusal, null);
  };
  let state = take(ask({ do: 'open', inputs, setup, events: [], now_us }));
  for (let turn = 0; turn < 400; ++turn) {
    if (state.teaching) {
      state = take(ask({ do: 'teach', now_us }));
      continue;
    }
    const { stage } = view ?? {};
    if (stage === 'consent') send('consent', { accept: true, version: view.consent.version });
    else if (stage === 'check') send('checked', {});
    else if (stage === 'watch') send('watched', { demo: view.watch.index });
    else if (stage === 'predict') {
      const { index, start, world } = view.predict;
      const actions = walk(ask({ do: 'world', key: world }), start, random);
      send('answer', { test: index, actions, keys: [], ms: 1000 });
    } else if (stage === 'feedback') send('continue', {});
    else break;
    state = ask({ do: 'tick', now_us });
    take(state);
  }
  const { seal } = ask({ do: 'seal' });
  return { schema: 'kith.lesson-log/1', kith, study: digest, setup, events, lessons, messages: [], seal, inputs };
}

describe('sessions in a page', () => {
  after(() => rmSync(folder, { recursive: true, force: true }));

  for (const domain of kDomains) {
    it(`are those of the program: ${domain.replace(/^.*\//, '')}`, async () => {
      const ask = await startEngine();
      const document = documentOf(domain);
      const place = join(folder, domain.replace(/\W/g, '-'));
      let [lessons, answers] = [0, 0];
      for (let i = 0; i < Number(values.count) / kDomains.length; ++i) {
        const log = session(ask, document, i);
        lessons += log.lessons.length;
        answers += log.events.filter(({ type }) => type === 'answered').length;
        const file = join(folder, 'log.json');
        writeFileSync(file, JSON.stringify(log));
        assert.match(execFileSync(values.kith, ['session', 'import', file, '-o', place], { encoding: 'utf8', stdio: 'pipe' }), /replayed \d+ events/);
      }
      console.log(`${domain}: ${lessons} lessons and ${answers} answers of ${values.count / kDomains.length} sessions`);
      assert.ok(lessons > 0);
    });
  }
});
