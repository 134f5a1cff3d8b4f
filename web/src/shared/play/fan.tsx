// Where chance has a part: what can follow from the robot's action at a place, and from another one there. What makes
// an action safe is found by comparing the two.
import type { JSX } from 'preact';
import type { Arm } from '../board/fan';
import { kMoves } from '../board/geometry';
import type { Legend } from '../board/legend';
import type { Frame, PlayBoard } from '../board/types';
import { actionLabel, listed, named, t } from '../texts';
import { BoardPane } from './board_pane';
import { isSame } from './words';
import { labelOf } from './ledger';
import type { Branch, World } from './world';

const isWhole = (x: number): boolean => Math.abs(x - Math.round(x)) < 1e-6 && Math.round(x) > 0;

// "1 of 3 tries", "2 of 5 tries"; per cent where no small number of tries says it and what stands beside it.
function shareText(probability: number, beside: number[], short = false): string {
  for (const of of [2, 3, 4, 5, 6, 8, 10]) {
    const n = Math.round(probability * of);
    if ([probability, ...beside].every((share) => isWhole(share * of))) return t(short ? 'fan.of' : 'fan.tries', { n, of });
  }
  const percent = Math.round(100 * probability);
  return short ? `${percent} %` : t('fan.percent', { percent });
}

const sharesOf = (branches: Branch[]): number[] => branches.map(({ probability }) => probability);

// Where a path is at one of its frames, as a state of the table; -1: it does not say.
export function stateAt(world: World, start: number, frames: Frame[], step: number): number {
  const look = (frame: Frame | undefined): string => JSON.stringify(frame?.robot ?? frame?.state);
  let state = start;
  for (let i = 0; i < step && state >= 0; i += 1) {
    const all = world.branches(state, world.actionOf(frames[i]));
    state = all.find(({ next }) => look(world.frame(next)) === look(frames[i + 1]))?.next ?? -1;
  }
  return state;
}

interface Props {
  board: PlayBoard;
  legend: Legend;
  world: World;
  state: number; // where both actions are possible
  own: number; // the robot's action
  other: number;
  isYours: boolean; // the other action is what the reader has predicted
  costs: number[]; // what the robot avoids, as positions in `counted` of the domain
}

export function Fan({ board, legend, world, state, own, other, isYours, costs }: Props): JSX.Element | null {
  const ways = [own, other].map((action) => ({ action, branches: state < 0 ? [] : world.branches(state, action) }));
  const [first, second] = ways;
  if (own === other || !first || !second || ways.some(({ branches }) => branches.length === 0)) return null;
  if (ways.every(({ branches }) => branches.length === 1)) return null; // nothing is left to chance
  const here = world.frame(state).robot;
  const armsOf = (branches: Branch[], kind: Arm['kind']): Arm[] =>
    branches.flatMap(({ next, probability }) => {
      const to = world.frame(next).robot;
      return here && to ? [{ from: here, to, kind, text: shareText(probability, sharesOf(branches), true) }] : [];
    });
  const saying = (action: number, i: number): string =>
    t(`fan.${i === 0 ? 'robot' : isYours ? 'yours' : 'expected'}${world.actions[action]?.shift ? '' : '_does'}`, { action: actionLabel(world.actions[action]?.name ?? '') });
  return (
    <div class="fan">
      <p>{t('fan.title')}</p>
      <div class="pair">
        {ways.map(({ action, branches }, i) => (
          <figure>
            {here && board.map && (
              <BoardPane
                board={board}
                legend={legend}
                frames={[world.frame(state)]}
                step={0}
                trail="own"
                isSmall
                fan={armsOf(branches, i === 0 ? 'own' : 'other')}
              />
            )}
            <figcaption>
              <strong class={i === 0 ? 'own' : 'other'}>{saying(action, i)}</strong>{' '}
              {listed(branches.map(({ next, probability }) => `${whereTo(world, state, next)} ${shareText(probability, sharesOf(branches))}`))}.
            </figcaption>
          </figure>
        ))}
      </div>
      <Saved board={board} world={world} state={state} action={own} own={first.branches} other={second.branches} costs={costs} />
    </div>
  );
}

function whereTo(world: World, from: number, next: number): string {
  const [here, to] = [world.frame(from).robot, world.frame(next).robot];
  if (!here || !to) return t('fan.state', { state: named(world.frame(next).state ?? '') });
  const [dx, dy] = [to[0] - here[0], to[1] - here[1]];
  if (dx === 0 && dy === 0) return t('fan.stays');
  const direction = Object.keys(kMoves).find((name) => kMoves[name]?.[0] === dx && kMoves[name]?.[1] === dy);
  return direction ? t('fan.goes', { direction: actionLabel(direction) }) : t('fan.elsewhere');
}

interface SavedProps {
  board: PlayBoard;
  world: World;
  state: number;
  action: number; // the robot's
  own: Branch[];
  other: Branch[];
  costs: number[];
}

// What costs the robot something and happens after the one action but never, or less often, after the other.
function Saved({ board, world, state, action, own, other, costs }: SavedProps): JSX.Element {
  const chanceOf = (branches: Branch[], k: number): number =>
    branches.reduce((sum, { probability, counts }) => sum + ((counts[k] ?? 0) !== 0 ? probability : 0), 0);
  const [x, y] = world.frame(state).robot ?? [0, 0];
  const shift = world.actions[action]?.shift;
  const reaches = (dx: number, dy: number): boolean => own.some(({ next }) => isSame(world.frame(next).robot, [x + dx, y + dy]));
  const isPushing = shift && reaches(0, 0) && !reaches(...shift); // it does not slip there: it aims at what is closed
  const texts = costs.flatMap((k) => {
    const [mine, theirs] = [chanceOf(own, k), chanceOf(other, k)];
    const counted = board.domain.counted?.[k];
    if (!counted || mine + 1e-9 >= theirs) return [];
    const said = { what: labelOf(counted), mine: shareText(mine, [theirs]), theirs: shareText(theirs, mine > 0 ? [mine] : []) };
    return mine === 0 ? [`${t('fan.never', said)}${isPushing ? ` ${t('fan.wall')}` : ''}`] : [t('fan.less', said)];
  });
  return (
    <>
      {texts.map((text) => (
        <p class="cost">{text}</p>
      ))}
    </>
  );
}
