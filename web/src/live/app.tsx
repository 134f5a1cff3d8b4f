// The page is a function of the last view of the server and of what somebody is doing on it now.
import { Component, type ComponentChildren, type JSX } from 'preact';
import { useLayoutEffect, useState } from 'preact/hooks';
import { duration } from '../shared/duration';
import { enterGoesOn } from '../shared/play/keys';
import type { SocketState } from '../shared/reconnecting_socket';
import { useTick } from './clock';
import { Connection, type Snapshot } from './connection';
import { Bare, Shell } from './parts/shell';
import { Button, Heading } from './parts/ui';
import { setStudyTitle } from './parts/title';
import type { ParticipantView } from './protocol';
import type { ScreenProps } from './screen';
import { Check } from './screens/check';
import { Debrief, Ended } from './screens/closing';
import { Consent } from './screens/consent';
import { Discuss } from './screens/discuss';
import { Feedback } from './screens/feedback';
import { Landing } from './screens/landing';
import { Lobby } from './screens/lobby';
import { Predict } from './screens/predict';
import { Questions } from './screens/questions';
import { Wait } from './screens/wait';
import { Watch } from './screens/watch';
import { becomeParticipant, codeOfLink, forgetParticipant, knownToken } from './session';
import { currentLanguage, loadTexts, t } from '../shared/texts';

export function App(): JSX.Element {
  const [known] = useState(knownToken);
  const isInvited = !known.isOfLink && (location.pathname === '/' || codeOfLink() !== '');
  const [token, setToken] = useState(isInvited ? null : known.token);
  const [full, setFull] = useState<ParticipantView | null>(null);
  const join = (fresh: string): void => {
    becomeParticipant(fresh);
    setToken(fresh);
  };
  const leave = (): void => {
    forgetParticipant();
    setToken(null);
  };
  useLayoutEffect(enterGoesOn, []);
  // Another link opened in this tab is another person.
  useLayoutEffect(() => {
    const changed = (): void => location.reload();
    window.addEventListener('hashchange', changed);
    return () => window.removeEventListener('hashchange', changed);
  }, []);
  if (full) {
    return (
      <Bare>
        <Ended view={full} stage="full" isSaved />
      </Bare>
    );
  }
  if (token) return <Joined key={token} token={token} onLeave={leave} />;
  const stored = known.token;
  return (
    <Bare>
      <Landing onToken={join} onFull={setFull} onReturn={stored ? () => join(stored) : null} />
    </Bare>
  );
}

function useConnection(token: string): { connection: Connection; snapshot: Snapshot } {
  const [connection] = useState(
    () =>
      new Connection(token, () => {
        location.replace(`/f#t=${encodeURIComponent(token)}`); // a facilitator's or observer's link
      }),
  );
  const [snapshot, setSnapshot] = useState(connection.snapshot());
  useLayoutEffect(() => connection.subscribe(() => setSnapshot(connection.snapshot())), [connection]);
  return { connection, snapshot };
}

function Joined({ token, onLeave }: { token: string; onLeave: () => void }): JSX.Element {
  const { connection, snapshot } = useConnection(token);
  const { view, socket } = snapshot;
  useLanguage(view?.lang);
  if (socket.phase === 'closed') {
    return (
      <Bare>
        <Closed reason={socket.bye ?? 'removed'} connection={connection} onLeave={onLeave} />
      </Bare>
    );
  }
  if (!view) {
    return (
      <Bare>
        <Connecting snapshot={snapshot} />
      </Bare>
    );
  }
  setStudyTitle(view.study.title);
  const shown = screenOf({ view, connection, token });
  return (
    <Shell connection={connection} snapshot={snapshot} view={view}>
      <Guard key={shown.key}>{shown.screen}</Guard>
    </Shell>
  );
}

// The language of the study, if this page did not know it before.
function useLanguage(lang: string | undefined): void {
  const [, setCount] = useState(0);
  useLayoutEffect(() => {
    if (lang !== undefined && lang !== currentLanguage()) void loadTexts(lang).then(() => setCount((count) => count + 1));
  }, [lang]);
}

