// The facilitator's connection: views, and commands that are sent again until they are acknowledged.
import { ReconnectingSocket, type Frame, type SocketState } from '../shared/reconnecting_socket';
import { uuid } from '../shared/uuid';
import type { FacilitatorView } from './protocol';

export interface Listener {
  socket: (state: SocketState) => void;
  view: (view: FacilitatorView) => void;
  welcome: () => void;
}

export class Refused extends Error {}

interface Pending {
  frame: object;
  done: () => void;
  failed: (why: Refused) => void;
}

export class Connection {
  private readonly socket: ReconnectingSocket;
  // Kept in memory only: a command from before a reload must not be carried out minutes later.
  private readonly pending = new Map<string, Pending>();

  constructor(
    token: string,
    private readonly listener: Listener,
  ) {
    this.socket = new ReconnectingSocket(token, (call) => setInterval(call, 1000), {
      state: (state) => this.changed(state),
      welcome: () => {
        for (const { frame } of this.pending.values()) this.socket.send(frame);
        this.listener.welcome();
      },
      frame: (frame) => this.receive(frame),
    });
  }

  // Resolves when the server has stored the command; rejects with Refused when it does not take it.
  send(type: string, body: object): Promise<void> {
    const id = uuid();
    const frame = { t: type, id, body };
    return new Promise((done, failed) => {
      this.pending.set(id, { frame, done, failed });
      this.socket.send(frame);
    });
  }

  retry(): void {
    this.socket.reconnectNow();
  }

  private receive(frame: Frame): void {
    if (frame.t === 'view') this.listener.view(frame.view as FacilitatorView);
    else if (frame.t === 'ack') this.settle(String(frame.id), null);
    else if (frame.t === 'nak') this.settle(String(frame.id), new Refused(String(frame.text)));
  }

  private settle(id: string, why: Refused | null): void {
    const command = this.pending.get(id);
    this.pending.delete(id);
    if (why) command?.failed(why);
    else command?.done();
  }

  private changed(state: SocketState): void {
    if (state.phase === 'closed') {
      const why = new Refused('This link no longer gives access, so the command was not carried out.');
      for (const id of [...this.pending.keys()]) this.settle(id, why);
    }
    this.listener.socket(state);
  }
}
