// Enter a code to join.
import type { JSX } from 'preact';
import { useLayoutEffect, useRef, useState } from 'preact/hooks';
import { Heading } from '../parts/ui';
import type { ParticipantView } from '../protocol';
import { codeOfLink } from '../session';
import { hasText, t } from '../../shared/texts';

interface Reply {
  token?: string;
  full?: ParticipantView; // the page of somebody for whom there is no seat
  reason?: string;
  text?: string;
}

interface Props {
  onToken: (token: string) => void;
  onFull: (view: ParticipantView) => void;
  onReturn: (() => void) | null; // to the session that this tab has joined before
}

const kProblems: Record<string, string> = { 'no-room': 'unknown', started: 'started', 'too-many': 'busy' };
const kByStatus: Record<number, string> = { 404: 'unknown', 409: 'started', 429: 'busy' };

// What a recruitment platform has put into the link.
const queryOfLink = (): Record<string, string> =>
  Object.fromEntries([...new URLSearchParams(location.search)].filter(([name]) => name !== 'code'));

async function join(code: string): Promise<Reply> {
  const reply = await fetch('/api/join', {
    method: 'POST',
    headers: { 'Content-Type': 'application/json' },
    body: JSON.stringify({ code, query: queryOfLink() }),
  });
  const body = (await reply.json().catch(() => ({}))) as Reply;
  return reply.ok ? body : { reason: kProblems[body.reason ?? ''] ?? kByStatus[reply.status] ?? 'failed' };
}

export function Landing({ onToken, onFull, onReturn }: Props): JSX.Element {
  const [code, setCode] = useState(codeOfLink);
  const [problem, setProblem] = useState('');
  const [isJoining, setJoining] = useState(false);
  const field = useRef<HTMLInputElement>(null);
  const submit = (event: Event): void => {
    event.preventDefault();
    if (isJoining) return;
    const typed = code.trim().toUpperCase();
    if (typed === '') {
      setProblem('missing');
      field.current?.focus();
      return;
    }
    setProblem('');
    setJoining(true);
    join(typed)
      .then((reply) => {
        if (reply.token) onToken(reply.token);
        else if (reply.full) onFull(reply.full);
        else setProblem(reply.reason ?? 'failed');
      })
      .catch(() => setProblem('unreachable'))
      .finally(() => setJoining(false));
  };
  const why = `landing.${problem}`; // a reason of the server
  return (
    <>
      <Heading quiet>{t('landing.title')}</Heading>
      <form class="join" onSubmit={submit}>
        <label for="code">{t('landing.intro')}</label>
        <div class="buttons">
          <input
            id="code"
            ref={field}
            type="text"
            aria-describedby="join-problem"
            autocomplete="off"
            autocapitalize="characters"
            spellcheck={false}
            maxLength={40}
            value={code}
            onInput={(event) => setCode(event.currentTarget.value)}
          />
          <button type="submit" class="primary" aria-disabled={isJoining ? 'true' : undefined}>
            {t(isJoining ? 'landing.joining' : 'landing.join')}
          </button>
        </div>
        <p id="join-problem" role="alert" class="error">
          {problem && t(hasText(why) ? why : 'landing.failed')}
        </p>
      </form>
      {onReturn && (
        <div class="return">
          <p>{t('landing.return_text')}</p>
          <button type="button" class="plain" onClick={onReturn}>
            {t('landing.return')}
          </button>
        </div>
      )}
      <Licences />
    </>
  );
}

function Licences(): JSX.Element {
  const place = useRef<HTMLDivElement>(null);
  useLayoutEffect(() => {
    const notices = document.getElementById('kith-notices');
    if (notices instanceof HTMLTemplateElement) place.current?.replaceChildren(notices.content.cloneNode(true));
  }, []);
  return (
    <details class="licences">
      <summary>{t('landing.licences')}</summary>
      <div ref={place} />
    </details>
  );
}
