// A page's line to the server: says hello, keeps the connection alive, and makes a new one when it is lost, with growing
// pauses between attempts.
import { uuid } from './uuid';

const kVersion = 1; // of the protocol
const kBeatMs = 5000;
const kSilenceMs = 15000; // without an answer that is due: the connection is dead
const kHungMs = 2000; // an attempt that takes so long is given up when there is reason to hope for better
const kPauseMs = { first: 500, longest: 8000 };

export type ByeReason = 'opened-elsewhere' | 'removed' | 'server-stops' | 'bad-token';

export interface LineState {
  phase: 'connecting' | 'open' | 'lost' | 'closed'; // lost: it keeps trying; closed: for good
  since: number; // performance.now() when the phase began
  bye: ByeReason | null; // why the server hung up, if it said so
}

export type Frame = { t: string } & Record<string, unknown>;

interface Listener {
  state: (state: LineState) => void;
  welcome: (role: string) => void; // from now on frames can be sent
  frame: (frame: Frame) => void; // views and acknowledgements
}

export class Line {
  private socket: WebSocket | null = null;
  private now: LineState = { phase: 'connecting', since: performance.now(), bye: null };
  private readonly tab = uuid(); // of this page, not of the tab: a duplicated tab has the same storage
  private attempts = 0;
  private retryTimer: ReturnType<typeof setTimeout> | undefined;
  private tried = 0; // when the connection was asked for
  private beaten = 0; // when the last heartbeat was sent
  private owedSince: number | null = null; // since when the server owes an answer

  constructor(
    private readonly token: string,
    everySecond: (call: () => void) => void,
    private readonly listener: Listener,
  ) {
    everySecond(() => this.tend());
    window.addEventListener('online', () => this.hurry());
    window.addEventListener('offline', () => this.lose());
    window.addEventListener('pageshow', (event) => {
      if (event.persisted) this.hurry();
    });
    document.addEventListener('visibilitychange', () => {
      if (document.visibilityState === 'visible') this.hurry();
    });
    this.connect();
  }

  get state(): LineState {
    return this.now;
  }

  // Does nothing without a connection.
  send(frame: object): void {
    if (this.now.phase === 'open') this.socket?.send(JSON.stringify(frame));
  }

  // Tries at once, also if the server has hung up for good.
  retry(): void {
    if (this.now.phase === 'open') return;
    this.attempts = 0;
    if (this.now.phase === 'closed') this.change({ phase: 'connecting', bye: null });
    this.connect();
  }

  // Gives the connection up, and makes a new one.
  lose(): void {
    this.hangUp();
    if (this.now.phase === 'closed') return;
    const pause = Math.min(kPauseMs.longest, kPauseMs.first * 2 ** this.attempts);
    this.attempts += 1;
    clearTimeout(this.retryTimer);
    this.retryTimer = setTimeout(() => this.connect(), pause * (0.5 + Math.random() / 2));
    this.change({ phase: 'lost' });
  }

  private change(part: Partial<LineState>): void {
    const isSame = part.phase === undefined || part.phase === this.now.phase;
    this.now = { ...this.now, ...part, since: isSame ? this.now.since : performance.now() };
    this.listener.state(this.now);
  }

  private connect(): void {
    clearTimeout(this.retryTimer);
    this.hangUp();
    const socket = new WebSocket(`${location.protocol === 'https:' ? 'wss:' : 'ws:'}//${location.host}/ws`);
    this.socket = socket;
    this.tried = this.owedSince = performance.now();
    socket.onopen = () => socket.send(JSON.stringify({ t: 'hello', v: kVersion, token: this.token, tab: this.tab }));
    socket.onmessage = (event) => this.receive(String(event.data));
    socket.onclose = () => this.lose();
  }

  // Without hearing of it: a dead connection may take minutes to say that it is closed.
  private hangUp(): void {
    const socket = this.socket;
    this.socket = null;
    if (!socket) return;
    socket.onopen = socket.onmessage = socket.onclose = null;
    socket.close();
  }

  // There is reason to believe that the server can be reached now.
  private hurry(): void {
    if (this.now.phase === 'closed') return;
    if (this.now.phase === 'open') this.beat();
    else if (!this.socket || performance.now() - this.tried > kHungMs) this.connect();
  }

  // What counts is the time since an answer is due, not since the last frame: timers of hidden tabs run once a minute.
  private tend(): void {
    if (!this.socket) return;
    const now = performance.now();
    if (this.owedSince !== null && now - this.owedSince > kSilenceMs) this.lose();
    else if (this.now.phase === 'open' && now - this.beaten >= kBeatMs) this.beat();
  }

  private beat(): void {
    this.beaten = performance.now();
    this.owedSince ??= this.beaten;
    this.send({ t: 'beat' });
  }

  private receive(text: string): void {
    this.owedSince = null;
    const frame = JSON.parse(text) as Frame;
    if (frame.t === 'welcome') this.welcomed(String(frame.role));
    else if (frame.t === 'bye') this.dismissed(frame.reason as ByeReason);
    else if (frame.t !== 'beat') this.listener.frame(frame);
  }

  private welcomed(role: string): void {
    this.attempts = 0;
    this.beaten = performance.now();
    this.change({ phase: 'open', bye: null });
    this.listener.welcome(role);
  }

  private dismissed(bye: ByeReason): void {
    if (bye === 'server-stops') this.change({ bye });
    else {
      this.hangUp();
      this.change({ phase: 'closed', bye });
    }
  }
}
