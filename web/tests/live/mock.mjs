// A server that plays a session on item delivery, with the failures that tests ask for. It is strict: whatever a page
// sends against the protocol is in `violations`.
import { readFileSync, existsSync } from 'node:fs';
import { createServer } from 'node:http';
import { extname, join, normalize } from 'node:path';
import { requireFrom } from '../browser.mjs';

const kTypes = { '.html': 'text/html', '.js': 'text/javascript', '.css': 'text/css', '.json': 'application/json' };
// As kith serve sends them.
const kHeaders = {
  'Content-Security-Policy':
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; connect-src 'self'; " +
    "base-uri 'none'; form-action 'none'; frame-ancestors 'none'; require-trusted-types-for 'script'",
  'X-Content-Type-Options': 'nosniff',
  'Referrer-Policy': 'no-referrer',
  'Cross-Origin-Opener-Policy': 'same-origin',
  'Cross-Origin-Resource-Policy': 'same-origin',
  'Cache-Control': 'no-store',
};
const kBodies = {
  consent: ['accept', 'version'],
  checked: [],
  name: ['name'],
  screen: ['actions', 'ms', 'test'],
  watched: ['demo'],
  draft: ['actions', 'test'],
  answer: ['actions', 'keys', 'ms', 'test'],
  discuss: ['choice', 'ms', 'test'],
  continue: [],
  questions: ['answers'],
  leave: [],
};

export class Mock {
  constructor({ app, modules, room, texts = null, code = 'ROBOT' }) {
    Object.assign(this, { app, room, texts, code });
    this.tokens = new Map(room.seats.map(({ number }) => [`seat-${number}-token-of-the-mock`, number]));
    this.joined = 0;
    this.sockets = new Map(); // token -> socket
    this.done = new Map(); // ids that have been answered -> frame
    this.views = new Map(); // token -> view that is shown whatever the room says
    this.violations = [];
    this.received = []; // {seat, t, id, body}, also what was sent again
    this.isDown = false;
    this.holdsAcks = false;
    this.numHellos = 0;
    const { WebSocketServer } = requireFrom(modules)('ws');
    this.ws = new WebSocketServer({ noServer: true, maxPayload: 16384 });
    this.server = createServer((request, response) => this.http(request, response));
    this.server.on('upgrade', (request, socket, head) => {
      if (this.isDown || request.url !== '/ws') return socket.destroy();
      return this.ws.handleUpgrade(request, socket, head, (web) => this.open(web));
    });
  }

  async listen() {
    await new Promise((resolve) => this.server.listen(0, '127.0.0.1', resolve));
    this.address = `http://127.0.0.1:${this.server.address().port}`;
    return this;
  }

  async close() {
    for (const client of this.ws.clients) client.terminate();
    this.server.closeAllConnections();
    await new Promise((resolve) => this.server.close(resolve));
  }

  token(seat) {
    return [...this.tokens].find(([, number]) => number === seat)[0];
  }

  link(seat) {
    return `${this.address}/j#t=${this.token(seat)}`;
  }

  // ---- failures
  drop() {
    for (const client of this.ws.clients) client.terminate();
  }

  down() {
    this.isDown = true;
    this.sendAll({ t: 'bye', reason: 'server-stops' });
    this.drop();
  }

  up() {
    this.isDown = false;
  }

  bye(seat, reason) {
    const socket = this.sockets.get(this.token(seat));
    socket?.send(JSON.stringify({ t: 'bye', reason }));
    socket?.close(1000);
  }

  show(seat, view) {
    this.views.set(this.token(seat), view);
    this.update();
  }

  // Sends everybody what they see now.
  update() {
    for (const token of this.sockets.keys()) this.look(token);
  }

  releaseAcks() {
    this.holdsAcks = false;
    for (const send of this.held ?? []) send();
    this.held = [];
  }

