// A real `kith serve`, people who talk to it without a browser, and the wire between it and a page.
import { spawn } from 'node:child_process';
import { randomUUID } from 'node:crypto';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { setTimeout } from 'node:timers/promises';
import { requireFrom } from './browser.mjs';
import { bestPath, priced } from './live/delivery.mjs';

export const kPatience = 120_000; // milliseconds: the machine may be busy; nothing here is about time

export async function until(isSo) {
  const end = Date.now() + kPatience;
  while (!(await isSo())) {
    if (Date.now() > end) throw new Error(`waited in vain until ${isSo}`);
    await setTimeout(20);
  }
}

// Serves a study, or the demonstration without one, on a free port unless one is given: {port, join, ..., stop}.
export async function startKith(program, folder, { port = 0, keys = [], study } = {}) {
  const words = ['serve', ...(study ? [study] : ['--demo', '--no-browser']), '--json', '-q', '--port', String(port), '-o', folder];
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
  if (!document.join) throw new Error(text);
  return { ...document, origin: new URL(document.join).origin, stop };
}

export const kQuestions = `
questions = [
  { id = "clear", kind = "likert", text = "How clear was the lesson?", low = "not at all", high = "very", required = true },
  { id = "pace", kind = "likert", text = "How was the pace?", options = ["too slow", "right", "too fast"] },
  { id = "robots", kind = "choice", text = "Have you worked with robots before?", options = ["never", "sometimes", "often"], required = true },
  { id = "free", kind = "text", text = "What was hard to understand?" },
]`;

// Two short lessons for a group; `group` are lines of that section.
const studyOf = (size, group) => `
schema = "kith.study/1"
id = "pages"
title = "Delivery"
domain = "item-delivery"
seed = 1
[design]
strategies = ["joint"]
compositions = ["N"]
[learner.N]
label = "novice"
ability = { mean = 0.7, sd = 0.03 }
confirm_gain = { half_normal = 0.03 }
correct_gain = { half_normal = 0.06 }
[learner.P]
label = "proficient"
ability = { mean = 0.9, sd = 0.03 }
confirm_gain = { half_normal = 0.03 }
correct_gain = { half_normal = 0.06 }
[stop]
max_periods = 2
[group]
size = ${size}
${group}
`;

// A server of a study; `files` are put beside it.
export async function serve(program, { size = 1, group = '', keys = [], files = {} }) {
  const folder = mkdtempSync(join(tmpdir(), 'kith-pages-'));
  for (const [name, text] of Object.entries({ 'study.toml': studyOf(size, group), ...files })) writeFileSync(join(folder, name), text);
  const session = join(folder, 'session');
  const start = (port) => startKith(program, session, { port, keys, study: join(folder, 'study.toml') });
  const running = { server: await start(0), session, folder };
  running.restart = async () => {
    const { port, facilitator, observer } = running.server; // a second start cannot say them
    running.server = { ...(await start(port)), facilitator, observer };
  };
  running.close = async () => {
    await running.server.stop('SIGTERM');
    rmSync(folder, { recursive: true, force: true });
  };
  return running;
}

export async function withServer(program, study, body) {
  const running = await serve(program, study);
  try {
    return await body(running);
  } finally {
    await running.close();
  }
}

// Somebody at the server without a browser. `choose(world, start)` gives the actions of an answer; without, the best.
export class Client {
  constructor(modules, { origin }, token) {
    Object.assign(this, { origin, token, view: null, views: [], waiting: new Map() });
    const { WebSocket } = requireFrom(modules)('ws');
    this.socket = new WebSocket(`${origin.replace('http', 'ws')}/ws`);
    this.socket.on('open', () => this.say({ t: 'hello', v: 1, token, tab: randomUUID() }));
    this.beating = setInterval(() => this.socket.readyState === 1 && this.say({ t: 'beat' }), 4000);
    this.socket.on('message', (data) => this.receive(JSON.parse(String(data))));
  }

  static async join(modules, server, query = {}) {
    const headers = { 'Content-Type': 'application/json' };
    const reply = await fetch(`${server.origin}/api/join`, { method: 'POST', headers, body: JSON.stringify({ code: server.code, query }) });
    const client = new Client(modules, server, (await reply.json()).token);
    await until(() => client.view !== null);
    return client;
  }

  // Of a link of a facilitator or observer.
  static async open(modules, link) {
    const { origin, hash } = new URL(link);
    const client = new Client(modules, { origin }, hash.replace('#t=', ''));
    await until(() => client.view !== null);
    return client;
  }

  say(frame) {
    this.socket.send(JSON.stringify(frame));
  }

