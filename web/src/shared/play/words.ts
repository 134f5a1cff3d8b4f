// What happens on a board, in words without coordinates.
import type { Legend } from '../board/legend';
import { closedAt, played } from '../board/repeats';
import type { Frame, Part, Path, Place, PlayBoard } from '../board/types';
import { actionLabel, hasText, isEnglish, listed, named, sentence, t } from '../texts';

const kDirections: Record<string, [number, number]> = { up: [0, -1], down: [0, 1], left: [-1, 0], right: [1, 0] };

export const isSame = (a: Place | undefined, b: Place | undefined): boolean => a?.[0] === b?.[0] && a?.[1] === b?.[1];

function directionOf(from: Place, to: Place): string {
  const [dx, dy] = [Math.sign(to[0] - from[0]), Math.sign(to[1] - from[1])];
  return Object.keys(kDirections).find((name) => kDirections[name]?.[0] === dx && kDirections[name]?.[1] === dy) ?? '';
}

// "rubble", "the charger": what a thing is called inside a sentence.
function phrase({ kind, name }: Part): string {
  if (kind === 'destination') return t('thing.destination', { name: named(name.replace(/^destination of /, '')) });
  const own = `phrase.${name}`;
  if (kind === 'terrain' && hasText(own)) return t(own);
  if (kind === 'terrain' && name.includes(' and ')) return listed(name.split(' and ').map((one) => phrase({ kind, name: one })));
  return t(`thing.${kind}`, { name: named(name) });
}

// Whether the robot has done what the map says is to be done. Elsewhere it can only have come to an end.
export function isJobDone(board: PlayBoard, legend: Legend, frame: Frame | undefined): boolean {
  const isAim = ({ kind }: Part): boolean => kind === 'goal' || kind === 'destination';
  const { robot } = frame ?? {};
  if (!frame || !robot || !legend.things().some(isAim)) return true;
  return partsAt(board, legend, frame, robot).some(isAim);
}

// What is on a cell while the board is as in the frame.
function partsAt(board: PlayBoard, legend: Legend, frame: Frame, cell: Place): Part[] {
  const symbol = board.map?.[cell[1] - 1]?.charAt(cell[0] - 1) ?? '';
  const fixed = legend.parts(symbol).filter(({ kind }) => ['wall', 'terrain', 'destination', 'goal'].includes(kind));
  const stations = (frame.stations ?? [])
    .filter((place) => isSame(place, cell))
    .map((place): Part => ({ kind: 'station', name: legend.stationAt(board.map ?? [], place) }));
  const items = (frame.items ?? [])
    .filter((item) => !item.carried && isSame(item.cell, cell))
    .map(({ name }): Part => legend.placed(name));
  return [...fixed, ...stations, ...items];
}

function changedItem(before: Frame, after: Frame, isCarried: boolean): string | undefined {
  const had = before.items ?? [];
  return (after.items ?? []).find((item, i) => item.carried === isCarried && had[i]?.carried === !isCarried)?.name;
}

// Whether nothing is different after a step during which the robot did not move.
const isUnchanged = (before: Frame, after: Frame): boolean =>
  JSON.stringify([before.items, before.stations]) === JSON.stringify([after.items, after.stations]);

// The step from a frame to the next: "The robot moves left onto rubble."
export function stepText(board: PlayBoard, legend: Legend, before: Frame, after: Frame): string {
  const action = before.action ?? '';
  const said = actionLabel(action);
  if (!before.robot || !after.robot) {
    return t('say.state', { action: said, from: named(before.state ?? ''), to: named(after.state ?? '') });
  }
  if (!isSame(before.robot, after.robot)) {
    const went = directionOf(before.robot, after.robot);
    const direction = actionLabel(went);
    const parts = partsAt(board, legend, before, after.robot);
    const onto = listed(parts.filter(({ kind }) => kind === 'terrain').map(phrase));
    const reached = listed(parts.filter(({ kind }) => kind !== 'terrain').map(phrase));
    const rest = {
      onto: onto && t('say.onto', { things: onto }),
      reached: reached && t('say.reached', { things: reached }),
    };
    const hasSlipped = action in kDirections && went !== '' && went !== action;
    if (hasSlipped) return t('say.slip', { wanted: said, direction, ...rest });
    return t('say.move', { direction: went === '' ? said : direction, ...rest });
  }
  const taken = changedItem(before, after, true);
  if (taken) return t('say.take', { item: named(taken) });
  const put = changedItem(before, after, false);
  if (put) return t('say.put', { item: named(put) });
  if (action in kDirections) return t('say.stuck', { direction: said });
  if (action === 'exit') return t('say.leave');
  return t(isUnchanged(before, after) ? 'say.stay' : 'say.other', { action: said });
}

