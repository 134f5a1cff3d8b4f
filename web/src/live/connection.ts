// The connection to the server: says hello, keeps it alive, reconnects, and sends every message until it is
// acknowledged. Everything that the page shows follows from `snapshot()`.
import { serverNow, setServerTime } from './clock';
import { everySecond } from './metronome';
import { Outbox } from './outbox';
import type { ByeReason, CommandType, Commands, Message, ParticipantView, ServerFrame } from './protocol';
import { uuid } from './storage';

const kBeatMs = 5000;
const kSilenceMs = 15000; // without any frame: the connection is dead
const kBack = { first: 500, most: 8000 };
const kAckMs = 20000; // without an acknowledgement: try on a new connection

export interface Refused {
  type: CommandType;
  text: string;
}

export interface Snapshot {
  // closed: for good, see `bye`.
  phase: 'connecting' | 'open' | 'waiting' | 'closed';
  everOpen: boolean;
  since: number; // performance.now() of the last change of phase
  bye: ByeReason | null;
  view: ParticipantView | null;
  pending: readonly Message[];
  refused: Refused | null;
}

export class Connection {
  private socket: WebSocket | null = null;
  private state: Snapshot;
  private readonly outbox: Outbox;
  private readonly listeners = new Set<() => void>();
  private readonly tab = uuid(); // of this page, not of the tab: a duplicated tab has the same storage
  private attempts = 0;
  private retry: ReturnType<typeof setTimeout> | undefined;
  private welcome = false;
  private heard = 0;
  private beaten = 0;
  private hasBeats = false;
  private sent = new Map<string, number>();

  constructor(
    private readonly token: string,
    private readonly onOtherRole: (role: string) => void,
  ) {
    this.outbox = new Outbox(token);
    this.state = {
      phase: 'connecting',
      everOpen: false,
      since: performance.now(),
      bye: null,
      view: null,
      pending: this.outbox.all(),
      refused: null,
    };
    everySecond(() => this.tend());
    window.addEventListener('online', () => this.hurry());
    window.addEventListener('offline', () => this.drop());
    document.addEventListener('visibilitychange', () => {
      if (document.visibilityState === 'visible') this.hurry();
    });
    window.addEventListener('pageshow', (event) => {
      if (event.persisted) this.hurry();
    });
    this.connect();
  }

  snapshot(): Snapshot {
    return this.state;
  }

  subscribe(listener: () => void): () => void {
    this.listeners.add(listener);
    return () => this.listeners.delete(listener);
  }

  // Kept until it is acknowledged.
  send<T extends CommandType>(t: T, body: Commands[T]): void {
    const message: Message = { t, id: uuid(), body };
    this.outbox.add(message);
    this.change({ pending: this.outbox.all(), refused: null });
    if (this.welcome) this.post(message);
  }

  // Lost if there is no connection: the next one replaces it.
  sendDraft(body: Commands['draft']): void {
    if (this.welcome) this.raw({ t: 'draft', id: uuid(), body });
  }

  // Whether such a message waits for its acknowledgement.
  isPending(t: CommandType): boolean {
    return this.state.pending.some((message) => message.t === t);
  }

  dismissRefusal(): void {
    this.change({ refused: null });
  }

  // Take over from the tab that has opened this session elsewhere, or simply try again.
  reopen(): void {
    this.attempts = 0;
    // After a long time elsewhere the last view is of no use; local input is kept beside it.
    this.change(this.state.phase === 'closed' ? { bye: null, view: null } : { bye: null });
    this.connect();
  }

  private change(part: Partial<Snapshot>): void {
    const since = part.phase && part.phase !== this.state.phase ? performance.now() : this.state.since;
    this.state = { ...this.state, ...part, since };
    for (const listener of this.listeners) listener();
  }

