// How a page reaches what teaches: a server on the network, or, in a lesson file, an engine in the page.

// What of a WebSocket is used.
export interface Pipe {
  onopen: (() => void) | null;
  onmessage: ((event: { data: unknown }) => void) | null;
  onclose: (() => void) | null;
  send: (text: string) => void;
  close: () => void;
}

export interface Transport {
  isLocal: boolean;
  isAlone: boolean; // without a study: there is nothing to agree to, and nobody to show a code to
  open: () => Pipe;
  /** A document of the server; throws if it cannot be had. */
  get: (path: string, token?: string) => Promise<unknown>;
  /** What this page does with what people do, beyond the text that they agree to. */
  notices: () => string[];
}

const network: Transport = {
  isLocal: false,
  isAlone: false,
  open: () => new WebSocket(`${location.protocol === 'https:' ? 'wss:' : 'ws:'}//${location.host}/ws`) as Pipe,
  get: async (path, token) => {
    const reply = await fetch(path, token === undefined ? {} : { headers: { Authorization: `Bearer ${token}` } });
    if (!reply.ok) throw new Error(`status ${reply.status}`);
    return reply.json();
  },
  notices: () => [],
};

let current = network;

export const transport = (): Transport => current;

export function useTransport(other: Transport): void {
  current = other;
}
