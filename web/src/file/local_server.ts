// In the server's place: the engine behind the same messages, for one person.
import type { Pipe, Transport } from '../shared/transport';
import type { LessonFile } from './document';
import type { Engine, State } from './engine';
import { emptyLog, keepLog, type Log } from './log';
import type { Component, Prediction } from './doors/door';
import type { Teacher } from './teacher';

type Message = { t: string; id?: string; body?: unknown };

const kLongest = 2 ** 31 - 1; // milliseconds that a timer takes

export class LocalServer implements Transport {
  readonly isLocal = true;
  private log: Log;
  private state: State | null = null;
  private pipe: LocalPipe | null = null;
  private timer: ReturnType<typeof setTimeout> | undefined;
  private isKept = true;
  private isStopped = false;
  private readonly opened: Promise<void>;

  constructor(
    private readonly engine: Engine,
    private readonly file: LessonFile,
    log: Log | null,
    private readonly learner: string,
    private readonly onKept: (isKept: boolean) => void,
    private readonly onNews: () => void, // something has happened that others may want to know
  ) {
    this.log = log ?? emptyLog(file);
    const { setup, events } = this.log;
    this.opened = engine
      .ask<State>({ do: 'open', inputs: file.inputs, setup, events })
      .then((state) => {
        if (state.restored) Object.assign(this.log, state.restored);
        this.take(state);
        if (state.restored) this.onNews();
      });
  }

  /** Rejects if the log cannot be gone on with. */
  ready(): Promise<void> {
    return this.opened;
  }

  // Nothing is kept any more: what is kept is about to be erased.
  stop(): void {
    this.isStopped = true;
    clearTimeout(this.timer);
  }

  // All that has happened, sealed.
  async export(): Promise<Log & { seal: string; inputs: LessonFile['inputs'] }> {
    const { seal } = await this.engine.ask<{ seal: string }>({ do: 'seal' });
    return { ...this.log, seal, inputs: this.file.inputs };
  }

  /** How far the learner is. */
  progress(): Promise<{ predictions: Prediction[]; components: Component[] }> {
    return this.engine.ask({ do: 'progress' });
  }

  /** What the teacher showed, and took the learner to believe. */
  teacher(): Promise<Teacher> {
    return this.engine.ask({ do: 'teacher' });
  }

  get stage(): string {
    return String(this.state?.view['stage'] ?? '');
  }

  get soFar(): Log {
    return this.log;
  }

  open(): Pipe {
    const pipe = new LocalPipe((message) => void this.receive(pipe, message));
    this.pipe = pipe;
    void this.opened.then(() => pipe.onopen?.());
    return pipe;
  }

  world(key: string): Promise<unknown> {
    return this.engine.ask({ do: 'world', key });
  }

  async get(path: string): Promise<unknown> {
    await this.opened;
    if (path === '/api/texts') return this.engine.ask({ do: 'texts' });
    const world = /^\/api\/world\/(.+)$/.exec(path)?.[1];
    if (world !== undefined) return this.world(decodeURIComponent(world));
    throw new Error(`there is no ${path}`);
  }

  private async receive(pipe: LocalPipe, message: Message): Promise<void> {
    if (message.t === 'hello') {
      pipe.reply({ t: 'welcome', role: 'participant' });
      this.show();
    } else if (message.t === 'beat') {
      pipe.reply({ t: 'beat' });
    } else {
      await this.command(pipe, message);
    }
  }

  private async command(pipe: LocalPipe, { t, id = '', body }: Message): Promise<void> {
    if (this.log.messages.includes(id)) return pipe.reply({ t: 'ack', id });
    const state = await this.engine.ask<State>({ do: 'ask', type: t, body });
    if (!state.refusal && t !== 'draft') this.log.messages.push(id);
    this.take(state);
    pipe.reply(state.refusal ? { t: 'nak', id, text: state.refusal.text } : { t: 'ack', id });
    this.show();
  }

  // What the engine says now becomes what is kept and what is due.
  private take(state: State): void {
    this.state = state;
    if (state.lesson) this.log.lessons.push(state.lesson);
    if (state.events.length > 0) {
      this.log.events.push(...state.events);
      const isKept = this.isStopped || keepLog(this.file, this.learner, this.log);
      if (isKept !== this.isKept) this.onKept((this.isKept = isKept));
      if (!this.isStopped && state.events.some((event) => (event as { type: string }).type !== 'draft')) this.onNews();
    }
    clearTimeout(this.timer);
    if (state.teaching) this.later(0, 'teach');
    else if (state.due_us !== null) this.later(state.due_us / 1000 - Date.now(), 'tick');
  }

  private later(ms: number, what: 'teach' | 'tick'): void {
    this.timer = setTimeout(
      () =>
        void this.engine.ask<State>({ do: what }).then((state) => {
          this.take(state);
          this.show();
        }),
      Math.min(kLongest, Math.max(0, ms)),
    );
  }

  private show(): void {
    if (!this.state) return;
    const { view } = this.state;
    this.pipe?.reply({ t: 'view', view });
    window.dispatchEvent(new CustomEvent('kith-view', { detail: view }));
  }
}

class LocalPipe implements Pipe {
  onopen: Pipe['onopen'] = null;
  onmessage: Pipe['onmessage'] = null;
  onclose: Pipe['onclose'] = null;

  constructor(private readonly receive: (message: Message) => void) {}

  send(text: string): void {
    this.receive(JSON.parse(text) as Message);
  }

  reply(frame: object): void {
    this.onmessage?.({ data: JSON.stringify(frame) });
  }

  close(): void {
    this.onmessage = null;
  }
}
