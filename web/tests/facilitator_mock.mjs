// Stands in for `kith serve` towards the facilitator page: serves the built folder under the same policy,
// speaks the same protocol, and does in a simple way what commands ask for.
//
//   node tests/facilitator_mock.mjs FOLDER [--port N]       to look at the page by hand
import { readFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { parseArgs } from 'node:util';
import { requireFrom } from './browser.mjs';
import { forObserver, makeView, roomDetail } from './facilitator/views.mjs';
import { makeRandom } from '../sample/random.mjs';

export const kTokens = { facilitator: 'facilitator-0123456789', observer: 'observer-0123456789abcd' };

const kHeaders = {
  'Content-Security-Policy':
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; connect-src 'self'; " +
    "base-uri 'none'; form-action 'none'; frame-ancestors 'none'; require-trusted-types-for 'script'",
  'X-Content-Type-Options': 'nosniff',
  'Referrer-Policy': 'no-referrer',
  'Cross-Origin-Opener-Policy': 'same-origin',
  'Cross-Origin-Resource-Policy': 'same-origin',
};
const kFiles = {
  '/f': ['index.html', 'text/html; charset=utf-8'],
  '/assets/facilitator/app.js': ['app.js', 'text/javascript; charset=utf-8'],
  '/assets/facilitator/app.css': ['app.css', 'text/css; charset=utf-8'],
};

function qr(text) {
  const cells = [...Array(441).keys()].filter((i) => (i * 2654435761 + text.length * i * i) % 7 < 3);
  const path = cells.map((i) => `M${i % 21} ${Math.floor(i / 21)}h1v1h-1z`).join('');
  return `<svg xmlns="http://www.w3.org/2000/svg" viewBox="-2 -2 25 25"><path fill="#fff" d="M-2 -2h25v25h-25z"/><path d="${path}"/></svg>`;
}

export class MockServer {
  commands = []; // all that was received: {t, id, body}
  refusals = {}; // command -> {reason, text}
  holdAcks = false;
  change = (detail) => detail; // of the room that is shown
  requests = [];
  sockets = new Set();

  constructor(folder, modules, options = {}) {
    this.folder = folder;
    this.wsPackage = requireFrom(modules)('ws');
    this.options = options;
    this.view = makeView(options);
  }

  async start(port = 0) {
    this.http = createServer((request, reply) => this.answer(request, reply));
    this.ws = new this.wsPackage.WebSocketServer({ server: this.http, path: '/ws' });
    this.ws.on('connection', (socket) => this.connected(socket));
    await new Promise((done) => this.http.listen(port, '127.0.0.1', done));
    this.port = this.http.address().port;
    this.origin = `http://127.0.0.1:${this.port}`;
  }

  // As after a kill: sockets are cut, the port is closed.
  async stop() {
    for (const socket of this.ws.clients) socket.terminate();
    this.ws.close();
    this.http.closeAllConnections?.();
    await new Promise((done) => this.http.close(done));
  }

  answer(request, reply) {
    const url = new URL(request.url, this.origin);
    this.requests.push(`${request.method} ${url.pathname}`);
    const send = (status, type, body, more = {}) => {
      reply.writeHead(status, { ...kHeaders, 'Content-Type': type, ...more });
      reply.end(body);
    };
    const file = kFiles[url.pathname];
    if (file) return send(200, file[1], readFileSync(join(this.folder, file[0])));
    if (!url.pathname.startsWith('/api/')) return send(404, 'text/plain', 'not found');
    if (request.headers.authorization !== `Bearer ${kTokens.facilitator}`) return send(401, 'text/plain', 'unauthorised');
    if (url.pathname === '/api/qr') return send(200, 'image/svg+xml', qr(url.searchParams.get('text') ?? ''));
    if (url.pathname === '/api/integrity') return send(200, 'application/json', JSON.stringify(this.view.integrity));
    if (url.pathname === '/api/export') {
      return send(200, 'application/x-tar', Buffer.alloc(1024), { 'Content-Disposition': 'attachment; filename="delivery-live.tar"' });
    }
    return send(404, 'text/plain', 'not found');
  }

  connected(socket) {
    const say = (frame) => socket.send(JSON.stringify(frame));
    socket.on('message', (data) => {
      const frame = JSON.parse(String(data));
      if (frame.t === 'beat') return say({ t: 'beat' });
      if (frame.t === 'hello') {
        const role = Object.keys(kTokens).find((one) => kTokens[one] === frame.token);
        if (!role) {
          say({ t: 'bye', reason: 'bad-token' });
          return socket.close(4001);
        }
        socket.role = role;
        this.sockets.add(socket);
        say({ t: 'welcome', role, server: 'kith 0.1.0' });
        return this.show(socket);
      }
      this.commands.push(frame);
      const refusal = this.refusals[frame.t];
      if (refusal) return say({ t: 'nak', id: frame.id, ...refusal });
      if (this.holdAcks) return undefined;
      this.carryOut(socket, frame);
      say({ t: 'ack', id: frame.id });
      return this.showAll();
    });
    socket.on('close', () => this.sockets.delete(socket));
  }

  show(socket) {
    const now = Date.now();
    const row = this.view.rooms.find(({ id }) => id === socket.room);
    const view = { ...this.view, role: socket.role, server_ms: now };
    if (row) view.room = this.change(roomDetail(makeRandom(11), now, row));
    else delete view.room;
    const shown = socket.role === 'observer' ? forObserver(view) : view;
    socket.send(JSON.stringify({ t: 'view', view: shown }));
  }

  showAll() {
    for (const socket of this.sockets) this.show(socket);
  }

  sayAll(frame) {
    for (const socket of this.sockets) socket.send(JSON.stringify(frame));
  }

  carryOut(socket, { t, body }) {
    const row = this.view.rooms.find(({ id }) => id === body.room);
    if (t === 'room-select') socket.room = body.room;
    else if (t === 'room-make') {
      const made = makeView({ rooms: body.count, stages: Array(body.count).fill('lobby') }).rooms;
      made.forEach((room, i) => {
        const number = this.view.rooms.length + i + 1;
        this.view.rooms.push({ ...room, id: `a${number}`, code: `A${number}`, strategy: body.strategy });
      });
    } else if (row && ['start', 'resume'].includes(t)) row.stage = 'running';
    else if (row && t === 'pause') row.stage = 'paused';
    else if (row && t === 'end') [row.stage, row.ended] = ['ended', 'ended by the facilitator'];
    else if (row && t === 'strategy') row.strategy = body.name;
    else if (row && t === 'simulate') Object.assign(row.seats[body.seat - 1], { kind: 'simulated', type: body.type });
    if (t !== 'room-select') {
      this.view.log.push({ at_ms: Date.now(), room: body.room ?? undefined, actor: 'facilitator', what: t, reason: body.reason });
    }
  }
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  const here = fileURLToPath(new URL('..', import.meta.url));
  const { values, positionals } = parseArgs({
    allowPositionals: true,
    options: { port: { type: 'string', default: '8081' }, modules: { type: 'string', default: here } },
  });
  const mock = new MockServer(resolve(positionals[0] ?? 'build/facilitator'), values.modules);
  await mock.start(Number(values.port));
  console.log(`${mock.origin}/f#t=${kTokens.facilitator}`);
  console.log(`${mock.origin}/f#t=${kTokens.observer}`);
}
