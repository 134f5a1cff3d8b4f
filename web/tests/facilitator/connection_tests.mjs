// The connection to the server without a browser: sockets and the clock are simulated.
import assert from 'node:assert/strict';
import { it } from 'node:test';
import { fileURLToPath } from 'node:url';
import { requireFrom } from '../browser.mjs';

const kSecond = 1000;

class Clock {
  now = 1;
  timers = new Map();
  next = 1;

  add(call, ms, every) {
    this.timers.set(this.next, { call, at: this.now + ms, every });
    return this.next++;
  }

  // `slow`: as in a hidden tab, where what is due runs once at the end.
  run(ms, slow = false) {
    const end = this.now + ms;
    for (;;) {
      const due = [...this.timers].filter(([, { at }]) => at <= end).sort(([, a], [, b]) => a.at - b.at)[0];
      if (!due) break;
      const [id, timer] = due;
      this.now = slow ? end : Math.max(this.now, timer.at);
      if (timer.every) timer.at = (slow ? end : timer.at) + timer.every;
      else this.timers.delete(id);
      timer.call();
    }
    this.now = end;
  }
}

// The connection, with `answers` called for every frame that it sends; it may answer through the socket.
function connect(modules, answers) {
  const { outputFiles } = requireFrom(modules)('esbuild').buildSync({
    entryPoints: [fileURLToPath(new URL('../../src/facilitator/connection.ts', import.meta.url))],
    bundle: true,
    write: false,
    format: 'iife',
    globalName: 'lib',
  });
  const clock = new Clock();
  const seen = { phases: [], sent: [], sockets: [], clock, answers };
  class Socket {
    constructor() {
      seen.sockets.push(this);
    }

    open() {
      this.onopen();
    }

    send(text) {
      const frame = JSON.parse(text);
      seen.sent.push(frame);
      seen.answers(frame, this);
    }

    say(frame) {
      this.onmessage({ data: JSON.stringify(frame) });
    }

    close() {}

    cut() {
      this.onclose();
    }
  }
  const own = {
    window: { addEventListener: () => undefined },
    document: { addEventListener: () => undefined },
    location: { protocol: 'http:', host: 'server' },
    performance: { now: () => clock.now },
    WebSocket: Socket,
    setInterval: (call, ms) => clock.add(call, ms, ms),
    setTimeout: (call, ms) => clock.add(call, ms, 0),
    clearTimeout: (id) => clock.timers.delete(id),
  };
  const lib = new Function(...Object.keys(own), `${outputFiles[0].text}; return lib;`)(...Object.values(own));
  seen.connection = new lib.Connection('token', {
    socket: ({ phase }) => seen.phases.push(phase),
    view: () => undefined,
    welcome: () => undefined,
  });
  return seen;
}

const polite = (frame, socket) => {
  if (frame.t === 'hello') socket.say({ t: 'welcome', role: 'facilitator', server: 'kith' });
  else if (frame.t === 'beat') socket.say({ t: 'beat' });
  else socket.say({ t: 'ack', id: frame.id });
};
const silent = () => undefined;
const last = (all) => all[all.length - 1];

export function connectionTests(modules) {
  it('stays while heartbeats are answered, also with the slow timers of a hidden tab', () => {
    const seen = connect(modules, polite);
    seen.sockets[0].open();
    seen.clock.run(60 * kSecond);
    for (let i = 0; i < 5; ++i) seen.clock.run(60 * kSecond, true);
    assert.deepEqual(seen.phases, ['open']);
    assert.equal(seen.sockets.length, 1);
  });

  it('notices a connection that is dead without being closed, and makes a new one', () => {
    const seen = connect(modules, polite);
    seen.sockets[0].open();
    seen.clock.run(20 * kSecond);
    seen.answers = silent;
    seen.clock.run(26 * kSecond);
    assert.equal(last(seen.phases), 'lost');
    assert.ok(seen.sockets.length > 1);
    seen.answers = polite;
    last(seen.sockets).open();
    assert.equal(last(seen.phases), 'open');
    assert.equal(seen.sockets[0].onmessage, null, 'a former connection is still heard');
  });

  it('gives up an attempt that gets no answer, with growing pauses between attempts', () => {
    const seen = connect(modules, silent);
    for (let i = 0; i < 20; ++i) {
      last(seen.sockets).cut();
      seen.clock.run(8 * kSecond);
    }
    assert.equal(seen.sockets.length, 21);
    const never = connect(modules, silent);
    never.clock.run(60 * kSecond);
    assert.ok(never.sockets.length > 1, 'an attempt that hangs is not given up');
    assert.ok(never.sockets.length < 8);
  });

  it('sends a command until it is acknowledged, always with the same id', async () => {
    const seen = connect(modules, polite);
    seen.sockets[0].open();
    seen.answers = silent;
    const done = seen.connection.send('pause', { room: 'r1', reason: 'test' });
    seen.sockets[0].cut();
    seen.clock.run(8 * kSecond);
    seen.answers = polite;
    last(seen.sockets).open();
    await done;
    const sent = seen.sent.filter(({ t }) => t === 'pause');
    assert.equal(sent.length, 2);
    assert.deepEqual(sent[0], sent[1]);
    last(seen.sockets).cut();
    seen.clock.run(8 * kSecond);
    last(seen.sockets).open();
    assert.equal(seen.sent.filter(({ t }) => t === 'pause').length, 2, 'an acknowledged command is sent again');
  });

  it('passes refusals on, and stops for good when the link is not valid', async () => {
    const seen = connect(modules, (frame, socket) => {
      if (frame.t === 'extend') socket.say({ t: 'nak', id: frame.id, reason: 'not-now', text: 'No time limit applies.' });
      else if (frame.t !== 'end') polite(frame, socket);
    });
    seen.sockets[0].open();
    await assert.rejects(seen.connection.send('extend', {}), /No time limit applies/);
    const waiting = assert.rejects(seen.connection.send('end', {}), /no longer gives access/);
    seen.sockets[0].say({ t: 'bye', reason: 'removed' });
    await waiting;
    seen.clock.run(60 * kSecond);
    assert.equal(last(seen.phases), 'closed');
    assert.equal(seen.sockets.length, 1);
  });
}
