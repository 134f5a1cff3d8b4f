// The demonstration of `kith serve`, taken part in by three people.
import assert from 'node:assert/strict';
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { describe, it } from 'node:test';
import { startKith, until } from '../kith.mjs';
import { openPerson } from './person.mjs';

// What the screens ask for.
const kActs = {
  consent: (person) => person.consent(),
  check: (person) => person.check(),
  watch: (person) => person.watch(),
  predict: async (person, isRight) => {
    const { index } = person.view.predict;
    await person.page.waitForFunction((i) => document.querySelector('.kicker')?.textContent.startsWith(`Task ${i} `), index + 1);
    await person.drive(isRight ? await person.best() : (await person.best()).slice(0, 2));
    await person.button('Submit').click();
    if (!isRight) await person.button('Submit anyway').click();
    await until(() => person.view.stage !== 'predict' || person.view.predict.index !== index);
  },
  feedback: (person) => person.feedback(),
  questions: async (person) => {
    await person.page.getByRole('radio').first().check();
    await person.button('Submit').click();
  },
};

const canAct = ({ view }) => view.stage in kActs;

// One screen of one person. `isRight` says whether a task is answered as the robot would.
async function act(person, isRight) {
  const { stage } = person.view;
  await person.page.waitForSelector(`main.stage-${stage}`);
  await kActs[stage](person, isRight);
  await until(() => person.view.stage !== stage || stage === 'predict' || stage === 'watch');
}

// Everybody does what their screen asks for until all are at one of the stages. Gives the stages in between.
export async function reach(people, stages, isRight = () => true) {
  const seen = new Set();
  const isThere = ({ view }) => stages.includes(view.stage);
  while (!people.every(isThere)) {
    await until(() => people.every(isThere) || people.some((person) => !isThere(person) && canAct(person)));
    for (const person of people.filter((one) => !isThere(one) && canAct(one))) {
      seen.add(person.view.stage);
      await act(person, isRight(person));
    }
  }
  return seen;
}

// Three people who join the demonstration with its link; `keys` of its study, and how each person's browser looks.
export async function withDemonstration(setting, body, { keys = [], looks = [] } = {}) {
  const folder = mkdtempSync(join(tmpdir(), 'kith-live-'));
  const session = join(folder, 'session');
  const start = (port) => startKith(setting.kith, session, { port, keys });
  const running = { server: await start(0), start, folder, session };
  const people = [];
  try {
    assert.equal(running.server.seats.length, 3);
    for (let i = 0; i < 3; i += 1) {
      const person = await openPerson(setting.browser, running.server.join, { isDirect: true, ...looks[i] });
      people.push(person);
      await person.join();
    }
    await body(people, running);
    for (const person of people) assert.deepEqual(person.trouble, []);
  } finally {
    for (const person of people) await person.close();
    await running.server.stop('SIGTERM');
    rmSync(folder, { recursive: true, force: true });
  }
}

export function kithTests(setting) {
  describe('kith serve', () => {
    it('is killed in mid-period, and nobody loses an answer or a path', async () => {
      await withDemonstration(setting, async (people, running) => {
        for (const person of people) person.expectLosses();
        await reach(people, ['predict']);
        const [first, second] = people;
        const { index, of } = first.view.predict;
        await second.drive((await second.best()).slice(0, 2));
        await first.drive(await first.best());
        await running.server.stop('SIGKILL');
        await first.button('Submit').click(); // nobody is there to hear it
        await first.counts('being saved');
        running.server = await running.start(running.server.port);
        await until(() => first.view.stage !== 'predict' || first.view.predict.index > index);
        assert.equal(first.view.stage, of === 1 ? 'wait' : 'predict');
        await second.page.reload();
        await second.counts('2 steps');
      });
    });
  });
}
