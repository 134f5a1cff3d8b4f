// A WebSocket to the server that authenticates, sends heartbeats, and reconnects with exponential backoff.
import { transport, type Pipe } from './transport';
import { uuid } from './uuid';

const kVersion = 1; // of the protocol
const kHeartbeatMs = 5000;
const kReplyMs = 15000; // without a reply that is due, the connection is dead
const kAttemptMs = 2000; // a slower attempt is given up when the network may have become better
const kBackoffMs = { first: 500, longest: 8000 };

export type ByeReason = 'opened-elsewhere' | 'removed' | 'server-stops' | 'bad-token' | 'no-view';

export interface SocketState {
  phase: 'connecting' | 'open' | 'lost' | 'closed'; // lost: it is reconnecting; closed: for good
  since: number; // performance.now() when the phase began
  bye: ByeReason | null; // why the server closed the connection, if it said so
}

export type Frame = { t: string } & Record<string, unknown>;

interface Listener {
  state: (state: SocketState) => void;
  welcome: (role: string) => void; // from now on frames can be sent
  frame: (frame: Frame) => void; // views and acknowledgements
}

export class ReconnectingSocket {
  private socket: Pipe | null = null;
  private current: SocketState = { phase: 'connecting', since: performance.now(), bye: null };
  private readonly tab = uuid(); // of this page, not of the tab: a duplicated tab has the same storage
  private attempts = 0;
  private retryTimer: ReturnType<typeof setTimeout> | undefined;
  private attemptedAt = 0;
  private heartbeatAt = 0;
  private replyDueSince: number | null = null;

  constructor(
    private readonly token: string,
    everySecond: (call: () => void) => void,
    private readonly listener: Listener,
  ) {
    everySecond(() => this.keepAlive());
    window.addEventListener('online', () => this.wake());
    window.addEventListener('offline', () => this.reconnect());
    window.addEventListener('pageshow', (event) => {
      if (event.persisted) this.wake();
    });
    document.addEventListener('visibilitychange', () => {
      if (document.visibilityState === 'visible') this.wake();
    });
    this.connect();
  }

  get state(): SocketState {
    return this.current;
  }

  // Does nothing without a connection.
  send(frame: object): void {
    if (this.current.phase === 'open') this.socket?.send(JSON.stringify(frame));
  }

  // Without waiting, also if the server has closed the connection for good.
  reconnectNow(): void {
    if (this.current.phase === 'open') return;
    this.attempts = 0;
    if (this.current.phase === 'closed') this.change({ phase: 'connecting', bye: null });
    this.connect();
  }

  // Drops the connection and makes a new one after a pause, which doubles with every attempt.
  reconnect(): void {
    this.discard();
    if (this.current.phase === 'closed') return;
    const pause = Math.min(kBackoffMs.longest, kBackoffMs.first * 2 ** this.attempts);
    this.attempts += 1;
    clearTimeout(this.retryTimer);
    this.retryTimer = setTimeout(() => this.connect(), pause * (0.5 + Math.random() / 2));
    this.change({ phase: 'lost' });
  }

  private change(part: Partial<SocketState>): void {
    const isSame = part.phase === undefined || part.phase === this.current.phase;
    this.current = { ...this.current, ...part, since: isSame ? this.current.since : performance.now() };
    this.listener.state(this.current);
  }

  private connect(): void {
    clearTimeout(this.retryTimer);
    this.discard();
    const socket = transport().open();
    this.socket = socket;
    this.attemptedAt = this.replyDueSince = performance.now();
    socket.onopen = () => socket.send(JSON.stringify({ t: 'hello', v: kVersion, token: this.token, tab: this.tab }));
    socket.onmessage = (event) => this.receive(String(event.data));
    socket.onclose = () => this.reconnect();
  }

  // Does not wait for the close event: for a dead connection it may take minutes.
  private discard(): void {
    const socket = this.socket;
    this.socket = null;
    if (!socket) return;
    socket.onopen = socket.onmessage = socket.onclose = null;
    socket.close();
  }

  // The server can probably be reached now.
  private wake(): void {
    if (this.current.phase === 'closed') return;
    if (this.current.phase === 'open') this.sendHeartbeat();
    else if (!this.socket || performance.now() - this.attemptedAt > kAttemptMs) this.connect();
  }

  // Counts from when a reply became due, not from the last frame: timers of hidden tabs run once a minute.
  private keepAlive(): void {
    if (!this.socket) return;
    const now = performance.now();
    if (this.replyDueSince !== null && now - this.replyDueSince > kReplyMs) this.reconnect();
    else if (this.current.phase === 'open' && now - this.heartbeatAt >= kHeartbeatMs) this.sendHeartbeat();
  }

  private sendHeartbeat(): void {
    this.heartbeatAt = performance.now();
    this.replyDueSince ??= this.heartbeatAt;
    this.send({ t: 'beat' });
  }

  private receive(text: string): void {
    this.replyDueSince = null;
    const frame = JSON.parse(text) as Frame;
    if (frame.t === 'welcome') this.receiveWelcome(String(frame.role));
    else if (frame.t === 'bye') this.receiveBye(frame.reason as ByeReason);
    else if (frame.t !== 'beat') this.listener.frame(frame);
  }

  private receiveWelcome(role: string): void {
    this.attempts = 0;
    this.heartbeatAt = performance.now();
    this.change({ phase: 'open', bye: null });
    this.listener.welcome(role);
  }

  private receiveBye(bye: ByeReason): void {
    if (bye === 'server-stops') this.change({ bye });
    else {
      this.discard();
      this.change({ phase: 'closed', bye });
    }
  }
}
