// Views of every screen: what a real server shows three people who answer in different ways, and what it seldom shows,
// made from that.
import { Client, kQuestions, play } from '../kith.mjs';
import { bestPath, priced } from './delivery.mjs';

export const kScreens = {
  size: 3,
  keys: ['stop.max_periods=5'],
  group: `ask_name = true\ncompletion = { redirect = "https://example.org/done" }\nscreening = { tests = 1 }${kQuestions}`,
};

// Texts that would run or break out if they were ever taken for markup.
export const kHostile = [
  '<img src=x onerror="window.hacked=1">',
  '</p><script>window.hacked=1</script>',
  '"><svg onload=window.hacked=1>',
  "javascript:window.hacked=1//'",
  '{{constructor.constructor("window.hacked=1")()}}',
  '\u202e\u0000&lt;b&gt;<b>bold</b>',
];

const mapless = (n) => ({ domain: { id: 'dock' }, world: 3, start: { state: n === 0 ? 'far from the dock' : 'at the dock' } });

const kMaplessWorld = {
  key: 'mapless',
  actions: [
    { name: 'drive', label: 'drive on', dx: null, dy: null },
    { name: 'wait', label: 'wait', dx: null, dy: null },
    { name: 'dock', label: 'dock', dx: null, dy: null },
  ],
  frames: [{ state: 'far from the dock' }, { state: 'at the dock' }, { state: 'docked' }],
  next: [
    [1, 0, -1],
    [-1, 1, 2],
    [-1, -1, -1],
  ],
  end: [false, false, true],
  chance: true,
  may_repeat: false,
  max_actions: 60,
};

function largeBoard(domain, columns = 20, rows = 12) {
  const map = Array.from({ length: rows }, (_, y) =>
    Array.from({ length: columns }, (_, x) => (x === 0 && y === 11 ? 'G' : (x * 7 + y * 5) % 11 === 0 ? '#' : (x + 2 * y) % 7 === 0 ? 'r' : '.')).join(''),
  );
  map[3] = `${map[3].slice(0, 15)}B${map[3].slice(16)}`;
  const start = { robot: [10, 7], items: [{ name: 'parcel', cell: [18, 2], carried: false }], stations: [[16, 4]] };
  const { id, legend, surfaces } = domain;
  return { domain: { id, legend, surfaces, width: columns, height: rows }, world: 1, map, start };
}

// The robot can do nothing but walk.
function walks({ map, start: { robot, items, stations } }) {
  const kMoves = { up: [0, -1], down: [0, 1], left: [-1, 0], right: [1, 0] };
  const cells = map.flatMap((line, y) => [...line].flatMap((symbol, x) => (symbol === '#' ? [] : [[x + 1, y + 1]])));
  const number = new Map([robot, ...cells.filter((cell) => String(cell) !== String(robot))].map((cell, i) => [String(cell), i]));
  const places = [...number.keys()].map((cell) => cell.split(',').map(Number));
  return {
    key: 'walks',
    actions: Object.entries(kMoves).map(([name, [dx, dy]]) => ({ name, label: name, dx, dy })),
    items: [items[0].name],
    stations,
    frames: places.map((cell) => [...cell, [[...items[0].cell, 0]], stations.map((_, i) => i)]),
    next: places.map(([x, y]) => Object.values(kMoves).map(([dx, dy]) => number.get(String([x + dx, y + dy])) ?? -1)),
    end: places.map(() => false),
    chance: false,
    may_repeat: false,
    max_actions: 60,
  };
}

// The robot can only go right, and has fallen into a hole then.
function holeWorld({ start: { robot: [column, row], items } }) {
  const item = [...items[0].cell, 0];
  return {
    key: 'hole',
    actions: [{ name: 'right', label: 'right', dx: 1, dy: 0 }],
    items: [items[0].name],
    stations: [],
    frames: [0, 1].map((dx) => [column + dx, row, [item], []]),
    next: [[1], [-1]],
    end: [false, true],
    chance: false,
    may_repeat: false,
    max_actions: 60,
  };
}

