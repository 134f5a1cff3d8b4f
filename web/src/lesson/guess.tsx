// Where the reader says what the robot will do: by driving it or, where nobody can, by its first move.
import type { JSX } from 'preact';
import { useLayoutEffect, useState } from 'preact/hooks';
import { kMoves } from '../shared/board/geometry';
import type { Intent } from '../shared/board/board';
import type { Frame, Path } from '../shared/board/types';
import { BoardPane, Things } from '../shared/play/board_pane';
import { BoardAlone, Driver } from '../shared/play/driver';
import { useDrive } from '../shared/play/drive';
import { Button } from '../shared/play/button';
import { actionOfArrow, isElsewhere } from '../shared/play/keys';
import { Pad } from '../shared/play/pad';
import { StateCard } from '../shared/play/steps';
import { actionLabel, capitalised, t } from '../shared/texts';
import { SmallBoard } from '../shared/play/small_board';
import { countsOf, Ledger } from '../shared/play/ledger';
import { playBoard, type Context, type Guess } from './context';
import type { Driven } from './document';

interface Props extends Context {
  shown: Driven & { runs: unknown; alternative?: Path | null };
  isChoice: boolean;
  submit: string;
  skip: string;
  onGuess: (guess: Guess) => void;
}

export function Guessing({ shown, isChoice, submit, skip, onGuess, domain, legend, worlds }: Props): JSX.Element {
  const board = playBoard(domain, shown);
  const asked = worlds.asked(shown);
  const world = asked === 'nothing' ? null : worlds.world(shown.world);
  const skipped = <Button onClick={() => onGuess({ mine: null, verdict: null })}>{skip}</Button>;
  if (!world) {
    return (
      <BoardAlone board={board} legend={legend}>
        <div class="submit">{skipped}</div>
      </BoardAlone>
    );
  }
  const paths = isChoice ? worlds.choice(shown) : null;
  if (paths) return <Choosing {...{ shown, paths, board, legend, worlds, onGuess }} />;
  const View = asked === 'path' ? Driving : Moving;
  return <View {...{ shown, submit, onGuess, domain, legend, worlds, board, world, skipped }} />;
}

type DrivingProps = Pick<Props, 'shown' | 'submit' | 'onGuess' | 'legend' | 'worlds'> & {
  board: ReturnType<typeof playBoard>;
  world: NonNullable<ReturnType<Context['worlds']['world']>>;
  skipped: JSX.Element;
};

// What is to be said to somebody who is about to guess.
export function askingText({ worlds }: Context, shown: Driven & { runs: unknown }): string {
  const asked = worlds.asked(shown);
  if (asked === 'path') return shown.map ? 'Where will the robot go?' : 'What will the robot do?';
  if (asked === 'nothing') return 'What will the robot do? Decide first, then look.';
  return shown.runs ? 'What will the robot try to do first?' : 'What will the robot do first?';
}

type ChoosingProps = Pick<DrivingProps, 'shown' | 'board' | 'legend' | 'worlds' | 'onGuess'> & { paths: [Path, Path] };

const kLetters = ['A', 'B'];

// One of two paths, with what each counts.
function Choosing({ shown, paths, board, legend, worlds, onGuess }: ChoosingProps): JSX.Element {
  return (
    <div class="choices">
      <ul class="lines">
        {paths.map((path, i) => (
          <li>
            {shown.runs && board.map ? (
              <BoardPane board={board} legend={legend} frames={[board.start]} step={0} trail="other" isSmall intents={intentsOf(board.start, path.frames[0]?.action)} />
            ) : (
              <SmallBoard board={board} legend={legend} path={path} kind="plain" />
            )}
            <Button onClick={() => onGuess({ mine: path, verdict: worlds.judgeFrames(shown, path) })}>
              {shown.runs ? capitalised(actionLabel(path.frames[0]?.action ?? '')) : `Path ${kLetters[i]}`}
            </Button>
          </li>
        ))}
      </ul>
      {!shown.runs && <Ledger board={board} columns={paths.map(({ frames }, i) => ({ name: kLetters[i] ?? '', kind: 'plain', counts: countsOf(frames) }))} />}
    </div>
  );
}

