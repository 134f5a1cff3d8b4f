// In the server's place: the engine behind the same messages, for one person.
import type { Pipe, Transport } from '../shared/transport';
import type { LessonFile } from './document';
import type { Engine, State } from './engine';
import { emptyLog, holdLog, holdsLog, keepLog, recalledLog, type Log } from './log';
import type { Component, Prediction } from './doors/door';
import type { Teacher } from './teacher';

type Message = { t: string; id?: string; body?: unknown };

const kLongest = 2 ** 31 - 1; // milliseconds that a timer takes

export class LocalServer implements Transport {
  readonly isLocal = true;
  readonly isAlone: boolean;
  private log: Log;
  private state: State | null = null;
  private pipe: LocalPipe | null = null;
  private timer: ReturnType<typeof setTimeout> | undefined;
  private isKept = true;
  private isStopped = false;
  private isElsewhere = false;
  private opened: Promise<void>;

  /** @param learner nothing where it is not known yet: what happens is neither kept nor told until `goOn`. */
  constructor(
    private readonly engine: Engine,
    private readonly file: LessonFile,
    log: Log | null,
    private learner: string | null,
    readonly notices: () => string[],
    private readonly on: {
      kept: (isKept: boolean) => void;
      news: () => void; // something has happened that others may want to know
      consent: () => void;
      elsewhere: (isElsewhere: boolean) => void; // another tab has the lesson now, or this one again
    },
  ) {
    this.isAlone = file.alone === true;
    this.log = log ?? emptyLog(file);
    this.opened = this.load();
    window.addEventListener('storage', () => void this.isHere());
  }

  private async load(): Promise<void> {
    if (this.learner !== null) holdLog(this.file, this.learner);
    const { setup, events } = this.log;
    const state = await this.engine.ask<State>({ do: 'open', inputs: this.file.inputs, setup, events });
    if (state.restored) Object.assign(this.log, state.restored);
    this.take(state);
    if (state.restored) this.on.news();
  }

  /** Rejects if the log cannot be gone on with. */
  ready(): Promise<void> {
    return this.opened;
  }

  /** The lesson of this learner from now on, with what was kept of it, if anything was. */
  async goOn(learner: string, log: Log | null): Promise<void> {
    this.learner = learner;
    if (log) this.log = log;
    this.opened = this.load();
    await this.opened;
    this.keep();
    this.show();
    this.on.news();
  }

  // Nothing is kept any more: what is kept is about to be erased, or belongs to another tab.
  stop(): void {
    this.isStopped = true;
    clearTimeout(this.timer);
  }

  // Whether the lesson is still that of this tab. Otherwise what is kept is newer than what this tab knows.
  private isHere(): boolean {
    if (this.isElsewhere) return false;
    if (this.isStopped || this.learner === null || holdsLog(this.file, this.learner)) return true;
    this.stop();
    this.isElsewhere = true;
    this.pipe?.reply({ t: 'bye', reason: 'opened-elsewhere' });
    this.on.elsewhere(true);
    return false;
  }

  private async comeBack(learner: string): Promise<void> {
    this.isElsewhere = this.isStopped = false;
    await this.goOn(learner, recalledLog(this.file, learner));
    this.on.elsewhere(false);
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
    if (this.isElsewhere && this.learner !== null) this.opened = this.comeBack(this.learner);
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
    if (!this.isHere()) return;
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
      this.keep();
      const types = (state.events as { type: string }[]).map(({ type }) => type);
      if (types.includes('consented')) this.on.consent();
      if (!this.isStopped && types.some((type) => type !== 'draft')) this.on.news();
    }
    clearTimeout(this.timer);
    if (this.isStopped) return;
    if (state.teaching) this.later(0, 'teach');
    else if (state.due_us !== null) this.later(state.due_us / 1000 - Date.now(), 'tick');
  }

  private keep(): void {
    if (this.learner === null || !this.isHere() || this.isStopped) return;
    const isKept = keepLog(this.file, this.learner, this.log);
    if (isKept !== this.isKept) this.on.kept((this.isKept = isKept));
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