  private connect(): void {
    clearTimeout(this.retry);
    this.forgetSocket();
    this.change({ phase: 'connecting' });
    const scheme = location.protocol === 'https:' ? 'wss:' : 'ws:';
    let socket: WebSocket;
    try {
      socket = new WebSocket(`${scheme}//${location.host}/ws`);
    } catch {
      this.wait();
      return;
    }
    this.socket = socket;
    this.welcome = false;
    this.hasBeats = false;
    this.heard = performance.now();
    this.sent = new Map();
    socket.onopen = () => this.raw({ t: 'hello', v: 1, token: this.token, tab: this.tab });
    socket.onmessage = (event) => this.receive(String(event.data));
    socket.onclose = () => this.wait();
  }

  // Closes without hearing of it.
  private forgetSocket(): void {
    const socket = this.socket;
    this.socket = null;
    this.welcome = false;
    if (!socket) return;
    socket.onopen = socket.onmessage = socket.onclose = null;
    socket.close();
  }

  private drop(): void {
    if (this.state.phase === 'closed') return;
    this.wait();
  }

  private wait(): void {
    this.forgetSocket();
    if (this.state.bye && this.state.bye !== 'server-stops') {
      this.change({ phase: 'closed' });
      return;
    }
    const ceiling = Math.min(kBack.most, kBack.first * 2 ** this.attempts);
    this.attempts += 1;
    clearTimeout(this.retry);
    this.retry = setTimeout(() => this.connect(), Math.max(kBack.first, ceiling * (0.5 + Math.random() / 2)));
    this.change({ phase: 'waiting' });
  }

  private hurry(): void {
    const isHung = this.state.phase === 'connecting' && performance.now() - this.state.since > 2000;
    if (this.state.phase === 'waiting' || isHung) this.connect();
    else if (this.state.phase === 'open') this.beat();
  }

  private tend(): void {
    if (!this.socket) return;
    const now = performance.now();
    const isSilent = now - this.heard > kSilenceMs && (this.hasBeats || !this.welcome);
    const isStuck = [...this.sent.values()].some((at) => now - at > kAckMs);
    if (isSilent || isStuck) this.wait();
    else if (this.welcome && now - this.beaten >= kBeatMs) this.beat();
  }

  private beat(): void {
    this.beaten = performance.now();
    this.raw({ t: 'beat' });
  }

  private raw(frame: object): void {
    if (this.socket?.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(frame));
  }

  private post(message: Message): void {
    this.sent.set(message.id, performance.now());
    this.raw(message);
  }

  private receive(text: string): void {
    this.heard = performance.now();
    let frame: ServerFrame;
    try {
      frame = JSON.parse(text) as ServerFrame;
    } catch {
      return; // not for us
    }
    if (frame.t === 'welcome') this.greeted(frame.role);
    else if (frame.t === 'view') this.look(frame.view);
    else if (frame.t === 'ack') this.settled(frame.id);
    else if (frame.t === 'nak') this.settled(frame.id, frame.text);
    else if (frame.t === 'bye') this.leave(frame.reason);
    else if (frame.t === 'beat') this.hasBeats = true;
  }

  private greeted(role: string): void {
    if (role !== 'participant') {
      this.onOtherRole(role);
      return;
    }
    this.welcome = true;
    this.attempts = 0;
    this.beaten = performance.now();
    this.change({ phase: 'open', everOpen: true, bye: null });
    for (const message of this.outbox.all()) this.post(message);
  }

  private leave(bye: ByeReason): void {
    this.change({ bye });
    if (bye !== 'server-stops') this.wait();
  }

  private look(view: ParticipantView): void {
    if (Number.isFinite(view.server_ms)) setServerTime(view.server_ms);
    this.change({ view });
  }

  private settled(id: string, refusal?: string): void {
    this.sent.delete(id);
    const message = this.outbox.remove(id);
    if (!message) return; // a draft
    const refused = refusal === undefined ? null : { type: message.t, text: refusal };
    this.change({ pending: this.outbox.all(), ...(refused ? { refused } : {}) });
  }

}

// When the server's clock will be at `ms`, in milliseconds from now.
export const remaining = (ms: number): number => ms - serverNow();
