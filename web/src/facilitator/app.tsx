// The page around the tabs: header, state of the connection, dialogs.
import type { JSX } from 'preact';
import { useEffect, useRef, useState } from 'preact/hooks';
import { announce } from '../shared/dom';
import type { SocketState } from '../shared/reconnecting_socket';
import { ThemeToggle } from '../shared/edges';
import { Api } from './api';
import { duration } from '../shared/duration';
import { ClockOffset, useNow } from './clock';
import { Connection } from './connection';
import type { Action } from './controls/actions';
import { ActionDialog } from './controls/action_dialog';
import { Data, problemsOf } from './data';
import { Room } from './live/room';
import { LogPage } from './log';
import type { FacilitatorView } from './protocol';
import { Rooms } from './rooms';
import { remember, remembered } from './session';
import { ApiContext } from './setup/link_box';
import { Setup } from './setup/setup';
import { Tips } from './tip';
import { Dismissed, NoServer } from './welcome';
import { roomTitle } from './words';

const kTabs = [
  { id: 'setup', label: 'Set-up' },
  { id: 'rooms', label: 'Rooms' },
  { id: 'data', label: 'Data' },
  { id: 'log', label: 'Log' },
] as const;
type Tab = (typeof kTabs)[number]['id'];

interface Received {
  view: FacilitatorView;
  offset: number; // of the server's clock to ours, ms
}

export function App({ token }: { token: string }): JSX.Element {
  const [socket, setSocket] = useState<SocketState>({ phase: 'connecting', since: 0, bye: null });
  const [received, setReceived] = useState<Received | null>(null);
  const connection = useRef<Connection | null>(null);
  const [api] = useState(() => new Api(token));
  useEffect(() => {
    const made = new Connection(token, {
      socket: setSocket,
      view: (view) =>
        setReceived((before) => ({
          view: { ...view, rooms: view.rooms ?? before?.view.rooms ?? [] }, // the list is not always sent again
          offset: view.server_ms - Date.now(),
        })),
      welcome: () => {
        const room = remembered('room');
        if (room) void made.send('room-select', { room, reason: '' }).catch(() => undefined);
      },
    });
    connection.current = made;
  }, []);
  const send = (command: string, body: object): Promise<void> =>
    connection.current?.send(command, body) ?? Promise.reject(new Error('not connected'));

  if (socket.phase === 'closed') return <Dismissed reason={socket.bye} />;
  if (!received) return <NoServer socket={socket} onRetry={() => connection.current?.retry()} />;
  return (
    <ClockOffset.Provider value={received.offset}>
      <ApiContext.Provider value={api}>
        <Shell view={received.view} socket={socket} send={send} onRetry={() => connection.current?.retry()} />
      </ApiContext.Provider>
    </ClockOffset.Provider>
  );
}

interface ShellProps {
  view: FacilitatorView;
  socket: SocketState;
  send: (command: string, body: object) => Promise<void>;
  onRetry: () => void;
}

function firstTab({ role, rooms }: FacilitatorView): Tab {
  const kept = kTabs.find(({ id }) => id === remembered('tab'));
  return kept?.id ?? (rooms.length === 0 && role === 'facilitator' ? 'setup' : 'rooms');
}

