// A server with a room, and people in browsers: what journeys through the pages start from.
import { spawn } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { launch, requireFrom } from '../browser.mjs';
import { Mock } from './mock.mjs';
import { openPerson } from './person.mjs';
import { Room } from './room.mjs';

const here = dirname(fileURLToPath(import.meta.url));

export const lesson = JSON.parse(readFileSync(join(here, '../../sample/lesson.json'), 'utf8'));

// What tests are given: the folder of the page, packages, browser, and where screenshots go.
export class Setting {
  constructor({ app, modules, chromium, screenshots, kith }) {
    Object.assign(this, { app, modules, chromium, screenshots, kith });
    this.axe = readFileSync(requireFrom(modules).resolve('axe-core/axe.min.js'), 'utf8');
  }

  async start() {
    this.browser = await launch(this.modules, this.chromium);
  }

  async stop() {
    await this.browser?.close();
  }

  mock(options = {}, room = new Room(lesson, options)) {
    return new Mock({ app: this.app, modules: this.modules, room, texts: options.language ?? null }).listen();
  }
}

// Runs a body with a room of the mock server and one page per seat; nothing may go wrong on any of them.
export async function withGroup(setting, options, body) {
  const mock = await setting.mock({ size: 1, ...options });
  const people = [];
  try {
    for (const { number } of mock.room.seats.slice(0, options.open ?? mock.room.seats.length)) {
      people.push(await openPerson(setting.browser, mock.link(number), options.look ?? {}));
      await people[people.length - 1].open();
    }
    await body({ mock, room: mock.room, people, person: people[0], page: people[0]?.page });
    for (const person of people) complain(person.trouble, 'requests, console messages or uncaught errors');
    complain(mock.violations, 'against the protocol');
  } finally {
    for (const person of people) await person.close();
    await mock.close();
  }
}

function complain(list, what) {
  if (list.length > 0) throw new Error(`${what}: ${list.join('; ')}`);
}

// The demonstration of `kith serve`, on a free port unless one is given, with keys of its study set otherwise:
// {port, join, seats, ..., stop}.
export async function startKith(program, folder, port = 0, keys = []) {
  const words = ['serve', '--demo', '--no-browser', '--json', '-q', '--port', String(port), '-o', folder];
  const server = spawn(program, [...words, ...keys.flatMap((key) => ['--set', key])], { stdio: ['ignore', 'pipe', 'inherit'] });
  let text = '';
  const document = await new Promise((resolve, reject) => {
    server.on('exit', (status) => reject(new Error(`kith serve ended with status ${status}`)));
    server.stdout.on('data', (chunk) => {
      text += chunk;
      try {
        resolve(JSON.parse(text));
      } catch {
        // not all of it yet
      }
    });
  });
  const stop = (signal) =>
    new Promise((resolve) => {
      server.removeAllListeners('exit');
      server.on('exit', resolve);
      server.kill(signal);
    });
  return { ...document, stop };
}

// From the first page to the first board.
export async function begin(people) {
  for (const person of people) {
    await person.consent();
    await person.check();
  }
}
