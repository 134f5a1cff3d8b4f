// What can follow from the robot's action where two paths part, and from the other one.
import type { JSX } from 'preact';
import type { Path } from '../shared/board/types';
import { Fan, stateAt } from '../shared/play/fan';
import { playBoard, type Context } from './context';
import type { Driven } from './document';

interface Props extends Context {
  shown: Driven;
  mine: Path | null; // what the reader has predicted, if it is not what the robot does
  other: Path | null; // the path with which the robot's is compared
  at: number | null; // where they part
}

export function OutcomesView({ shown, mine, other, at, domain, legend, worlds }: Props): JSX.Element | null {
  const world = worlds.world(shown.world);
  if (!world || !other || at === null) return null;
  return (
    <Fan
      board={playBoard(domain, shown)}
      legend={legend}
      world={world}
      state={stateAt(world, shown.state, shown.frames, at)}
      own={world.actionOf(shown.frames[at])}
      other={world.actionOf(other.frames[at])}
      isYours={mine !== null}
      costs={worlds.costs()}
    />
  );
}