function Shell({ view, socket, send, onRetry }: ShellProps): JSX.Element {
  const [tab, setTab] = useState<Tab>(() => firstTab(view));
  const [selected, setSelected] = useState(remembered('room') ?? '');
  const [asked, setAsked] = useState<{ action: Action; room: string } | null>(null);
  const isFacilitator = view.role === 'facilitator';
  const mayAct = isFacilitator && socket.phase === 'open';
  const go = (to: Tab): void => {
    remember('tab', to);
    setTab(to);
  };
  const select = (room: string): void => {
    remember('room', room);
    setSelected(room);
    if (room !== '') void send('room-select', { room, reason: '' }).catch(() => undefined);
  };
  useEffect(() => {
    // The only room, or the only one that is being taught.
    const running = view.rooms.filter(({ stage }) => stage === 'running' || stage === 'paused');
    const [only, another] = view.rooms.length === 1 ? view.rooms : running;
    if (only && !another && remembered('room') === null) select(only.id);
  }, [view.rooms]);
  const room = view.rooms.find(({ id }) => id === selected);
  useEffect(() => {
    const place = tab === 'rooms' && room ? roomTitle(room) : kTabs.find(({ id }) => id === tab)?.label;
    document.title = `${place} - ${view.study.title}`;
  }, [tab, room?.id, view.study.title]);
  return (
    <>
      <header class="top">
        <h1>{view.study.title}</h1>
        <nav aria-label="Parts of this page">
          {kTabs.map(({ id, label }) => (
            <button
              type="button"
              aria-current={tab === id ? 'page' : undefined}
              onClick={() => {
                if (id === 'rooms') select('');
                go(id);
              }}
            >
              {label}
            </button>
          ))}
        </nav>
        <span class="top-end">
          {!isFacilitator && <span class="badge observer">Observer</span>}
          <ConnectionMark socket={socket} />
          <ThemeToggle />
        </span>
      </header>
      <Banners view={view} socket={socket} onRetry={onRetry} onData={() => go('data')} />
      <main id="main" tabIndex={-1}>
        {tab === 'setup' && <Setup view={view} mayAct={mayAct} send={send} />}
        {tab === 'rooms' && !room && <Rooms view={view} onOpen={select} />}
        {tab === 'rooms' && room && (
          <Room view={view} room={room} mayAct={mayAct} onSelect={select} onAct={(action) => setAsked({ action, room: room.id })} />
        )}
        {tab === 'data' && <Data view={view} />}
        {tab === 'log' && <LogPage view={view} />}
      </main>
      {asked && (
        <ActionDialog
          action={asked.action}
          send={(command, body) => send(command, { room: asked.room, ...body })}
          onClose={(done) => {
            setAsked(null);
            if (done) announce(done);
          }}
        />
      )}
      <Tips />
    </>
  );
}

function ConnectionMark({ socket }: { socket: SocketState }): JSX.Element {
  const isLive = socket.phase === 'open';
  return (
    <span class={isLive ? 'link-mark is-live' : 'link-mark is-lost'} role="status">
      <svg width="10" height="10" viewBox="-5 -5 10 10" aria-hidden="true">
        {isLive ? <circle r={4} /> : <path d="M-4 -4 4 4M4 -4-4 4" />}
      </svg>
      {isLive ? 'Connected' : 'Not connected'}
    </span>
  );
}

interface BannersProps {
  view: FacilitatorView;
  socket: SocketState;
  onRetry: () => void;
  onData: () => void;
}

function Banners({ view, socket, onRetry, onData }: BannersProps): JSX.Element {
  const now = useNow();
  const problems = problemsOf(view.integrity, now);
  return (
    <>
      {socket.phase === 'lost' && (
        <div class="banner" role="alert">
          <span>
            {socket.bye === 'server-stops'
              ? 'The server has stopped. This page reconnects when the server restarts.'
              : 'The connection to the server was lost. Trying to reconnect.'}{' '}
            Until then, this page shows the last known state.
          </span>
          <Elapsed since={socket.since} />
          <button type="button" onClick={onRetry}>
            Try now
          </button>
        </div>
      )}
      {problems.length > 0 && (
        <div class="banner" role="alert">
          <span>{problems[0]}</span>
          {problems.length > 1 && <span>{`and ${problems.length - 1} more`}</span>}
          <button type="button" onClick={onData}>
            Show
          </button>
        </div>
      )}
    </>
  );
}

// Since a moment on the clock of performance.now().
function Elapsed({ since }: { since: number }): JSX.Element {
  useNow();
  return <span class="elapsed" aria-hidden="true">{duration(performance.now() - since)}</span>;
}