  // ---- http
  http(request, response) {
    if (this.isDown) return request.socket.destroy();
    const { pathname } = new URL(request.url, this.address);
    const reply = (status, type, body) => {
      response.writeHead(status, { ...kHeaders, 'Content-Type': `${type}; charset=utf-8` });
      response.end(body);
    };
    const json = (status, value) => reply(status, 'application/json', JSON.stringify(value));
    if (pathname === '/' || pathname === '/j') return reply(200, 'text/html', readFileSync(join(this.app, 'index.html')));
    if (pathname === '/f') return reply(200, 'text/html', '<!doctype html><html lang="en"><title>f</title><link rel="icon" href="data:,"><h1>Facilitator</h1></html>');
    if (pathname === '/api/texts') return this.texts ? json(200, this.texts) : json(404, { reason: 'no-texts' });
    if (pathname === '/api/join' && request.method === 'POST') return this.join(request, json);
    if (pathname.startsWith('/api/world/')) {
      const isKnown = this.tokens.has((request.headers.authorization ?? '').replace(/^Bearer /, ''));
      const world = this.room.worlds.get(decodeURIComponent(pathname.slice('/api/world/'.length)));
      if (!isKnown) return json(401, { reason: 'bad-token' });
      return world ? json(200, world.table) : json(404, { reason: 'no-world' });
    }
    const file = normalize(pathname).replace(/^\/assets\/live\//, '');
    const path = join(this.app, file);
    const isAsset = pathname.startsWith('/assets/live/') && !file.includes('..') && existsSync(path);
    return isAsset ? reply(200, kTypes[extname(path)] ?? 'text/plain', readFileSync(path)) : json(404, {});
  }

  join(request, json) {
    let text = '';
    request.on('data', (chunk) => (text += chunk));
    request.on('end', () => {
      if (request.headers['content-type'] !== 'application/json') this.violations.push('join without a content type');
      const { code, query } = JSON.parse(text);
      if (code === 'BUSY') return json(429, { reason: 'too-many', text: 'wait' });
      if (code !== this.code) return json(404, { reason: 'no-room', text: 'no such code' });
      if (this.joined >= this.tokens.size) {
        const end = { reason: 'full', text: '', code: 'MOCK-FULL' };
        return json(200, { full: { ...this.room.view(1), stage: 'full', end } });
      }
      this.joined += 1;
      this.room.seats[this.joined - 1].query = query;
      return json(200, { token: this.token(this.joined) });
    });
  }

  // ---- sockets
  open(socket) {
    if (this.isSilent) return;
    let token = null;
    socket.on('message', (data) => {
      const frame = JSON.parse(String(data));
      if (frame.t === 'hello') token = this.hello(socket, frame);
      else if (token === null) this.violations.push(`'${frame.t}' before hello`);
      else if (frame.t === 'beat') socket.send(JSON.stringify({ t: 'beat' }));
      else this.receive(socket, token, frame);
    });
    socket.on('close', () => {
      if (token === null || this.sockets.get(token) !== socket) return;
      this.sockets.delete(token);
      this.room.seats[this.tokens.get(token) - 1].present = false;
      this.update();
    });
  }

  hello(socket, { v, token, tab }) {
    this.numHellos += 1;
    if (v !== 1 || !/^[0-9a-f-]{36}$/.test(tab)) this.violations.push('a wrong hello');
    if (token === 'facilitator-token') socket.send(JSON.stringify({ t: 'welcome', role: 'facilitator', server: 'mock' }));
    if (!this.tokens.has(token)) {
      socket.send(JSON.stringify({ t: 'bye', reason: 'bad-token' }));
      socket.close(1008);
      return null;
    }
    const before = this.sockets.get(token);
    this.sockets.set(token, socket);
    before?.send(JSON.stringify({ t: 'bye', reason: 'opened-elsewhere' }));
    before?.close(1000);
    this.room.seats[this.tokens.get(token) - 1].present = true;
    socket.send(JSON.stringify({ t: 'welcome', role: 'participant', server: 'mock' }));
    this.update();
    return token;
  }

  receive(socket, token, { t, id, body }) {
    const seat = this.tokens.get(token);
    this.received.push({ seat, t, id, body });
    const isEndless = body?.for_ever === true && ['answer', 'screen'].includes(t);
    const keys = Object.keys(body ?? {}).filter((key) => !(isEndless && key === 'for_ever')).sort().join();
    if (!/^[0-9a-f-]{36}$/.test(id) || keys !== (kBodies[t] ?? ['?']).join()) this.violations.push(`a wrong ${t}: ${keys}`);
    if (!this.done.has(id)) {
      const refusal = this.views.has(token) ? null : this.room.command(seat, t, body);
      this.done.set(id, refusal ? { t: 'nak', id, reason: 'refused', text: refusal } : { t: 'ack', id });
    }
    const settle = () => {
      if (socket.readyState === 1) socket.send(JSON.stringify(this.done.get(id)));
      this.update();
    };
    if (this.holdsAcks) (this.held ??= []).push(settle);
    else settle();
  }

  look(token) {
    const view = this.views.get(token) ?? this.room.view(this.tokens.get(token));
    this.sockets.get(token)?.send(JSON.stringify({ t: 'view', view }));
  }

  sendAll(frame) {
    for (const socket of this.sockets.values()) socket.send(JSON.stringify(frame));
  }
}