// Screens of the same kind are new ones if they show something else.
function screenKey(view: ParticipantView): string {
  const { stage, progress, watch, predict, discuss, wait } = view;
  const index = { watch: watch?.index, predict: predict?.index, discuss: discuss?.index, screening: predict?.index, exam: predict?.index, wait: wait?.for }[stage as 'watch'];
  return [stage, progress?.part, progress?.round, index].join('.');
}

function screenOf(props: ScreenProps): { key: string; screen: JSX.Element } {
  const { view, connection } = props;
  const isSaved = connection.snapshot().pending.length === 0;
  const key = screenKey(view);
  return { key, screen: screenFor(props, isSaved) ?? <Unknown /> };
}

function screenFor(props: ScreenProps, isSaved: boolean): JSX.Element | null {
  const { view } = props;
  const { consent, check, lobby, watch, predict, discuss, wait, feedback, questions, debrief } = view;
  switch (view.stage) {
    case 'consent':
      return consent ? <Consent {...props} consent={consent} /> : null;
    case 'check':
      return check ? <Check {...props} check={check} /> : null;
    case 'screening':
      return predict ? <Predict {...props} task={predict} kind="screening" /> : null;
    case 'lobby':
      return lobby ? <Lobby {...props} lobby={lobby} /> : null;
    case 'watch':
      return watch ? <Watch {...props} watch={watch} /> : null;
    case 'predict':
      return predict ? <Predict {...props} task={predict} kind="predict" /> : null;
    case 'exam':
      return predict ? <Predict {...props} task={predict} kind="exam" /> : null;
    case 'discuss':
      return discuss ? <Discuss {...props} discuss={discuss} /> : null;
    case 'wait':
      return wait ? <Wait {...props} wait={wait} /> : null;
    case 'feedback':
      return feedback ? <Feedback {...props} feedback={feedback} /> : null;
    case 'questions':
      return questions ? <Questions {...props} items={questions.items} /> : null;
    case 'debrief':
      return debrief ? <Debrief {...props} debrief={debrief} isSaved={isSaved} /> : null;
    case 'declined':
    case 'full':
    case 'ended':
    case 'replaced':
      return <Ended view={view} stage={view.stage} isSaved={isSaved} />;
  }
  return unknown(view.stage);
}

// A server that is newer than this page; a stage that this page knows has its screen above.
const unknown = (_: never): null => null;

function Connecting({ snapshot }: { snapshot: Snapshot }): JSX.Element {
  useTick();
  const [begun] = useState(() => performance.now());
  const time = performance.now() - begun;
  const isLong = time > 5000 && snapshot.view === null;
  return (
    <>
      <Heading quiet>{t('connecting.title')}</Heading>
      <p role="status">{t(isLong ? 'connecting.long' : 'connecting.text', { time: duration(time) })}</p>
      {isLong && <Button onClick={() => location.reload()}>{t('trouble.reload')}</Button>}
    </>
  );
}

interface ClosedProps {
  reason: NonNullable<SocketState['bye']>;
  connection: Connection;
  onLeave: () => void;
}

function Closed({ reason, connection, onLeave }: ClosedProps): JSX.Element {
  return (
    <>
      <Heading key={reason}>{t(`bye.${reason}.title`)}</Heading>
      <p class="lead">{t(`bye.${reason}.text`)}</p>
      <Button primary onClick={() => (reason === 'bad-token' ? onLeave() : connection.reopen())}>
        {t(`bye.${reason}.button`)}
      </Button>
    </>
  );
}

function Unknown(): JSX.Element {
  return (
    <>
      <Heading>{t('trouble.title')}</Heading>
      <p>{t('trouble.unknown')}</p>
      <Button primary onClick={() => location.reload()}>
        {t('trouble.reload')}
      </Button>
    </>
  );
}

// A mistake of ours shows what to do instead of a blank page.
class Guard extends Component<{ children: ComponentChildren }, { failed: boolean }> {
  override state = { failed: false };

  override componentDidCatch(error: unknown): void {
    this.setState({ failed: true });
    console.error(error);
  }

  override render(): ComponentChildren {
    if (!this.state.failed) return this.props.children;
    return (
      <>
        <Heading>{t('trouble.title')}</Heading>
        <p>{t('trouble.text')}</p>
        <Button primary onClick={() => location.reload()}>
          {t('trouble.reload')}
        </Button>
      </>
    );
  }
}