// Whether something stands between two cells.
const isFenced = ({ fences = [] }: PlayBoard, from: Place, to: Place): boolean =>
  fences.some(([a, b]) => (isSame(a, from) && isSame(b, to)) || (isSame(a, to) && isSame(b, from)));

// What is around the robot and what it carries: for people who do not see the board.
export function aroundText(board: PlayBoard, legend: Legend, frame: Frame): string {
  if (!frame.robot) return t('around.state', { state: named(frame.state ?? '') });
  const [column, row] = frame.robot;
  const { width = 0, height = 0 } = board.domain;
  const sides = Object.entries(kDirections).map(([name, [dx, dy]]) => {
    const cell: Place = [column + dx, row + dy];
    const isOutside = cell[0] < 1 || cell[1] < 1 || cell[0] > width || cell[1] > height;
    const things = isOutside ? [] : isFenced(board, [column, row], cell) ? [t('thing.wall')] : partsAt(board, legend, frame, cell).map(phrase);
    const what = isOutside ? t('around.edge') : things.length > 0 ? listed(things) : t('around.floor');
    return t('around.side', { direction: actionLabel(name), what });
  });
  const carried = (frame.items ?? []).filter((item) => item.carried).map(({ name }) => t('thing.item', { name: named(name) }));
  const here = partsAt(board, legend, frame, frame.robot).map(phrase);
  return [
    here.length > 0 ? sentence(t('around.here', { what: listed(here) })) : '',
    ...sides.map(sentence),
    carried.length > 0 ? t('around.carries', { what: listed(carried) }) : '',
  ]
    .filter((text) => text !== '')
    .join(' ');
}

// The cells of the board as texts, row by row from the top.
export function cellTexts(board: PlayBoard, legend: Legend, frame: Frame): string[][] {
  return (board.map ?? []).map((line, y) =>
    [...line].map((_, x) => {
      const cell: Place = [x + 1, y + 1];
      const things = partsAt(board, legend, frame, cell).map(phrase);
      if (isSame(frame.robot, cell)) things.unshift(t('thing.robot'));
      const closed = Object.entries(kDirections).flatMap(([name, [dx, dy]]) =>
        isFenced(board, cell, [cell[0] + dx, cell[1] + dy]) ? [t('around.side', { direction: actionLabel(name), what: t('thing.wall') })] : [],
      );
      return [things.length > 0 ? listed(things) : t('around.floor'), ...closed].join('; ');
    }),
  );
}

// What the map is made of, to read as its label: "A map with the robot, rubble and the charger".
export function boardText(board: PlayBoard, legend: Legend, frame: Frame): string {
  if (!board.map) return t('board.state', { state: named(frame.state ?? '') });
  const things = new Set(board.fences?.length ? [t('thing.wall')] : []);
  board.map.forEach((line, y) => [...line].forEach((_, x) => {
    for (const part of partsAt(board, legend, frame, [x + 1, y + 1])) things.add(phrase(part));
  }));
  return t('board.map', { what: listed([t('thing.robot'), ...things]) });
}

// "And so on: it never delivers the parcel." The server's words are English.
export function onAndOn({ repeats_text: what }: Path): string {
  return what && isEnglish() ? sentence(t('say.for_ever_what', { what })) : t('say.for_ever');
}

// The step of a path, as it is played, that has just been made.
export function playedText(board: PlayBoard, legend: Legend, path: Path, step: number): string {
  const frames = played(path);
  const [before, after] = [frames[step - 1], frames[step]];
  if (!before || !after) return t('watch.start');
  const isRound = path.repeats_from !== undefined && (step === closedAt(path) || step === frames.length - 1);
  return stepText(board, legend, before, after) + (isRound ? ` ${onAndOn(path)}` : '');
}
