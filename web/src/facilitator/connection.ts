// The facilitator's line to the server: hello, heartbeats, commands that are sent again until they are
// acknowledged, and reconnecting with growing pauses.
import { isObject, type FacilitatorView } from './protocol';

export type LinkState =
  | { state: 'connecting' }
  | { state: 'live' }
  | { state: 'reconnecting'; since_ms: number; stopped: boolean }
  | { state: 'refused'; reason: string };

export interface Listener {
  link: (link: LinkState) => void;
  view: (view: FacilitatorView) => void;
  welcome: (about: { role: string; server: string }) => void;
}

export class Refused extends Error {
  constructor(
    readonly reason: string,
    text: string,
  ) {
    super(text);
  }
}

const kBeat = 5000;
const kSilence = 15000; // after a heartbeat without an answer for so long, the line is taken for dead
const kPause = { first: 500, longest: 8000 };
const kVersion = 1;

interface Pending {
  frame: string;
  done: () => void;
  failed: (why: Refused) => void;
}

// Also where the page is not served through TLS, and crypto.randomUUID does not exist.
export function uuid(): string {
  const bytes = crypto.getRandomValues(new Uint8Array(16));
  bytes[6] = ((bytes[6] ?? 0) & 0x0f) | 0x40;
  bytes[8] = ((bytes[8] ?? 0) & 0x3f) | 0x80;
  const hex = [...bytes].map((byte) => byte.toString(16).padStart(2, '0')).join('');
  return [hex.slice(0, 8), hex.slice(8, 12), hex.slice(12, 16), hex.slice(16, 20), hex.slice(20)].join('-');
}

export function socketAddress(place: Location): string {
  return `${place.protocol === 'https:' ? 'wss:' : 'ws:'}//${place.host}/ws`;
}

export class Connection {
  private socket: WebSocket | null = null;
  private readonly tab = uuid();
  // Kept in memory only: a command from before a reload must not be carried out minutes later.
  private readonly pending = new Map<string, Pending>();
  private attempts = 0;
  private lost_ms = 0;
  private unanswered_ms = 0; // since when the server owes an answer; 0: it does not
  private isStopped = false;
  private isOver = false;
  private timer = 0;

  constructor(
    private readonly address: string,
    private readonly token: string,
    private readonly listener: Listener,
  ) {
    window.setInterval(() => this.beat(), kBeat);
    window.addEventListener('online', () => this.retryNow());
    this.listener.link({ state: 'connecting' });
    this.open();
  }

  // Resolves when the server has stored the command; rejects with Refused when it does not take it.
  send(type: string, body: object): Promise<void> {
    const id = uuid();
    const frame = JSON.stringify({ t: type, id, body });
    return new Promise((done, failed) => {
      this.pending.set(id, { frame, done, failed });
      if (this.socket?.readyState === WebSocket.OPEN) this.socket.send(frame);
    });
  }

  retryNow(): void {
    if (this.isOver || this.socket) return;
    window.clearTimeout(this.timer);
    this.open();
  }

  close(): void {
    this.isOver = true;
    this.socket?.close();
  }

  private open(): void {
    const socket = new WebSocket(this.address);
    this.socket = socket;
    this.unanswered_ms = Date.now(); // of hello, which may not even be sent
    socket.onopen = () => {
      if (this.socket !== socket) return;
      socket.send(JSON.stringify({ t: 'hello', v: kVersion, token: this.token, tab: this.tab }));
    };
    socket.onmessage = (event) => {
      if (this.socket !== socket) return;
      this.unanswered_ms = 0;
      if (typeof event.data === 'string') this.take(event.data);
    };
    socket.onclose = () => {
      if (this.socket === socket) this.dropped();
    };
  }

  private take(text: string): void {
    const frame: unknown = JSON.parse(text);
    if (!isObject(frame)) return;
    if (frame.t === 'welcome') this.welcomed(String(frame.role), String(frame.server));
    else if (frame.t === 'view') this.listener.view(frame.view as FacilitatorView);
    else if (frame.t === 'ack') this.settle(String(frame.id), null);
    else if (frame.t === 'nak') this.settle(String(frame.id), new Refused(String(frame.reason), String(frame.text)));
    else if (frame.t === 'bye') this.dismissed(String(frame.reason));
  }

  private welcomed(role: string, server: string): void {
    this.attempts = 0;
    this.lost_ms = 0;
    this.isStopped = false;
    this.listener.welcome({ role, server });
    this.listener.link({ state: 'live' });
    for (const { frame } of this.pending.values()) this.socket?.send(frame);
  }

  private settle(id: string, why: Refused | null): void {
    const command = this.pending.get(id);
    this.pending.delete(id);
    if (why) command?.failed(why);
    else command?.done();
  }

  private dismissed(reason: string): void {
    if (reason === 'server-stops') {
      this.isStopped = true;
      return;
    }
    this.isOver = true;
    const why = new Refused(reason, 'This link no longer gives access, so the command was not carried out.');
    for (const id of [...this.pending.keys()]) this.settle(id, why);
    this.listener.link({ state: 'refused', reason });
  }

  private dropped(): void {
    this.socket = null;
    if (this.isOver) return;
    if (this.lost_ms === 0) this.lost_ms = Date.now();
    this.listener.link({ state: 'reconnecting', since_ms: this.lost_ms, stopped: this.isStopped });
    const pause = Math.min(kPause.longest, kPause.first * 2 ** this.attempts);
    this.attempts += 1;
    this.timer = window.setTimeout(() => this.open(), pause * (0.5 + Math.random() / 2));
  }

  private beat(): void {
    const socket = this.socket;
    if (!socket) return;
    // Not the time since the last frame: in hidden tabs this may run once a minute only.
    if (this.unanswered_ms > 0 && Date.now() - this.unanswered_ms > kSilence) {
      this.socket = null; // a dead line may take minutes to say that it is closed
      socket.close();
      this.dropped();
    } else if (socket.readyState === WebSocket.OPEN) {
      if (this.unanswered_ms === 0) this.unanswered_ms = Date.now();
      socket.send(JSON.stringify({ t: 'beat' }));
    }
  }
}
