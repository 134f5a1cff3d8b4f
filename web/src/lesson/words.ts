// What boards show, in words: for captions and for those who do not see them.
import type { Board, Domain, Frame, Place } from './document';
import type { Legend } from './legend';

export const upperFirst = (text: string): string => text.charAt(0).toUpperCase() + text.slice(1);

export const cellText = ([column, row]: Place): string => `(${column},${row})`;

export function listed(things: string[]): string {
  if (things.length < 2) return things.join('');
  return `${things.slice(0, -1).join(', ')} and ${things[things.length - 1]}`;
}

const withArticle = (names: string[]): string => listed(names.map((name) => `the ${name}`));

export const counted = (n: number, noun: string): string => `${n} ${noun}${n === 1 ? '' : 's'}`;

// "goes up": what the robot does with an action.
export function actionWords(action: string): string {
  if (['up', 'down', 'left', 'right'].includes(action)) return `goes ${action}`;
  if (action === 'pickup') return 'picks it up';
  if (action === 'dropoff') return 'puts it down';
  if (action === 'exit') return 'leaves';
  return `does '${action}'`;
}

export function placeOf(frame: Frame): string {
  return frame.robot ? `at ${cellText(frame.robot)}` : `in ${frame.state ?? 'a state'}`;
}

// "Step 2 of 7: at (3,1) it goes left."
export function stepText(frames: Frame[], step: number): string {
  const frame = frames[step];
  const steps = frames.length - 1;
  if (!frame) return '';
  const carried = (frame.items ?? []).filter((item) => item.carried).map((item) => item.name);
  const load = carried.length > 0 ? `, carrying ${withArticle(carried)},` : '';
  if (!frame.action) return `After ${counted(steps, 'step')}: it ends ${placeOf(frame)}.`;
  return `Step ${step + 1} of ${steps}: ${placeOf(frame)}${load} it ${actionWords(frame.action)}.`;
}

// "up, left 3 times": actions with repetitions counted.
export function actionsText(frames: Frame[]): string {
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

// Sentences about what is on the map and where, while the board is at its start.
export function mapText(domain: Domain, legend: Legend, board: Board): string[] {
  if (!board.map) return [`It starts in ${board.start.state ?? 'a state'}.`];
  const places = new Map<string, string[]>();
  const add = (name: string, cell: Place): void => void places.set(name, [...(places.get(name) ?? []), cellText(cell)]);
  board.map.forEach((row, y) => {
    [...row].forEach((symbol, x) => {
      for (const part of legend.parts(symbol)) {
        if (['wall', 'terrain', 'goal', 'destination'].includes(part.kind)) add(part.name, [x + 1, y + 1]);
      }
    });
  });
  for (const cell of board.start.stations ?? []) add(legend.stationAt(board.map, cell), cell);
  for (const item of board.start.items ?? []) {
    if (!item.carried) add(item.name, item.cell);
  }
  const carried = (board.start.items ?? []).filter((item) => item.carried).map((item) => item.name);
  const robot = board.start.robot ? ` at ${cellText(board.start.robot)}` : '';
  return [
    `The map has ${counted(domain.width ?? 0, 'column')} and ${counted(domain.height ?? 0, 'row')}; cells are (column,row) from the top left.`,
    `The robot starts${robot}${carried.length > 0 ? `, carrying ${withArticle(carried)}` : ''}.`,
    ...[...places].map(([name, cells]) => `${upperFirst(name)}: ${listed(cells)}.`),
  ];
}
