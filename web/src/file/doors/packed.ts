// A log in as few characters as possible, for systems that keep only some thousand: what follows from the rest is left
// out (numbers, contents of lessons, keys that were pressed, half-finished paths), and the rest is deflated.
import type { Log } from '../log';

interface LoggedEvent {
  seq: number;
  at_us: number;
  actor: string;
  type: string;
  body: Record<string, unknown> | null; // null: a lesson, which is chosen again
}

const kFormat = '1';

async function through(bytes: BufferSource, stream: CompressionStream | DecompressionStream): Promise<Uint8Array> {
  return new Uint8Array(await new Response(new Blob([bytes]).stream().pipeThrough(stream)).arrayBuffer());
}

export async function packed(log: Log): Promise<string> {
  let before = 0;
  const events = (log.events as LoggedEvent[])
    .filter(({ type }) => type !== 'draft')
    .map(({ at_us, actor, type, body }) => {
      const ms = Math.floor(at_us / 1000);
      const later = ms - before;
      before = ms;
      const rest = type === 'lesson' ? null : type === 'answered' ? { ...body, keys: [] } : body;
      return [later, actor.replace(/^seat:/, ''), type, ...(rest && Object.keys(rest).length === 0 ? [] : [rest])];
    });
  const bytes = await through(new TextEncoder().encode(JSON.stringify([log.study.slice(0, 16), log.setup['id'], events])), new CompressionStream('deflate'));
  return kFormat + btoa(Array.from(bytes, (byte) => String.fromCharCode(byte)).join(''));
}

/** Nothing if it is no such text, or of another lesson. */
export async function unpacked(text: string, empty: Log): Promise<Log | null> {
  if (!text.startsWith(kFormat)) return null;
  try {
    const bytes = Uint8Array.from(atob(text.slice(1)), (one) => one.charCodeAt(0));
    const json = new TextDecoder().decode(await through(bytes, new DecompressionStream('deflate')));
    const [study, id, events] = JSON.parse(json) as [string, string, [number, string, string, LoggedEvent['body']?][]];
    if (!empty.study.startsWith(study)) return null;
    let ms = 0;
    const all = events.map(([later, actor, type, body], i): LoggedEvent => {
      ms += later;
      return { seq: i + 1, at_us: ms * 1000, actor: /^\d/.test(actor) ? `seat:${actor}` : actor, type, body: body === undefined ? {} : body };
    });
    return { ...empty, setup: { ...empty.setup, id }, events: all };
  } catch {
    return null;
  }
}
