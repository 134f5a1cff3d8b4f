// A picture of a whole board beside others: the robot at its start, with whole paths.
import type { JSX } from 'preact';
import type { Legend } from '../board/legend';
import type { Path, PlayBoard } from '../board/types';
import { actionLabel, listed } from '../texts';
import { BoardPane } from './board_pane';

interface Props {
  board: PlayBoard;
  legend: Legend;
  path: Path;
  other?: Path | null;
  at?: number | null; // where they separate
}

export function SmallBoard({ board, legend, path, other, at }: Props): JSX.Element {
  if (!board.map) return <p>{listed(path.frames.flatMap(({ action }) => (action ? [actionLabel(action)] : [])))}</p>;
  return (
    <BoardPane
      board={board}
      legend={legend}
      frames={path.frames}
      step={0}
      walked={0}
      trail="own"
      whole
      isSmall
      closedAt={path.repeats_from === undefined ? undefined : path.frames.length - 1}
      {...(other && at !== undefined && at !== null ? { other: other.frames, decisive: { frame: at } } : {})}
    />
  );
}
