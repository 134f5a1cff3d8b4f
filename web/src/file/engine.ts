// The engine of a lesson file: WebAssembly in a worker, both packed into the page.

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
  restored?: { events: unknown[]; lessons: Lesson[] }; // all of a log in which lessons were left out
}

async function unpacked(id: string): Promise<ArrayBuffer> {
  const text = document.getElementById(id)?.textContent?.trim() ?? '';
  const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('gzip'));
  return new Response(stream).arrayBuffer();
}

// Requests are answered one after the other.
export class Engine {
  private readonly waiting: { resolve: (reply: never) => void; reject: (error: Error) => void }[] = [];

  private constructor(private readonly worker: Worker) {
    worker.onmessage = ({ data }: MessageEvent<string>) => {
      const next = this.waiting.shift();
      const reply = JSON.parse(data) as { error?: string };
      if (reply.error === undefined) next?.resolve(reply as never);
      else next?.reject(new Error(reply.error));
    };
    worker.onerror = (event) => {
      for (const { reject } of this.waiting.splice(0)) reject(new Error(event.message));
    };
  }

  static async start(): Promise<Engine> {
    const [script, wasm] = await Promise.all([unpacked('kith-engine-script'), unpacked('kith-engine')]);
    const address = URL.createObjectURL(new Blob([script], { type: 'text/javascript' }));
    const worker = new Worker(address);
    const engine = new Engine(worker);
    worker.postMessage(wasm, [wasm]);
    return engine;
  }

  ask<T>(request: Record<string, unknown>): Promise<T> {
    return new Promise<T>((resolve, reject) => {
      this.waiting.push({ resolve: resolve as (reply: never) => void, reject });
      this.worker.postMessage(JSON.stringify({ now_us: Date.now() * 1000, ...request }));
    });
  }
}
