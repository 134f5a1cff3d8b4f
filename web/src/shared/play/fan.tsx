// Where chance has a part: what can follow from what the robot does at the decisive place, and from what one might have
// expected there. What makes an action safe is found by comparing the two.
import type { JSX } from 'preact';
import type { Arm } from '../shared/board/fan';
import { kMoves } from '../shared/board/geometry';
import { BoardPane } from '../shared/play/board_pane';
import { actionLabel, listed } from '../shared/texts';
import { playBoard } from './context';
import type { Context } from './context';
import type { Demonstration } from './document';
import type { JudgedWorld } from './judge';

interface Branch {
  next: number;
  probability: number;
  counts: number[];
}

const branchesOf = (table: JudgedWorld, state: number, action: number): Branch[] =>
  (table.outcomes?.[state]?.[action] ?? []).map(([next, probability, counts]) => ({ next, probability, counts }));

// "1 of 3", "2 of 5"; per cent where no small number of tries says it.
function shareText(probability: number): string {
  for (const n of [2, 3, 4, 5, 6, 8, 10]) {
    const times = probability * n;
    if (Math.abs(times - Math.round(times)) < 1e-6 && Math.round(times) > 0) return `${Math.round(times)} of ${n} tries`;
  }
  return `${Math.round(100 * probability)} % of tries`;
}

// Where the robot is at a step of its path, as a state of the table.
function stateAt(shown: Demonstration, table: JudgedWorld, world: NonNullable<ReturnType<Context['worlds']['world']>>, step: number): number {
  let state = shown.state;
  for (let t = 0; t < step; t += 1) {
    const action = world.actions.find(({ name }) => name === shown.frames[t]?.action)?.index ?? -1;
    const wanted = JSON.stringify(shown.frames[t + 1]?.robot ?? shown.frames[t + 1]?.state);
    const branch = branchesOf(table, state, action).find(({ next }) => JSON.stringify(world.frame(next).robot ?? world.frame(next).state) === wanted);
    if (!branch) return -1;
    state = branch.next;
  }
  return state;
}

export function Fan({ shown, domain, legend, worlds }: Context & { shown: Demonstration }): JSX.Element | null {
  const world = worlds.world(shown.world);
  const table = worlds.table(shown.world);
  const step = shown.decisive?.frame;
  if (!world || !table?.outcomes || step === undefined || !shown.alternative) return null;
  const state = stateAt(shown, table, world, step);
  const named = (name: string | null | undefined): number => world.actions.find((action) => action.name === name)?.index ?? -1;
  const [own, other] = [named(shown.frames[step]?.action), named(shown.alternative.frames[step]?.action)];
  const ways = [own, other].map((action) => ({ action, branches: branchesOf(table, state, action) }));
  if (state < 0 || own === other || ways.some(({ branches }) => branches.length === 0)) return null;
  const here = world.frame(state).robot;
  const whereTo = ({ next }: Branch): string => {
    const to = world.frame(next).robot;
    if (!here || !to) return `it gets to ${world.frame(next).state ?? 'elsewhere'}`;
    const [dx, dy] = [to[0] - here[0], to[1] - here[1]];
    if (dx === 0 && dy === 0) return 'it stays where it is';
    const direction = Object.keys(kMoves).find((name) => kMoves[name]?.[0] === dx && kMoves[name]?.[1] === dy);
    return direction ? `it goes ${actionLabel(direction)}` : 'it ends up elsewhere';
  };
  const armsOf = (branches: Branch[], kind: Arm['kind']): Arm[] =>
    branches.flatMap(({ next, probability }) => {
      const to = world.frame(next).robot;
      return here && to ? [{ from: here, to, kind, text: shareText(probability).replace(/ tries$/, '') }] : [];
    });
  // What costs the robot something and happens after the one action but never, or less often, after the other.
  const chanceOf = (branches: Branch[], k: number): number =>
    branches.reduce((sum, { probability, counts }) => sum + ((counts[k] ?? 0) !== 0 ? probability : 0), 0);
  const saved = domain.features.flatMap((feature, k) => {
    const [mine, theirs] = [chanceOf(ways[0]?.branches ?? [], k), chanceOf(ways[1]?.branches ?? [], k)];
    return feature.weight < 0 && mine + 1e-9 < theirs ? [{ feature, mine, theirs }] : [];
  });
  const pushes = (ways[0]?.branches ?? []).some((branch) => whereTo(branch) === 'it stays where it is');
  return (
    <div class="fan">
      <p>What can happen at the decisive place:</p>
      <div class="pair">
        {ways.map(({ action, branches }, i) => (
          <figure>
            {here && shown.map && (
              <BoardPane
                board={playBoard(domain, shown)}
                legend={legend}
                frames={[world.frame(state)]}
                step={0}
                trail="own"
                isSmall
                fan={armsOf(branches, i === 0 ? 'own' : 'other')}
              />
            )}
            <figcaption>
              <strong class={i === 0 ? 'own' : 'other'}>{i === 0 ? 'The robot' : 'Somebody might expect that it'}</strong>
              {` tries to go ${actionLabel(world.actions[action]?.name ?? '')}: `}
              {listed(branches.map((branch) => `${whereTo(branch)} in ${shareText(branch.probability)}`))}.
            </figcaption>
          </figure>
        ))}
      </div>
      {saved.map(({ feature, mine, theirs }) => (
        <p class="cost">
          {mine === 0
            ? `The robot's move cannot end in ${feature.words}. The other one does in ${shareText(theirs)}.`
            : `The robot's move ends in ${feature.words} in ${shareText(mine)}, the other one in ${shareText(theirs)}.`}
          {pushes && mine === 0 && ' It pushes against the edge or a wall on purpose: if it slips, it slips to where nothing happens.'}
        </p>
      ))}
    </div>
  );
}

