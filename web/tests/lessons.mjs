// Lessons that no small domain has: a large map with many things, and explicit models with and without a drawing. Their
// worlds cannot be driven in: there are no tables of moves.

const kUndriven = {
  judge: { exact: true, weights: ['-1'], unit: [-1], scale: 1, discount: 1 },
  tables: { moves: [], worlds: {} },
  max_actions: 60,
  fresh: [],
};
const kUnjudged = { state: 0, counts: [], brackets: [] };
const countedAs = (name) => ({ name, label: name, one: name, many: name });

const sentence = { normal: [-1, 0, 2, 0, 0, 0, 0, 1], text: 'crossing rubble costs more than 2 steps' };

function robotAlong(cells, actions) {
  return cells.map(([x, y], i) => ({
    robot: [x, y],
    items: [{ name: 'medicine', cell: i < 5 ? [12, 8] : [x, y], carried: i >= 5 }],
    stations: [[21, 4]],
    action: actions[i] ?? null,
  }));
}

// One part with an example, `shown`, and a test.
const lessonOf = (domain, board, shown) => ({
  schema: 'kith.curriculum/1',
  title: domain.title,
  program: '0.1.0',
  ...kUndriven,
  domain,
  components: [
    { number: 1, name: 'one against the other', sentences: [sentence], demonstrations: [{ ...board, first: true, conveys: [sentence], ...shown }], tests: [{ ...board, first: true, state: 1, covers: [sentence] }] },
  ],
  skipped: [],
});

// 60 columns, 40 rows: on most screens only a part of it can be seen with cells of a readable size.
export function hugeLesson() {
  const [width, height] = [60, 40];
  const map = Array.from({ length: height }, (_, y) =>
    Array.from({ length: width }, (_, x) => (x === 20 && y === 3 ? 'C' : x === 59 && y === 39 ? 'D' : y % 6 === 3 && x % 10 > 2 ? '#' : (x + 2 * y) % 17 === 0 ? 'r' : '.')).join(''),
  );
  const along = Array.from({ length: 50 }, (_, i) => [i + 3, 36]);
  const frames = robotAlong(along, Array.from({ length: 49 }, () => 'right'));
  const other = [...frames.slice(0, 4), ...frames.slice(4).map((frame) => ({ ...frame, robot: [frame.robot[0] - 1, 37] }))];
  other[3] = { ...other[3], action: 'down' };
  const domain = {
    id: 'rescue',
    job: 'The robot brings the medicine to where it belongs.',
    counted: Array.from({ length: 8 }, (_, k) => countedAs(`thing ${k}`)),
    title: 'Search and rescue on a large floor',
    width,
    height,
    features: Array.from({ length: 8 }, (_, k) => ({ name: `f${k}`, words: `thing ${k}`, many: `{n} things ${k}`, do: '', do_many: '', weight: -k })),
    legend: [
      { symbol: '#', kind: 'wall', name: 'wall' },
      { symbol: 'r', kind: 'terrain', name: 'rubble' },
      { symbol: 'C', kind: 'terrain', name: 'rubble', parts: [{ kind: 'terrain', name: 'rubble' }, { kind: 'station', name: 'charger' }] },
      { symbol: 'D', kind: 'destination', name: 'destination of medicine' },
    ],
    surfaces: [{ name: 'rubble', tint: 'brown', pattern: 'dots' }],
  };
  const reason = 'it would rather take 2 more steps than cross rubble: crossing rubble costs more than 2 steps';
  return lessonOf(domain, { world: 1, map, start: frames[0], frames, ...kUnjudged }, { reason, alternative: { frames: other }, decisive: { frame: 3, cell: [6, 36] } });
}

export function mapless() {
  const frames = (...steps) => steps.map(([state, action]) => ({ state, action: action ?? null }));
  const own = frames(['dock', 'wait'], ['dock, charged', 'leave'], ['hall', 'forward'], ['done']);
  const other = frames(['dock', 'leave'], ['hall, nearly empty', 'forward'], ['done']);
  const board = { world: 0, world_name: 'weekday', start: { state: 'dock' }, frames: own, ...kUnjudged };
  const features = [{ name: 'time', words: 'a minute', many: '{n} minutes', do: '', do_many: '', weight: -1 }];
  const reason = 'it would rather wait than run empty: running empty costs more than a minute';
  const lesson = lessonOf({ id: 'model', counted: [countedAs('minutes')], title: 'A model without a map', features }, board, { reason, alternative: { frames: other }, decisive: { frame: 0 } });
  return { ...lesson, skipped: [{ name: 'something', why: 'all of it is known beforehand' }] };
}

// The same model where chance has a part: two runs, one of which does not end.
export function uncertain() {
  const lesson = mapless();
  const [component] = lesson.components;
  const first = component.demonstrations[0];
  const runs = {
    text: 'in 2 runs: a minute in all and the most common path in 1',
    runs: [
      { frames: first.frames, ended: true },
      { frames: first.alternative.frames, ended: false },
    ],
  };
  first.runs = runs;
  component.tests[0].runs = runs;
  component.tests[0].covers = [{ ...component.sentences[0], text: '' }]; // nothing short is true
  return lesson;
}

// A drawn model: a wall between two cells, a destination that the state places, and a robot that slips.
export function drawn() {
  const lesson = mapless();
  const frame = (robot, action = null) => ({
    robot,
    items: [
      { name: 'dog', cell: [1, 1], carried: false },
      { name: 'destination of dog', cell: [3, 2], carried: false },
    ],
    stations: [],
    action,
  });
  const frames = [frame([1, 2], 'right'), frame([1, 1], 'down'), frame([1, 1], 'down'), frame([1, 2], 'right'), frame([2, 2])];
  const board = { world: 0, world_name: 'wet ice', map: ['~~~', '~~~'], fences: [[[2, 1], [3, 1]]], start: frame([1, 2]), frames };
  Object.assign(lesson.domain, {
    width: 3,
    height: 2,
    legend: [
      { symbol: '~', kind: 'terrain', name: 'ice' },
      { symbol: 'A', kind: 'item', name: 'dog' },
      { symbol: 'D', kind: 'destination', name: 'destination of dog' },
    ],
    surfaces: [{ name: 'ice', tint: 'blue', pattern: 'dots' }],
  });
  const [component] = lesson.components;
  component.demonstrations = component.demonstrations.map((shown) => ({
    ...shown,
    ...board,
    alternative: { frames },
    decisive: { frame: 0, cell: [1, 2] },
    runs: { text: 'in 1 run: the same path each time', runs: [{ frames, ended: true }] },
  }));
  component.tests = component.tests.map((test) => ({ ...test, ...board, state: 1, runs: component.demonstrations[0].runs }));
  return lesson;
}

// The sample with a robot that does not end in its first example: a first move, and then there and back for ever.
export function endless(sample) {
  const lesson = structuredClone(sample);
  const [shown] = lesson.components[0].demonstrations;
  const [a, b, c] = shown.frames;
  const back = { up: 'down', down: 'up', left: 'right', right: 'left' }[b.action];
  shown.frames = [a, b, { ...c, action: back }, { ...b, action: null }];
  Object.assign(shown, { repeats_from: 1, repeats_text: 'it never delivers the parcel', decisive: { ...shown.decisive, frame: 1 } });
  return lesson;
}
