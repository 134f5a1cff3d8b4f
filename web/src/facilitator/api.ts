// Requests beside the WebSocket; the token goes into a header, never into an address.
import { download } from '../shared/download';
import { isObject } from './protocol';

export class Api {
  constructor(private readonly token: string) {}

  private async get(target: string): Promise<Response> {
    const reply = await fetch(target, { headers: { Authorization: `Bearer ${this.token}` }, cache: 'no-store' });
    if (!reply.ok) throw new Error(await problemOf(reply));
    return reply;
  }

  // A QR code as an address for an image.
  async qr(text: string): Promise<string> {
    const reply = await this.get(`/api/qr?text=${encodeURIComponent(text)}`);
    return `data:image/svg+xml;charset=utf-8,${encodeURIComponent(await reply.text())}`;
  }

  async integrity(): Promise<unknown> {
    return (await this.get('/api/integrity')).json();
  }

  // Saves the tables of a room, or of all rooms.
  async export(room: string | null): Promise<string> {
    const reply = await this.get(room === null ? '/api/export' : `/api/export?room=${encodeURIComponent(room)}`);
    const named = /filename="?([A-Za-z0-9._-]+)"?/.exec(reply.headers.get('Content-Disposition') ?? '');
    const name = named?.[1] ?? `kith-${room ?? 'all-rooms'}.tar`;
    download(await reply.blob(), name);
    return name;
  }
}

// What the server says went wrong: {error, text}, or else its status.
async function problemOf(reply: Response): Promise<string> {
  const status = `the server answered ${reply.status} ${reply.statusText}`.trim();
  const said: unknown = await reply.json().catch(() => null);
  return isObject(said) && typeof said.text === 'string' ? said.text.trim().replace(/\.$/, '') : status;
}
