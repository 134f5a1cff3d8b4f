// A robot that somebody drives: board, keys, clicks, pad, undo and reset. Used for predictions and for practice.
import type { ComponentChildren, JSX } from 'preact';
import { useLayoutEffect, useRef } from 'preact/hooks';
import type { Legend } from '../board/legend';
import type { Frame, Place, PlayBoard } from '../board/types';
import type { Drive, Outcome } from './drive';
import { actionOfArrow, isArrow, isElsewhere, isPressing } from './keys';
import { t } from '../texts';
import { aroundText, isJobDone, stepText } from './words';
import type { World } from './world';
import { BoardInWords, BoardPane, Things } from './board_pane';
import { countsOf, Ledger } from './ledger';
import { LogView, useLog, type Log } from './log';
import { Pad } from './pad';
import { StateCard, StepList } from './steps';
import { Button } from './button';

const kSoon = 5; // moves that are left when the page begins to say so
const kRepeatMs = 140; // between steps while a key is held down

interface Props {
  board: PlayBoard;
  legend: Legend;
  world: World;
  drive: Drive;
  off: boolean;
  end: string; // what is said when the robot has finished
  stopped: string; // when it has come to an end elsewhere
  isForEver?: boolean; // the path is said to go on like this for ever
  children: ComponentChildren; // below the pad
}

// While the world is being fetched, only the board is there.
export function BoardAlone({ board, legend, children }: { board: PlayBoard; legend: Legend; children: ComponentChildren }): JSX.Element {
  return (
    <div class="board-screen">
      <div class="board-column">
        {board.map ? (
          <BoardPane board={board} legend={legend} frames={[board.start]} step={0} trail="other" beginsWhole />
        ) : (
          <StateCard frame={board.start} />
        )}
      </div>
      <div class="side">{children}</div>
    </div>
  );
}

export function Driver({ board, legend, world, drive, off, isForEver, children, ...said }: Props): JSX.Element {
  const log = useLog(drive.actions.length === 0 ? t('predict.start') : lastStep(board, legend, drive.frames));
  const end = isJobDone(board, legend, drive.frames.at(-1)) ? said.end : said.stopped;
  const tell = useTelling({ board, legend, drive, log, end });
  const handles = world.actions.some(({ index }) => world.isHandling(index));
  const area = useRef<HTMLDivElement>(null);
  useKeys({ world, drive, off, tell, area });
  const frame = drive.frames.at(-1) ?? board.start;
  return (
    <div class="board-screen">
      <div class="board-column">
        {board.map ? (
          <div class="drive-area" role="application" aria-label={t('predict.board')} tabIndex={0} ref={area}>
            <BoardPane
              board={board}
              legend={legend}
              frames={drive.frames}
              step={drive.actions.length}
              trail="other"
              beginsWhole
              closedAt={isForEver ? drive.actions.length : undefined}
              onCell={(cell) => {
                if (!off) tell(clicked(world, drive, cell));
              }}
            />
          </div>
        ) : (
          <StateCard frame={frame} />
        )}
        <LogView log={log} />
        {board.map && <Things board={board} legend={legend} lines={['other']} walked={drive.frames} />}
      </div>
      <div class="side">
        <Ledger board={board} columns={[{ name: t('ledger.you'), kind: 'other', counts: countsOf(drive.frames) }]} />
        {drive.frames.some(({ action, counts }) => (action === 'pickup' || action === 'dropoff') && counts?.some((n) => n > 0)) && <p class="muted">{t('ledger.handling')}</p>}
        <div class="act-bar driving">
          <Pad
            actions={world.actions}
            off={off}
            canDo={(action) => world.after(drive.state, action) !== null}
            onAction={(action) => tell(drive.act(action))}
          />
          <div class="buttons">
            <Button
              class="undo"
              off={off || drive.actions.length === 0}
              onClick={drive.undo}
            >
              <svg class="icon" viewBox="0 0 24 24" aria-hidden="true" focusable="false">
                <path d="M9 4 3 9.5 9 15V11h5.5a3.5 3.5 0 0 1 0 7H8v2.5h6.5a6 6 0 0 0 0-12H9z" />
              </svg>
              <span>{t('predict.undo')}</span>
            </Button>
            <Button off={off || drive.actions.length === 0} class="reset" onClick={drive.reset}>
              {t('predict.reset')}
            </Button>
          </div>
          <p class="limit" role="status">
            {drive.left > kSoon ? '' : t(drive.left > 0 ? 'predict.left' : 'predict.longest', { n: drive.left })}
          </p>
          {children}
        </div>
        {board.map ? (
          <>
            <p class="muted hint for-keys">{t(handles ? 'predict.keys_things' : 'predict.keys')}</p>
            <p class="muted hint for-touch">{t(handles ? 'predict.touch_things' : 'predict.touch')}</p>
            <p class="visually-hidden">{aroundText(board, legend, frame)}</p>
            <BoardInWords board={board} legend={legend} frame={frame} />
          </>
        ) : (
          <StepList title={t('predict.path')} frames={drive.frames} />
        )}
      </div>
    </div>
  );
}