  receive(frame) {
    if (frame.t === 'view') {
      this.view = { rooms: this.view?.rooms, ...frame.view };
      this.views.push(frame.view);
    }
    const settle = this.waiting.get(frame.id);
    if (settle) settle(frame);
  }

  async ask(type, body) {
    const id = randomUUID();
    const reply = new Promise((resolve) => this.waiting.set(id, resolve));
    this.say({ t: type, id, body });
    const { t, text } = await reply;
    if (t !== 'ack') throw new Error(`${type} was refused: ${text}`);
  }

  async world(key) {
    const reply = await fetch(`${this.origin}/api/world/${key}`, { headers: { Authorization: `Bearer ${this.token}` } });
    return reply.json();
  }

  // Does what the page of this person would ask for next; false if there is nothing.
  async step(choose = bestActions) {
    const { stage, consent, watch, questions, predict } = this.view;
    const answer = async () => {
      const world = priced(await this.world(predict.world));
      return { test: predict.index, actions: choose(world, predict.start), ms: 1 };
    };
    const acts = {
      consent: () => ['consent', { accept: true, version: consent.version }],
      check: () => ['checked', {}],
      screening: async () => ['screen', await answer()],
      watch: () => ['watched', { demo: watch.index }],
      predict: async () => ['answer', await answer()],
      feedback: () => ['continue', {}],
      questions: () => ['questions', { answers: Object.fromEntries(questions.items.map((one) => [one.id, answerTo(one)])) }],
    };
    if (!Object.hasOwn(acts, stage)) return false;
    const before = this.views.length;
    await this.ask(...(await acts[stage]()));
    await until(() => this.views.length > before);
    return true;
  }

  close() {
    clearInterval(this.beating);
    this.socket.close();
  }
}

// Everybody does what their page asks for until all are done, or `isOver`. `choose` gives how a person answers.
export async function play(people, choose = () => undefined, isOver = () => people.every(({ view }) => view.stage === 'debrief')) {
  await until(async () => {
    for (const [i, person] of people.entries()) if (!isOver()) await person.step(choose(i));
    return isOver();
  });
}

const bestActions = (world, start) => bestPath(world, start).actions;
const answerTo = ({ kind, options }) => (kind === 'likert' ? 3 : kind === 'choice' ? options[0] : 'nothing');

// What lies between a page and its server: it can hold, change and add frames, and break. `sent` is what the page said,
// `acknowledged` the ids of what the server has taken.
export class Wire {
  constructor() {
    Object.assign(this, { sent: [], numOpened: 0, holdsAcks: false, isDown: false, isSilent: false });
    Object.assign(this, { open: new Set(), acknowledged: new Set(), last: null, bend: (view) => view });
  }

  async between(context) {
    await context.routeWebSocket('**/ws', (page) => {
      if (this.isSilent) return;
      if (this.isDown) return void page.close({ code: 1001 });
      this.numOpened += 1;
      this.open.add(page);
      const server = page.connectToServer();
      page.onMessage((text) => {
        const frame = JSON.parse(text);
        if (frame.t !== 'hello' && frame.t !== 'beat') this.sent.push(frame);
        const answer = frame.id && this.answers?.(frame);
        if (answer) page.send(JSON.stringify({ id: frame.id, ...answer }));
        else server.send(text);
      });
      server.onMessage((text) => {
        const frame = JSON.parse(text);
        if (frame.t === 'ack') this.acknowledged.add(frame.id);
        if (this.holdsAcks && frame.t === 'ack') return;
        if (frame.t === 'view') this.last = { rooms: this.last?.rooms, ...frame.view };
        page.send(frame.t === 'view' ? JSON.stringify({ ...frame, view: this.bend(frame.view) }) : text);
      });
      const end = () => this.open.delete(page);
      page.onClose((code, reason) => (end(), server.close({ code, reason })));
      server.onClose((code, reason) => (end(), page.close({ code, reason })));
    });
    return this;
  }

  of(type) {
    return this.sent.filter(({ t }) => t === type);
  }

  say(frame) {
    for (const page of this.open) page.send(JSON.stringify(frame));
  }

  // Shows a view in place of those of the server, from now on.
  show(view) {
    this.bend = () => view;
    this.say({ t: 'view', view });
  }

  // Shows what the server has shown last, as it is bent now.
  again() {
    if (this.last) this.say({ t: 'view', view: this.bend(this.last) });
  }

  // As a network that fails.
  cut() {
    for (const page of this.open) page.close({ code: 1001 });
    this.open.clear();
  }
}
