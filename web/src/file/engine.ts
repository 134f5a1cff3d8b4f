// The engine of a lesson file: WebAssembly in a worker, both packed into the page.
import { packedIn, scriptIn } from './packed';

// What a lesson shows and asks, by numbers.
export interface Lesson {
  seq: number; // of its event
  demos: number[];
  tests: number[];
}

export interface State {
  events: unknown[];
  view: Record<string, unknown>;
  due_us: number | null;
  teaching: boolean;
  lesson?: Lesson; // if one was chosen
  refusal: { reason: string; text: string } | null;
  warnings?: string[]; // about the inputs
  restored?: { events: unknown[]; lessons: Lesson[] }; // all of a log in which lessons were left out
}

// What is wrong with the inputs, and where; lines and columns from 1.
export interface Diagnostic {
  file: string | null;
  line: number | null;
  column: number | null;
  text: string; // as `kith validate` prints it
}

export class EngineError extends Error {
  constructor(
    message: string,
    readonly diagnostics: Diagnostic[] = [],
  ) {
    super(message);
  }
}

// Requests are answered one after the other.
export class Engine {
  private readonly waiting: { resolve: (reply: never) => void; reject: (error: Error) => void }[] = [];

  private constructor(private readonly worker: Worker) {
    worker.onmessage = ({ data }: MessageEvent<string>) => {
      const next = this.waiting.shift();
      const reply = JSON.parse(data) as { error?: string; diagnostics?: Diagnostic[] };
      if (reply.error === undefined) next?.resolve(reply as never);
      else next?.reject(new EngineError(reply.error, reply.diagnostics));
    };
    worker.onerror = (event) => {
      for (const { reject } of this.waiting.splice(0)) reject(new Error(event.message));
    };
  }

  static start(): Engine {
    const worker = new Worker(scriptIn('kith-engine-script'));
    const engine = new Engine(worker);
    const packed = packedIn('kith-engine');
    worker.postMessage(packed, [packed.buffer]);
    return engine;
  }

  ask<T>(request: Record<string, unknown>): Promise<T> {
    return new Promise<T>((resolve, reject) => {
      this.waiting.push({ resolve: resolve as (reply: never) => void, reject });
      this.worker.postMessage(JSON.stringify({ now_us: Date.now() * 1000, ...request }));
    });
  }
}