// Places in a row, each covered by another terrain, of which some have the tint or the pattern of another.
function patchwork({ id }) {
  const tints = ['brown', 'blue', 'green', 'purple', 'grey', 'orange', 'red', 'yellow'];
  const patterns = ['dots', 'lines', 'cross', 'waves'];
  const surfaces = Array.from({ length: 12 }, (_, i) => ({
    name: `terrain ${i + 1}`,
    tint: tints[i % 8],
    pattern: patterns[(i + Math.floor(i / 8)) % 4],
  }));
  const symbols = [...'abcdefghijkl'];
  const legend = surfaces.map(({ name }, i) => ({ symbol: symbols[i], kind: 'terrain', name, parts: [{ kind: 'terrain', name }] }));
  const start = { robot: [1, 1], items: [], stations: [] };
  return { domain: { id, legend, surfaces, width: 12, height: 1 }, world: 1, map: [symbols.join('')], start };
}

// Two cells, of which the first holds an item that can be picked up and put down wherever the robot is.
function handlingWorld({ start: { robot: [column, row], items } }, mayRepeat) {
  const frame = (dx, carried) => [column + dx, row, [[column + (carried ? dx : 0), row, carried]], []];
  return {
    key: 'handling',
    actions: [
      { name: 'left', label: 'left', dx: -1, dy: 0 },
      { name: 'right', label: 'right', dx: 1, dy: 0 },
      { name: 'pickup', label: 'pick up', dx: null, dy: null },
      { name: 'dropoff', label: 'put down', dx: null, dy: null },
    ],
    items: [items[0].name],
    stations: [],
    frames: [frame(0, 0), frame(1, 0), frame(0, 1), frame(1, 1)],
    next: [
      [-1, 1, 2, -1],
      [0, -1, -1, -1],
      [-1, 3, -1, 0],
      [2, -1, -1, -1],
    ],
    end: [false, false, false, false],
    chance: false,
    may_repeat: mayRepeat,
    max_actions: 8,
  };
}

// What three people see by the name of a screen. At first one of them ends paths as soon as can be, another after a step.
async function record(modules, server) {
  const people = [];
  for (let i = 0; i < 3; i += 1) people.push(await Client.join(modules, server));
  const chosen = [shortestFinish, (world, start) => bestPath(world, start).actions.slice(0, 1), undefined];
  await play(people, (i) => (people[i].view.progress?.round === 1 ? chosen[i] : undefined));
  const [first, second, third] = people.map(({ views }) => views);
  const at = (views, stage, fits = () => true) => {
    const found = views.find((view) => view.stage === stage && fits(view));
    if (!found) throw new Error(`nobody has seen ${stage}`);
    return found;
  };
  const isWorse = ({ feedback: { tests } }) => tests.every(({ right, unfinished, differs_at }) => !right && !unfinished && differs_at !== null);
  const wrong = at(first, 'feedback', isWorse);
  const predict = first.slice(0, first.indexOf(wrong)).findLast(({ stage, predict: task }) => stage === 'predict' && task.index === 0);
  const table = await people[0].world(predict.predict.world);
  people.forEach((person) => person.close());
  return {
    table,
    wrong,
    right: at(third, 'feedback'),
    short: at(second, 'feedback'),
    predict,
    station: [...first, ...second].find(({ watch }) => watch?.board.start.stations.length > 0 && watch.frames.at(-1).stations.length === 0),
    at: (stage, what) => at(first, stage, (view) => !what || view.wait?.for === what),
  };
}

