// The robot's path and another one from the same start: both drawn, with the place where they separate and what each
// has more of; both robots go from there by themselves.
import type { ComponentChildren, JSX } from 'preact';
import type { Legend } from '../board/legend';
import { closedAt, played } from '../board/repeats';
import type { Frame, Path, PathKind, PlayBoard } from '../board/types';
import { t } from '../texts';
import { BoardInWords, BoardPane, Things } from './board_pane';
import { chipsOf, countsOf, Ledger } from './ledger';
import { LogView, usePathLog } from './log';
import { Player, usePacedPlayback } from './player';
import { StateCard, StepList } from './steps';

interface Props {
  board: PlayBoard;
  legend: Legend;
  robot: Path;
  other: Path | null;
  isYours?: boolean; // it is the reader's
  otherName: string; // "You"
  otherLine: string; // what its line is called in the legend: "Your path"
  at: number | null; // where they separate
  isStill?: boolean; // for paper: nothing to press
  title?: string; // of the robot's steps where there is no map
  reason: ComponentChildren; // beside the board
  children?: ComponentChildren; // below the player
}

export function Compare(props: Props): JSX.Element {
  const { board, legend, at, isStill } = props;
  const robot = played(props.robot);
  const other = props.other && played(props.other);
  const last = Math.max(robot.length, other?.length ?? 0, 1) - 1;
  const playback = usePacedPlayback(last, other && at !== null ? { from: at, isAuto: !isStill } : { from: 0, isAuto: false, isAtEnd: true });
  const { step } = playback;
  const log = usePathLog(board, legend, props.robot, step);
  const decisive = at === null || !other ? null : { frame: at, ...cellOf(robot[at]) };
  const kind: PathKind = props.isYours === false ? 'plain' : 'other';
  const robotStep = Math.min(step, robot.length - 1);
  const isOver = step === last;
  const counts = [countsOf(robot, isOver || isStill ? robot.length - 1 : robotStep)];
  // where a page is not told what steps count, it says nothing
  if (other && other.some(({ counts: one }) => one)) counts.push(countsOf(other, isOver || isStill ? other.length - 1 : step));
  // a path that never ends counts the steps of its cycle without end
  const endless = [props.robot, props.other].map((path) => (isOver || isStill) && path?.repeats_from !== undefined ? countsOf(path.frames.slice(path.repeats_from)).map((n) => n > 0) : []);
  const isForEver = props.robot.repeats_from !== undefined || props.other?.repeats_from !== undefined;
  const names = [t('ledger.robot'), props.otherName];
  const frame = robot[robotStep] ?? board.start;
  return (
    <div class="board-screen">
      <div class="board-column">
        {board.map ? (
          <BoardPane
            board={board}
            legend={legend}
            frames={robot}
            step={robotStep}
            walked={step}
            trail="own"
            whole
            decisive={decisive}
            closedAt={closedAt(props.robot)}
            {...(other && props.other ? { other, otherKind: kind, otherClosedAt: closedAt(props.other) } : {})}
            {...(other && counts.length > 1 && !isForEver ? { chips: chipsOf(board.domain, countsOf(robot), countsOf(other), kind) } : {})}
          />
        ) : (
          <StateCard frame={frame} />
        )}
        {!isStill && <LogView log={log} />}
        {board.map && <Things board={board} legend={legend} lines={other ? ['own', kind] : ['own']} walked={robot} decisive={decisive !== null} otherLine={props.otherLine} />}
      </div>
      <div class="side">
        {props.reason}
        <Ledger
          board={board}
          columns={counts.map((one, i) => ({ name: names[i] ?? '', kind: i === 0 ? 'own' : kind, counts: one, endless: endless[i] ?? [] }))}
        />
        {!isStill && <Player playback={playback} primary={false} />}
        {props.children}
        {board.map ? (
          !isStill && <BoardInWords board={board} legend={legend} frame={frame} />
        ) : (
          <div class="step-lists">
            <StepList title={t('feedback.robot')} frames={robot} differs={at} />
            {other && <StepList title={props.otherLine} frames={other} differs={at} />}
          </div>
        )}
      </div>
    </div>
  );
}

const cellOf = (frame: Frame | undefined): { cell?: [number, number] } => (frame?.robot ? { cell: frame.robot } : {});
