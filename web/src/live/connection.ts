// What the page knows from the server and what it has told it: every message is sent until it is acknowledged.
// Everything that the page shows follows from `snapshot()`.
import { ReconnectingSocket, type Frame, type SocketState } from '../shared/reconnecting_socket';
import { uuid } from '../shared/uuid';
import { setServerTime } from './clock';
import { everySecond } from './metronome';
import { Outbox } from './outbox';
import type { CommandType, Commands, Message, ParticipantView } from './protocol';

const kAckMs = 20000; // without an acknowledgement: try on a new connection

export interface Refused {
  type: CommandType;
  text: string;
}

export interface Snapshot {
  socket: SocketState;
  view: ParticipantView | null;
  pending: readonly Message[];
  refused: Refused | null;
}

export class Connection {
  private readonly outbox: Outbox;
  private readonly socket: ReconnectingSocket;
  private state: Snapshot;
  private readonly listeners = new Set<() => void>();
  private sent = new Map<string, number>(); // on this connection: when

  constructor(token: string, onOtherRole: (role: string) => void) {
    this.outbox = new Outbox(token);
    const tick = (call: () => void): void =>
      everySecond(() => {
        call();
        if ([...this.sent.values()].some((at) => performance.now() - at > kAckMs)) this.socket.reconnect();
      });
    this.socket = new ReconnectingSocket(token, tick, {
      state: (socket) => {
        this.sent.clear();
        this.change({ socket });
      },
      welcome: (role) => {
        if (role !== 'participant') onOtherRole(role);
        else for (const message of this.outbox.all()) this.post(message);
      },
      frame: (frame) => this.receive(frame),
    });
    this.state = { socket: this.socket.state, view: null, pending: this.outbox.all(), refused: null };
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
    this.post(message);
  }

  // Lost if there is no connection: the next one replaces it.
  sendDraft(body: Commands['draft']): void {
    this.socket.send({ t: 'draft', id: uuid(), body });
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
    // After a long time elsewhere the last view is of no use; local input is kept beside it.
    if (this.state.socket.phase === 'closed') this.change({ view: null });
    this.socket.reconnectNow();
  }

  private change(part: Partial<Snapshot>): void {
    this.state = { ...this.state, ...part };
    for (const listener of this.listeners) listener();
  }

  private post(message: Message): void {
    if (this.socket.state.phase !== 'open') return;
    this.sent.set(message.id, performance.now());
    this.socket.send(message);
  }

  private receive(frame: Frame): void {
    if (frame.t === 'view') this.look(frame.view as ParticipantView);
    else if (frame.t === 'ack') this.settled(String(frame.id));
    else if (frame.t === 'nak') this.settled(String(frame.id), String(frame.text));
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
