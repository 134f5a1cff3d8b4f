// Where the reader says what the robot will do, by driving it.
import type { JSX } from 'preact';
import { useState } from 'preact/hooks';
import type { Path } from '../shared/board/types';
import { Driver } from '../shared/play/driver';
import { useDrive } from '../shared/play/drive';
import { Button } from '../shared/play/button';
import { t } from '../shared/texts';
import { playBoard, type Context } from './context';
import type { Driven } from './document';
import type { Verdict } from './judge';

export interface Guess {
  mine: Path | null; // nothing: not asked for
  verdict: Verdict | null;
}

interface Props extends Context {
  shown: Driven;
  submit: string;
  skip: string;
  onGuess: (guess: Guess) => void;
}

export function Guessing({ shown, submit, skip, onGuess, domain, legend, worlds }: Props): JSX.Element {
  const board = playBoard(domain, shown);
  const world = worlds.canBeAnswered(shown) ? worlds.world(shown.world) : null;
  const skipped = <Button onClick={() => onGuess({ mine: null, verdict: null })}>{skip}</Button>;
  if (!world) {
    return (
      <Driver board={board} legend={legend} world={null} drive={null} off end="" stopped="" waiting={<div class="submit">{skipped}</div>}>
        {null}
      </Driver>
    );
  }
  return <Driving {...{ shown, submit, onGuess, domain, legend, worlds, board, world, skipped }} />;
}

type DrivingProps = Pick<Props, 'shown' | 'submit' | 'onGuess' | 'legend' | 'worlds'> & {
  board: ReturnType<typeof playBoard>;
  world: NonNullable<ReturnType<Context['worlds']['world']>>;
  skipped: JSX.Element;
};

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
      waiting={null}
      end={t('check.end')}
      stopped={t('check.stopped')}
      isForEver={isForEver}
      isOneOfMany
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
