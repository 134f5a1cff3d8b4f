// Enter a code to join.
import type { JSX } from 'preact';
import { useRef, useState } from 'preact/hooks';
import { Licences } from '../../shared/edges';
import { Heading } from '../parts/ui';
import type { ParticipantView } from '../protocol';
import { codeOfLink, joinedHere, rememberJoining } from '../session';
import { keep } from '../storage';
import { hasText, t } from '../../shared/texts';

interface Reply {
  token?: string;
  full?: ParticipantView; // the page of somebody for whom there is no seat
  ask?: boolean; // whether they are one of those who joined from this browser
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

async function join(code: string, isAnother: boolean): Promise<Reply> {
  const reply = await fetch('/api/join', {
    method: 'POST',
    headers: { 'Content-Type': 'application/json' },
    body: JSON.stringify({ code, query: queryOfLink(), has_joined: !isAnother && joinedHere().length > 0 }),
  });
  const body = (await reply.json().catch(() => ({}))) as Reply;
  return reply.ok ? body : { reason: kProblems[body.reason ?? ''] ?? kByStatus[reply.status] ?? 'failed' };
}

export function Landing({ onToken, onFull, onReturn }: Props): JSX.Element {
  const [code, setCode] = useState(codeOfLink);
  const [problem, setProblem] = useState('');
  const [isJoining, setJoining] = useState(false);
  const [isAsked, setAsked] = useState(false);
  const field = useRef<HTMLInputElement>(null);
  const submit = (event: Event): void => {
    event.preventDefault();
    enter(false);
  };
  const enter = (isAnother: boolean): void => {
    if (isJoining) return;
    const typed = code.trim().toUpperCase();
    if (typed === '') {
      setProblem('missing');
      field.current?.focus();
      return;
    }
    setProblem('');
    setJoining(true);
    join(typed, isAnother)
      .then((reply) => {
        if (reply.token) {
          rememberJoining(reply.token);
          const query = queryOfLink();
          onToken(reply.token);
          keep('query', query); // the consent says it again, should the server be stopped until then
        } else if (reply.ask) setAsked(true);
        else if (reply.full) onFull(reply.full);
        else setProblem(reply.reason ?? 'failed');
      })
      .catch(() => setProblem('unreachable'))
      .finally(() => setJoining(false));
  };
  if (isAsked) return <WhoAreYou onReturn={onToken} onAnother={() => enter(true)} />;
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
      <Licences summary={t('landing.licences')} />
    </>
  );
}

// Several people may share a computer, so nobody is taken for somebody else without being asked.
function WhoAreYou({ onReturn, onAnother }: { onReturn: (token: string) => void; onAnother: () => void }): JSX.Element {
  const before = joinedHere();
  return (
    <>
      <Heading>{t('landing.again.title')}</Heading>
      <p class="lead">{t('landing.again.text')}</p>
      <div class="buttons">
        {before.map(({ token, at }) => (
          <button type="button" class="primary" key={token} onClick={() => onReturn(token)}>
            {before.length === 1 ? t('landing.again.continue') : t('landing.again.continue_at', { time: clockTime(at) })}
          </button>
        ))}
        <button type="button" class="plain" onClick={onAnother}>
          {t('landing.again.another')}
        </button>
      </div>
    </>
  );
}

const clockTime = (at: number): string => new Date(at).toLocaleTimeString([], { hour: '2-digit', minute: '2-digit' });