// {views, tables}: {name: view}, and {key: table of moves} of worlds that the server does not know.
export async function makeViews(modules, server) {
  const seen = await record(modules, server);
  const now = Date.now();
  const { at, predict, table } = seen;
  const { study, me, group, lang } = predict;
  const page = (stage, rest) => ({ stage, lang, study, me, group, notices: [], server_ms: now, ...rest });
  const end = (reason, text, code) => page(reason, { end: { reason, text, code } });
  const waiting = (what) => ({ ...at('wait'), wait: { ...at('wait').wait, for: what } });
  const none = structuredClone(seen.wrong);
  none.feedback.tests = none.feedback.tests.map(({ mine, differs_at, cost, ...rest }) => ({ ...rest, mine: null, differs_at: null }));
  const notices = [{ text: 'We continue in two minutes. Please stay on this page.', at_ms: now - 5000 }];
  const tables = {};
  const views = {
    consent: at('consent'),
    check: at('check'),
    screening: at('screening'),
    lobby: { ...at('lobby'), server_ms: now, lobby: { present: 2, size: 3, since_ms: now - 65_000, leave_after_ms: now + 235_000 } },
    'lobby-leave': { ...at('lobby'), server_ms: now, lobby: { present: 1, size: 3, since_ms: now - 65_000, leave_after_ms: now - 1000 } },
    watch: at('watch'),
    'watch-station': seen.station,
    predict,
    'predict-draft': { ...predict, predict: { ...predict.predict, draft: bestPath(priced(table), predict.predict.start).actions.slice(0, 4) } },
    wait: at('wait', 'answers'),
    'wait-watching': at('wait', 'others-watching'),
    'wait-teacher': waiting('teacher'),
    'wait-joining': waiting('joining'),
    'wait-rejoining': waiting('rejoining'),
    'feedback-wrong': seen.wrong,
    'feedback-short': seen.short,
    'feedback-right': seen.right,
    'feedback-none': none,
    questions: at('questions'),
    debrief: { ...at('debrief'), debrief: { ...at('debrief').debrief, not_reached: ['a step costs more than nothing'] } },
    ended: end('ended', 'The session of your group ended early', 'KITH-ENDED'),
    declined: end('declined', ''),
    full: end('full', '', 'KITH-FULL'),
    replaced: end('replaced', '', 'KITH-AWAY'),
    notice: { ...predict, notices },
    pause: { ...predict, pause: { why: 'someone-away', since_ms: now - 20_000, until_ms: now + 70_000, missing: 1 } },
    'pause-organiser': { ...at('watch'), pause: { why: 'facilitator', since_ms: now - 20_000, missing: 0 } },
    unknown: { ...at('watch'), stage: 'something-new' },
  };
  views['predict-limit'] = structuredClone(views.predict);
  views['predict-limit'].limit_ms = now + 25_000;
  const { domain } = predict.predict.board;
  const large = largeBoard(domain);
  views.exam = { ...views.predict, stage: 'exam', progress: undefined, predict: { ...views.predict.predict, of: 12, draft: [] } };
  views['predict-large'] = { ...views.predict, predict: { ...views.predict.predict, board: large, world: 'large', start: 0, draft: [] } };
  tables.hole = holeWorld(large);
  tables.large = walks(large);
  const huge = largeBoard(domain, 60, 40);
  views['predict-huge'] = { ...views.predict, predict: { ...views.predict.predict, board: huge, world: 'huge', start: 0, draft: [] } };
  tables.huge = walks(huge);
  const { frames: straight } = views.watch.watch;
  const [from] = straight;
  const slip = [{ ...from, action: from.action === 'left' ? 'right' : 'left' }, { ...straight[1], action: null }];
  const runs = { text: 'stopping at the charger in 1 of 2 runs; a different path in each of 2 runs', runs: [{ frames: slip, ended: true }, { frames: straight, ended: true }] };
  views['watch-runs'] = { ...views.watch, watch: { ...views.watch.watch, runs } };
  views['feedback-chance'] = structuredClone(views['feedback-wrong']);
  const [slipped] = views['feedback-chance'].feedback.tests;
  const own = table.actions.findIndex(({ name }) => name === slipped.robot[slipped.differs_at].action);
  const counts = (domain.counted ?? []).map(() => 0);
  const outcomes = table.next.map((row, s) =>
    row.map((to, action) => to < 0 ? null : [[to, 2 / 3, counts], [s, 1 / 3, counts.map((_, k) => Number(k === 0 && action !== own))]]),
  );
  tables.slippery = { ...table, key: 'slippery', outcomes };
  slipped.chance = { world: 'slippery', state: predict.predict.start, spared: [0] };
  const { board: small } = views.predict.predict;
  tables.handling = handlingWorld(small, false);
  tables.endless = handlingWorld(small, true);
  views['predict-handling'] = { ...views.predict, predict: { ...views.predict.predict, world: 'handling', start: 0, draft: [] } };
  views['predict-full'] = { ...views.predict, predict: { ...views.predict.predict, world: 'handling', start: 0, draft: [1, 0, 1, 0, 1] } };
  views['predict-endless'] = { ...views.predict, predict: { ...views.predict.predict, world: 'endless', start: 0, draft: [1, 0] } };
  views['watch-endless'] = { ...views.watch, watch: { index: 0, of: 1, board: views.watch.watch.board, ...endless(views.watch.watch) } };
  const { frames: endlessFrames, ...repeats } = endless(views.watch.watch);
  views['feedback-endless'] = structuredClone(views['feedback-short']);
  Object.assign(views['feedback-endless'].feedback.tests[0], {
    board: views.watch.watch.board,
    mine: endlessFrames.slice(0, 2).map((frame, i) => ({ ...frame, action: i === 0 ? frame.action : null })),
    robot: endlessFrames,
    robot_repeats_from: repeats.repeats_from,
    robot_repeats_text: repeats.repeats_text,
    differs_at: 1,
  });
  const { progress, ...shownTest } = views['feedback-wrong'];
  const [compared] = shownTest.feedback.tests;
  const discuss = {
    index: 0,
    of: 2,
    board: compared.board,
    predictions: [
      { frames: compared.robot, own: false, n: 2 },
      { frames: compared.mine, own: true, n: 1 },
    ],
  };
  views.discuss = { ...views.predict, stage: 'discuss', progress, predict: undefined, discuss };
  views['discuss-none'] = structuredClone(views.discuss);
  views['discuss-none'].discuss.predictions[1].own = false;
  views['wait-discussion'] = structuredClone(views.wait);
  views['wait-discussion'].wait.for = 'discussion';
  views['feedback-others'] = structuredClone(views['feedback-right']);
  Object.assign(views['feedback-others'].feedback, { all_right: true, learned: false, others_unsure: true });
  views.patchwork = { ...views.watch, watch: { ...views.watch.watch, board: patchwork(domain), frames: [{ robot: [1, 1], items: [], stations: [] }] } };
  tables.mapless = kMaplessWorld;
  const frame = (state, action) => ({ state, action });
  const way = [frame('far from the dock', 'drive'), frame('at the dock', 'wait'), frame('at the dock', 'dock'), frame('docked', null)];
  const plain = [frame('far from the dock', 'drive'), frame('at the dock', 'dock'), frame('docked', null)];
  views['mapless-watch'] = { ...views.watch, watch: { index: 0, of: 1, board: mapless(0), frames: way } };
  views['mapless-predict'] = { ...views.predict, predict: { ...views.predict.predict, board: mapless(0), world: 'mapless', start: 0, draft: [0] } };
  views['mapless-feedback'] = {
    ...views['feedback-wrong'],
    feedback: {
      tests: [{ board: mapless(0), right: false, mine: plain, robot: way, differs_at: 1, unfinished: false, why: ['waiting is safer'], cost: 'One step too few' }],
      all_right: false,
      learned: true,
      others_unsure: false,
    },
  };
  return { views, tables };
}