const intentsOf = ({ robot }: Frame, action: string | null | undefined): Intent[] =>
  robot && action && kMoves[action] ? [{ cell: robot, action, kind: 'other' }] : [];

// The first move only.
function Moving({ shown, submit, onGuess, legend, worlds, board, world, skipped }: DrivingProps): JSX.Element {
  const [chosen, setChosen] = useState<number | null>(null);
  const name = world.actions[chosen ?? -1]?.name ?? '';
  useLayoutEffect(() => {
    const pressed = (event: KeyboardEvent): void => {
      if (isElsewhere(event) || event.altKey || event.ctrlKey || event.metaKey || event.shiftKey) return;
      const action = actionOfArrow(world.actions, event.key);
      if (action === undefined || world.after(shown.state, action) === null) return;
      event.preventDefault(); // the page must not scroll
      setChosen(action);
    };
    document.addEventListener('keydown', pressed);
    return () => document.removeEventListener('keydown', pressed);
  }, []);
  const done = (): void => {
    if (chosen === null) return;
    const states = world.walk(shown.state, [chosen]);
    onGuess({ mine: { frames: world.frames(states, [chosen]) }, verdict: worlds.judgeMove(shown, chosen) });
  };
  return (
    <div class="board-screen">
      <div class="board-column">
        {board.map ? <BoardPane board={board} legend={legend} frames={[board.start]} step={0} trail="other" beginsWhole intents={intentsOf(board.start, name)} /> : <StateCard frame={board.start} />}
        {board.map && <Things board={board} legend={legend} lines={[]} walked={[]} />}
      </div>
      <div class="side">
        <div class="act-bar driving">
          <Pad actions={world.actions} off={false} canDo={(action) => world.after(shown.state, action) !== null} onAction={setChosen} />
          <div class="submit">
            <div class="buttons">
              <Button primary={chosen !== null} off={chosen === null} onClick={done}>
                {submit}
              </Button>
              {skipped}
            </div>
            <p class="muted" role="status">
              {chosen === null ? 'Choose its first move.' : `Your choice: ${capitalised(actionLabel(name))}.`}
            </p>
          </div>
        </div>
      </div>
    </div>
  );
}

function Driving({ shown, submit, onGuess, legend, worlds, board, world, skipped }: DrivingProps): JSX.Element {
  const drive = useDrive({ world, start: shown.state, draft: [], key: '' });
  const [endless, setEndless] = useState<number[] | null>(null); // the path that is said to go on for ever
  const isForEver = endless === drive.actions && drive.repeatsFrom !== null;
  const isWhole = drive.isAtEnd || isForEver;
  const done = (): void => {
    const repeats = isForEver && drive.repeatsFrom !== null ? { repeats_from: drive.repeatsFrom } : {};
    onGuess({
      mine: { frames: drive.frames, ...repeats },
      verdict: worlds.judge(shown, drive.actions, repeats.repeats_from ?? null),
    });
  };
  return (
    <Driver
      board={board}
      legend={legend}
      world={world}
      drive={drive}
      off={false}
      end={t('check.end')}
      stopped={t('check.stopped')}
      isForEver={isForEver}
    >
      {drive.repeatsFrom !== null && (
        <div class="for-ever">
          <Button pressed={isForEver} onClick={() => setEndless(isForEver ? null : drive.actions)}>
            {t('predict.for_ever')}
          </Button>
        </div>
      )}
      <div class="submit">
        <div class="buttons">
          <Button primary={isWhole} off={!isWhole} onClick={done}>
            {submit}
          </Button>
          {skipped}
        </div>
        <p class="muted" role="status">
          {isWhole ? t('predict.steps', { n: drive.actions.length }) : 'Move the robot until its job is done.'}
        </p>
      </div>
    </Driver>
  );
}
