// What is shown before there is anything to show, or when there is nothing any more.
import type { JSX } from 'preact';
import { useState } from 'preact/hooks';
import type { SocketState } from '../shared/reconnecting_socket';
import { forgetToken, tokenIn } from './session';

export function NoServer({ socket, onRetry }: { socket: SocketState; onRetry: () => void }): JSX.Element {
  const isRetrying = socket.phase === 'lost';
  return (
    <main id="main" class="plain-page" tabIndex={-1}>
      <h1>{isRetrying ? 'The server cannot be reached' : 'Connecting'}</h1>
      <p role="status">
        {isRetrying
          ? 'This page keeps trying. Check that kith serve is running and that this computer is on the same network.'
          : 'Connecting to the server.'}
      </p>
      {isRetrying && (
        <button type="button" onClick={onRetry}>
          Try now
        </button>
      )}
    </main>
  );
}

const kDismissals: Record<string, { title: string; text: string }> = {
  'bad-token': {
    title: 'This link is not valid',
    text: 'It has expired, was revoked, or was copied incompletely. kith serve prints the facilitator link when it starts.',
  },
  removed: { title: 'This link was revoked', text: 'Another facilitator revoked it. Ask for a new one.' },
  'no-view': {
    title: 'This page cannot be shown',
    text: 'An error on the server ended this page. The groups go on without it. Reload it to try again.',
  },
  'opened-elsewhere': {
    title: 'Opened elsewhere',
    text: 'This page was opened with the same link in another tab or on another computer. Only one of them is connected.',
  },
};

export function Dismissed({ reason }: { reason: SocketState['bye'] }): JSX.Element {
  const { title, text } = kDismissals[reason ?? ''] ?? { title: 'Disconnected', text: `The server closed the connection (${reason}).` };
  return (
    <main id="main" class="plain-page" tabIndex={-1}>
      <h1>{title}</h1>
      <p>{text}</p>
      {reason === 'opened-elsewhere' || reason === 'no-view' ? (
        <button type="button" class="primary" onClick={() => window.location.reload()}>
          {reason === 'no-view' ? 'Reload' : 'Use it here'}
        </button>
      ) : (
        <AskLink />
      )}
    </main>
  );
}

export function NoToken(): JSX.Element {
  return (
    <main id="main" class="plain-page" tabIndex={-1}>
      <h1>Facilitator page</h1>
      <p>This page needs a facilitator or observer link. kith serve prints it when it starts.</p>
      <AskLink />
    </main>
  );
}

function AskLink(): JSX.Element {
  const [text, setText] = useState('');
  const [problem, setProblem] = useState('');
  const submit = (event: Event): void => {
    event.preventDefault();
    const token = tokenIn(text);
    if (!token) {
      setProblem('This is not a link printed by kith serve. Such a link contains #t= followed by a long token.');
      return;
    }
    forgetToken();
    window.location.hash = `t=${token}`;
    window.location.reload();
  };
  return (
    <form class="ask" onSubmit={submit}>
      <label for="ask-link">Paste the link here</label>
      <div class="link-row">
        <input id="ask-link" type="text" autocomplete="off" value={text} onInput={(event) => setText(event.currentTarget.value)} />
        <button type="submit" class="primary">
          Open
        </button>
      </div>
      <p class="problem" role="alert">
        {problem}
      </p>
    </form>
  );
}
