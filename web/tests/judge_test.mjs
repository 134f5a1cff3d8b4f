// The lesson page's judge against kith's: on the robot's own path from every start of all built-in domains, and on
// random paths; and on first moves.
//
//   node tests/judge_test.mjs --paths PROGRAM [--modules DIR]
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { dirname, join, resolve } from 'node:path';
import { createInterface } from 'node:readline';
import { it } from 'node:test';
import { fileURLToPath } from 'node:url';
import { parseArgs } from 'node:util';
import { requireFrom } from './browser.mjs';

const here = dirname(fileURLToPath(import.meta.url));
const { values } = parseArgs({ options: { paths: { type: 'string' }, modules: { type: 'string', default: join(here, '..') } } });

it('a page judges answers as kith does', async () => {
  const { build } = requireFrom(values.modules)('esbuild');
  const { outputFiles } = await build({
    entryPoints: [join(here, '../src/lesson/judge.ts')],
    absWorkingDir: resolve(values.modules),
    bundle: true,
    write: false,
    format: 'esm',
    platform: 'neutral',
  });
  const { judgeMove, judgePath } = await import(`data:text/javascript;base64,${Buffer.from(outputFiles[0].text).toString('base64')}`);
  const program = spawn(resolve(values.paths), { stdio: ['ignore', 'pipe', 'inherit'] });
  const seen = new Map();
  const firstMoves = { right: 0, wrong: 0 };
  for await (const line of createInterface({ input: program.stdout })) {
    const { domain, judge, table, paths, moves } = JSON.parse(line);
    const sum = seen.get(domain) ?? { right: 0, wrong: 0, short: 0 };
    for (const { start, robot, actions, repeats_from, finished, right, counts } of paths) {
      const found = judgePath(judge, table, robot, start, actions, repeats_from);
      const what = `${domain}: from state ${start} by ${actions}`;
      assert.equal(found.isFinished, finished, what);
      assert.equal(found.isRight, right, what);
      if (judge.exact) assert.deepEqual(found.counts, counts, what);
      sum[right ? 'right' : finished ? 'wrong' : 'short'] += 1;
    }
    for (const { start, robot, action, right } of moves) {
      assert.equal(judgeMove(judge, table, robot, start, action).isRight, right, `${domain}: action ${action} in state ${start}`);
      firstMoves[right ? 'right' : 'wrong'] += 1;
    }
    seen.set(domain, sum);
  }
  assert.ok(firstMoves.right > 30 && firstMoves.wrong > 30, JSON.stringify(firstMoves));
  assert.ok(seen.size >= 9, `domains: ${[...seen.keys()]}`);
  const all = [...seen.values()].reduce((n, { right, wrong, short }) => n + right + wrong + short, 0);
  assert.ok(all >= 20_000, `${all} paths`);
  for (const [domain, { right, wrong }] of seen) assert.ok(right > 10 && wrong > 10, `${domain}: ${right} right, ${wrong} wrong`);
});
