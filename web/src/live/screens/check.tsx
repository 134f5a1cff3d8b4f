// A board to try the keys and buttons on. Nothing here counts.
import type { JSX } from 'preact';
import { useState } from 'preact/hooks';
import { useDrive } from '../../shared/play/drive';
import { BoardAlone, Driver } from '../../shared/play/driver';
import { Job, useLegend } from '../../shared/play/board_pane';
import { Button, Heading, Paragraphs } from '../parts/ui';
import type { Update } from '../protocol';
import type { ScreenProps } from '../screen';
import { driveStore, keep, recall } from '../storage';
import { sentence, t } from '../../shared/texts';
import { plainWorld, type World } from '../../shared/play/world';
import { useWorld } from '../world';

const kLongestName = 80; // bytes, as the server counts
const kEnough = 4; // steps after which somebody knows how to drive
type Shown = NonNullable<ScreenProps['view']['check']>;

// Before the first board: what it is all about.
export function Check(props: ScreenProps & { check: Shown }): JSX.Element {
  const [isIntroduced, setIntroduced] = useState(() => recall<boolean>('introduced') === true);
  const [name, setName] = useState(() => recall<string>('name') ?? '');
  const { check, connection, view } = props;
  const { story, goal } = view.study;
  const isEmpty = story.length === 0 && !goal && !check.ask_name;
  if (isIntroduced || isEmpty) return <Controls {...props} />;
  const go = (event: Event): void => {
    event.preventDefault();
    if (name.trim() !== '') connection.send('name', { name: shortened(name.trim()) });
    keep('introduced', true);
    setIntroduced(true);
  };
  return (
    <form class="intro" onSubmit={go}>
      <Heading>{t('intro.title')}</Heading>
      <Paragraphs texts={story} />
      {view.study.update && <Paragraphs texts={updated(view.study.update)} />}
      <Job board={check.board} />
      {goal && <p class="goal">{goal}</p>}
      <p>{t('intro.how')}</p>
      {check.parts !== undefined && <p>{t('intro.duration', minutesOf(check.parts, check.most ?? Infinity))}</p>}
      {view.group.size > 1 && <p>{t('intro.group', { size: view.group.size })}</p>}
      {check.ask_name && (
        <div class="name">
          <label for="name">{t('person.label')}</label>
          <p id="name-help" class="muted">
            {t('person.help', { label: view.me.label })}
          </p>
          <input
            id="name"
            type="text"
            maxLength={kLongestName}
            autocomplete="off"
            aria-describedby="name-help"
            value={name}
            onInput={(event) => {
              setName(event.currentTarget.value);
              keep('name', event.currentTarget.value);
            }}
          />
        </div>
      )}
      <button type="submit" class="primary">
        {t('common.continue')}
      </button>
    </form>
  );
}

// What is new about a robot that people knew as it was, and what is not.
const updated = ({ now, still }: Update): string[] => [
  t(now.length > 0 ? 'intro.updated' : 'intro.not_changed'),
  ...now.map(sentence),
  ...(now.length > 0 && still.length > 0 ? [t('intro.as_before')] : []),
  ...still.map(sentence),
];

// A round takes about two minutes, and most parts take one to four of them.
const minutesOf = (parts: number, most: number): { least: number; most: number } => ({
  least: 2 * parts,
  most: 2 * Math.max(parts, Math.min(most, 4 * parts)),
});

function shortened(name: string): string {
  let text = name;
  while (new TextEncoder().encode(text).length > kLongestName) text = [...text].slice(0, -1).join('');
  return text;
}

function Controls(props: ScreenProps & { check: Shown }): JSX.Element {
  const { check, token } = props;
  const legend = useLegend(check.board.domain);
  const { world: fetched, hasTrouble } = useWorld(check.world, token);
  const [plain] = useState(() => (check.world === undefined ? plainWorld(check.board, legend) : null));
  const world = fetched ?? plain?.world ?? null;
  return (
    <>
      <Heading>{t('check.title')}</Heading>
      <p class="lead">{t('check.intro')}</p>
      {world ? (
        <Trying {...props} world={world} start={check.start ?? plain?.start ?? 0} legend={legend} />
      ) : (
        <BoardAlone board={check.board} legend={legend}>
          <p role="status">{t(hasTrouble ? 'common.loading_trouble' : 'common.loading')}</p>
        </BoardAlone>
      )}
    </>
  );
}

interface TryingProps extends ScreenProps {
  check: Shown;
  world: World;
  start: number;
  legend: ReturnType<typeof useLegend>;
}

function Trying({ check, world, start, legend, connection }: TryingProps): JSX.Element {
  const drive = useDrive({ world, start, draft: [], key: `check.${check.world ?? ''}.${start}`, store: driveStore });
  const [wasReady, setReady] = useState(false);
  const isReady = wasReady || drive.isAtEnd || drive.actions.length >= kEnough;
  if (isReady && !wasReady) setReady(true);
  const off = connection.isPending('checked');
  return (
    <Driver
      board={check.board}
      legend={legend}
      world={world}
      drive={drive}
      off={off}
      end={t('check.end')}
      stopped={t('check.stopped')}
    >
      <div class="submit">
        <Button primary off={!isReady || off} describedBy="check-hint" onClick={() => connection.send('checked', {})}>
          {t('check.done')}
        </Button>
        <p id="check-hint" class="muted" role="status">
          {t(isReady ? 'check.ready' : 'check.hint')}
        </p>
      </div>
    </Driver>
  );
}
