// What boards show, in words with places.
import { hasSlipped, kMoves } from '../../shared/board/geometry';
import type { Frame, Path, Place } from '../../shared/board/types';

const upperFirst = (text: string): string => text.charAt(0).toUpperCase() + text.slice(1);

const cellText = ([column, row]: Place): string => `column ${column}, row ${row}`;

function listed(things: string[]): string {
  if (things.length < 2) return things.join('');
  return `${things.slice(0, -1).join(', ')} and ${things[things.length - 1]}`;
}

const withArticle = (names: string[]): string => listed(names.map((name) => `the ${name}`));

const counted = (n: number, noun: string): string => `${n} ${noun}${n === 1 ? '' : 's'}`;

// "goes up": what the robot does with an action.
function actionWords(action: string): string {
  if (['up', 'down', 'left', 'right'].includes(action)) return `goes ${action}`;
  if (action === 'pickup') return 'picks it up';
  if (action === 'dropoff') return 'puts it down';
  if (action === 'exit') return 'leaves';
  return `does '${action}'`;
}

function placeOf(frame: Frame): string {
  return frame.robot ? `at ${cellText(frame.robot)}` : stateText(frame.state ?? 'a state');
}

// "on the bank", "in state 3": many names of states say where they are.
const stateText = (state: string): string => (/^(on|in|at|by|near|under|behind|beside|inside|outside) /i.test(state) ? state : `in ${state}`);

// Where a robot ends up that does not go where it wanted to: " but slips down"; nothing if all went well.
function mishap(frame: Frame, next: Frame | undefined): string {
  if (!frame.robot || !next?.robot || !hasSlipped(frame, next.robot)) return '';
  const [dx, dy] = [next.robot[0] - frame.robot[0], next.robot[1] - frame.robot[1]];
  if (dx === 0 && dy === 0) return ' but stays where it is';
  const side = Object.keys(kMoves).find((name) => kMoves[name]?.[0] === dx && kMoves[name]?.[1] === dy);
  return side ? ` but slips ${side}` : ' but ends up elsewhere';
}

// Whether nothing is different after a step.
const isStaying = (frame: Frame, next: Frame | undefined): boolean =>
  next !== undefined && JSON.stringify({ ...frame, action: null }) === JSON.stringify({ ...next, action: null });

// What a frame's action does, with what the robot carries: "it goes left, carrying the parcel".
function moveText(frame: Frame, next: Frame | undefined): string {
  const trouble = mishap(frame, next);
  if (trouble) return `it tries to go ${frame.action ?? ''}${trouble}`;
  const carried = (frame.items ?? []).filter((item) => item.carried).map((item) => item.name);
  const load = carried.length > 0 && frame.action !== 'dropoff' ? `, carrying ${withArticle(carried)}` : '';
  return `it ${actionWords(frame.action ?? '')}${isStaying(frame, next) ? ' and stays where it is' : load}`;
}

// What is behind the last step that is shown: "The end." A path that never ends is told so.
export function endText({ repeats_from, repeats_text }: Pick<Path, 'repeats_from' | 'repeats_text'>, isCutOff = false): string {
  if (repeats_from !== undefined) return repeats_text ? `And so on: ${repeats_text}.` : 'And so on, for ever.';
  return isCutOff ? 'It goes on.' : 'The end.';
}

// The step that has just been made: "Step 2 of 7: it goes left." Nothing is told before the robot moves.
export function stepText(frames: Frame[], step: number, end: string): string {
  const steps = frames.length - 1;
  const before = frames[step - 1];
  if (!before?.action) return step === 0 ? 'The robot has not moved yet.' : `After ${counted(steps, 'step')}. ${end}`;
  return `Step ${step} of ${steps}: ${moveText(before, frames[step])}.${step === steps ? ` ${end}` : ''}`;
}

// The step that begins with a frame, for those who do not see the board: "At column 3, row 1 it goes left."
export const placedStepText = (frame: Frame, next?: Frame): string => `${upperFirst(placeOf(frame))} ${moveText(frame, next)}.`;

// "up, left 3 times": actions with repetitions counted; "up; then again and again: left, right" where they never end.
export function actionsText({ frames, repeats_from }: Path): string {
  if (repeats_from === undefined) return namesText(frames);
  const round = `again and again: ${namesText(frames.slice(repeats_from))}`;
  return repeats_from === 0 ? round : `${namesText(frames.slice(0, repeats_from))}; then ${round}`;
}

function namesText(frames: Frame[]): string {
  const actions = frames.flatMap((frame) => (frame.action ? [frame.action] : []));
  const runs: { action: string; n: number }[] = [];
  for (const action of actions) {
    const last = runs[runs.length - 1];
    if (last?.action === action) last.n += 1;
    else runs.push({ action, n: 1 });
  }
  const times = (n: number): string => (n === 1 ? '' : n === 2 ? ' twice' : ` ${n} times`);
  return runs.map(({ action, n }) => `${action}${times(n)}`).join(', ') || 'nothing';
}