// Of a path: its first move, and then there and back for ever.
function endless({ frames: [a, b, c] }) {
  const back = { up: 'down', down: 'up', left: 'right', right: 'left' }[b.action];
  return { frames: [a, b, { ...c, action: back }, { ...b, action: null }], repeats_from: 1, repeats_text: 'it never delivers the parcel' };
}

// The fewest steps to an end, whatever they cost.
function shortestFinish({ table }, start) {
  const before = new Map([[start, null]]);
  for (const [state] of before) {
    if (table.end[state]) {
      const actions = [];
      for (let at = before.get(state); at; at = before.get(at.state)) actions.unshift(at.action);
      return actions;
    }
    table.next[state].forEach((to, action) => to >= 0 && !before.has(to) && before.set(to, { state, action }));
  }
  throw new Error('no way to the end');
}

// A view with hostile texts wherever the server sends a text.
export function hostileView(view, text) {
  const taint = (value, key) => {
    if (Array.isArray(value)) return value.map((one) => taint(one, key));
    if (value && typeof value === 'object') return Object.fromEntries(Object.entries(value).map(([name, one]) => [name, taint(one, name)]));
    const isText = typeof value === 'string' && !['stage', 'dir', 'lang', 'kind', 'symbol', 'map', 'world', 'why-kind', 'for', 'action', 'id', 'reason'].includes(key);
    return isText ? (key === 'why' && ['someone-away', 'facilitator', 'teacher'].includes(value) ? value : text) : value;
  };
  return taint(view, '');
}