function lastStep(board: PlayBoard, legend: Legend, frames: Frame[]): string {
  const [before, after] = frames.slice(-2);
  if (!before || !after) return t('predict.start');
  return stepText(board, legend, before, after);
}

type Told = Outcome | 'none';

interface TellingOptions {
  board: PlayBoard;
  legend: Legend;
  drive: Drive;
  log: Log;
  end: string;
}

// Says what an action has done. The path is that of the next rendering.
function useTelling({ board, legend, drive, log, end }: TellingOptions): (outcome: Told) => void {
  const length = useRef(drive.actions.length);
  useLayoutEffect(() => {
    const more = drive.actions.length - length.current;
    if (more > 0) log.say(lastStep(board, legend, drive.frames) + (drive.isAtEnd ? ` ${end}` : ''));
    else if (more < 0) log.say(t(drive.actions.length > 0 ? 'predict.undone' : 'predict.was_reset'));
    length.current = drive.actions.length;
  }, [drive.actions]);
  return (outcome) => {
    if (outcome === 'blocked') log.say(t('predict.blocked'));
    else if (outcome === 'none') log.say(t('predict.too_far'));
    else if (outcome === 'end') log.say(end);
    else if (outcome === 'full') log.say(t('predict.longest', { n: 0 }));
  };
}

// The one action without a direction that Space means here: to pick up or put down, or the only one there is.
function spaceAction(world: World, drive: Drive): number | null {
  const possible = world.actions.filter(({ index, shift }) => shift === null && world.after(drive.state, index) !== null);
  const handling = possible.filter(({ index }) => world.isHandling(index));
  const [only, second] = handling.length > 0 ? handling : possible;
  return only && !second ? only.index : null;
}

// A click on the robot's own cell picks up or puts down, any other one drives there.
function clicked(world: World, drive: Drive, cell: Place): Told {
  const robot = drive.frames.at(-1)?.robot;
  if (robot?.[0] !== cell[0] || robot[1] !== cell[1]) return drive.goTo(cell);
  const action = spaceAction(world, drive);
  return action === null ? 'done' : drive.act(action);
}

interface KeyOptions {
  world: World;
  drive: Drive;
  off: boolean;
  tell: (outcome: Told) => void;
  area: { current: HTMLElement | null };
}

// Arrow keys work wherever the focus is, except in fields; Space and Backspace only where nothing else wants them.
function useKeys(options: KeyOptions): void {
  const current = useRef(options);
  current.current = options;
  useLayoutEffect(() => {
    let last = -Infinity;
    const pressed = (event: KeyboardEvent): void => {
      if (isElsewhere(event) || event.altKey || event.metaKey) return;
      const { world, drive, off, tell, area } = current.current;
      const isUndo = event.key === 'Backspace' || (event.ctrlKey && event.key.toLowerCase() === 'z');
      if (event.ctrlKey && !isUndo) return;
      const isMove = isArrow(event.key);
      const isSpace = event.key === ' ' && !isPressing(event);
      const isOnBoard = area.current?.contains(event.target as Node) || event.target === document.body;
      const isHeading = event.target instanceof HTMLElement && event.target.matches('h1, h2');
      if (!isMove && !isUndo && !(isSpace && (isOnBoard || isHeading))) return;
      event.preventDefault(); // the page must not scroll
      if (off || (event.repeat && performance.now() - last < kRepeatMs)) return;
      last = performance.now();
      if (isUndo) {
        drive.undo();
        return;
      }
      const action = isMove ? actionOfArrow(world.actions, event.key) : spaceAction(world, drive);
      if (action !== undefined && action !== null) tell(drive.act(action));
      else tell('blocked');
    };
    document.addEventListener('keydown', pressed);
    return () => document.removeEventListener('keydown', pressed);
  }, []);
}
