// A picture of a whole board beside others: the robot at its start, with whole paths.
import type { JSX } from 'preact';
import { kFew } from '../board/board';
import type { Legend } from '../board/legend';
import { OverviewMap } from '../board/overview';
import type { Path, PathKind, PlayBoard } from '../board/types';
import { actionLabel, listed } from '../texts';
import { BoardPane } from './board_pane';
import { boardText } from './words';
import { intentsOf, type Run } from './runs';

interface Props {
  board: PlayBoard;
  legend: Legend;
  path: Path;
  kind?: PathKind;
  other?: Path | null;
  otherKind?: PathKind;
  at?: number | null; // where they separate
  runs?: Run[] | undefined; // where chance has a part: in place of a path it is drawn where the robot means to go
}

export function SmallBoard({ board, legend, path, kind = 'own', other, otherKind = 'other', at, runs }: Props): JSX.Element {
  if (!board.map) return <p>{listed(path.frames.flatMap(({ action }) => (action ? [actionLabel(action)] : [])))}</p>;
  const { width = 0, height = 0 } = board.domain;
  if (width > kFew || height > kFew) {
    return (
      <div class="live-board small">
        <div class="board">
          <div class="overview still">
            <OverviewMap
              domain={board.domain}
              legend={legend}
              board={{ ...board, frames: path.frames }}
              frame={board.start}
              own={path.frames}
              other={other?.frames ?? []}
              kind={kind}
              otherKind={otherKind}
              label={boardText(board, legend, board.start)}
            />
          </div>
        </div>
      </div>
    );
  }
  if (runs) {
    return <BoardPane board={board} legend={legend} frames={[board.start]} step={0} trail="own" isSmall intents={intentsOf(runs, board.start)} />;
  }
  return (
    <BoardPane
      board={board}
      legend={legend}
      frames={path.frames}
      step={0}
      walked={0}
      trail={kind}
      whole
      isSmall
      closedAt={path.repeats_from === undefined ? undefined : path.frames.length - 1}
      {...(other && at !== undefined && at !== null ? { other: other.frames, otherKind, decisive: { frame: at } } : {})}
    />
  );
}
