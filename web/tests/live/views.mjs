// Views of every screen, as a server would send them: for looks, accessibility and hostile texts.
import { framesOf, judge, makeWorld } from './delivery.mjs';
import { Room } from './room.mjs';

export const kQuestions = [
  { id: 'clear', kind: 'likert', text: 'How clear was the lesson?', low: 'not at all', high: 'very', required: true },
  { id: 'pace', kind: 'likert', text: 'How was the pace?', options: ['too slow', 'right', 'too fast'], required: false },
  { id: 'robots', kind: 'choice', text: 'Have you worked with robots before?', options: ['never', 'sometimes', 'often'], required: true },
  { id: 'free', kind: 'text', text: 'What was hard to understand?', required: false },
];

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

// {name: view}; `now` is the server's time.
export function makeViews(lesson, now = Date.now()) {
  const room = new Room(lesson, { size: 3, screening: 1, parts: 3, questions: kQuestions, askName: true, redirect: 'https://example.org/done' });
  const at = (stage, rest = {}) => {
    Object.assign(room.seats[0], { stage, index: 0, since: now - 65_000, draft: [], answers: [], ...rest });
    return { ...structuredClone(room.view(1)), server_ms: now };
  };
  const { tests } = room.parts[0];
  const [{ world, best }] = tests;
  const names = world.table.actions.map(({ name }) => name);
  const wrong = ['right', 'down', 'pickup', 'left', 'left', 'left', 'dropoff'];
  const answerOf = (actions) => [{ actions, ...judge(world, 0, actions) }];
  const wrongPath = shortestFinish(world);
  const notices = [{ text: 'We continue in two minutes. Please stay on this page.', at_ms: now - 5000 }];
  room.learned = false;
  const views = {
    consent: at('consent'),
    check: at('check'),
    screening: at('screening'),
    lobby: at('lobby', { present: true }),
    'lobby-leave': at('lobby'),
    watch: at('watch'),
    predict: at('predict'),
    'predict-draft': at('predict', { draft: best.actions.slice(0, 4) }),
    wait: at('wait', { waitsFor: 'answers' }),
    'wait-teacher': at('wait', { waitsFor: 'teacher' }),
    'wait-joining': at('wait', { waitsFor: 'joining' }),
    'wait-rejoining': at('wait', { waitsFor: 'rejoining' }),
    'feedback-wrong': at('feedback', { answers: answerOf(wrongPath) }),
    'feedback-short': at('feedback', { answers: answerOf([names.indexOf(wrong[0])].filter((a) => world.table.next[0][a] >= 0)) }),
    'feedback-right': at('feedback', { answers: answerOf(best.actions) }),
    'feedback-none': at('feedback'),
    questions: at('questions'),
    debrief: at('debrief', { right: 3, tests: 4 }),
    ended: { ...at('ended'), end: { reason: 'left', text: 'The session of your group ended early', code: 'MOCK-ENDED' } },
    declined: at('declined'),
    full: { ...at('full'), end: { reason: 'full', text: '', code: 'MOCK-FULL' } },
    replaced: { ...at('replaced'), end: { reason: 'replaced', text: '', code: 'MOCK-AWAY' } },
    notice: { ...at('predict'), notices },
    pause: { ...at('predict'), pause: { why: 'someone-away', since_ms: now - 20_000, until_ms: now + 70_000, missing: 1 } },
    'pause-organiser': { ...at('watch'), pause: { why: 'facilitator', since_ms: now - 20_000, missing: 0 } },
    unknown: { ...at('watch'), stage: 'something-new' },
  };
  views['lobby-leave'].lobby.leave_after_ms = now - 1000;
  views['predict-limit'] = structuredClone(views.predict);
  views['predict-limit'].limit_ms = now + 25_000;
  const large = largeBoard(lesson.domain);
  views.exam = { ...views.predict, stage: 'exam', progress: undefined, predict: { ...views.predict.predict, of: 12, draft: [] } };
  views['predict-large'] = { ...views.predict, predict: { ...views.predict.predict, board: large, world: 'large' } };
  room.worlds.set('hole', { table: holeWorld(large) });
  room.worlds.set('large', makeWorld(large.domain, large, 'large'));
  const huge = largeBoard(lesson.domain, 60, 40);
  views['predict-huge'] = { ...views.predict, predict: { ...views.predict.predict, board: huge, world: 'huge' } };
  room.worlds.set('huge', makeWorld(huge.domain, huge, 'huge'));
  const { frames: straight } = views.watch.watch;
  const [from] = straight;
  const slip = [{ ...from, action: from.action === 'left' ? 'right' : 'left' }, { ...straight[1], action: null }];
  const runs = { text: 'stopping at the charger in 1 of 2 runs; a different path in each of 2 runs', runs: [{ frames: slip, ended: true }, { frames: straight, ended: true }] };
  views['watch-runs'] = { ...views.watch, watch: { ...views.watch.watch, runs } };
  views['feedback-chance'] = structuredClone(views['feedback-wrong']);
  const [slipped] = views['feedback-chance'].feedback.tests;
  const slippery = makeWorld(slipped.board.domain, slipped.board, 'slippery');
  const { table } = slippery;
  const own = table.actions.findIndex(({ name }) => name === slipped.robot[slipped.differs_at].action);
  const counts = (slipped.board.domain.counted ?? []).map(() => 0);
  table.outcomes = table.next.map((row, s) =>
    row.map((to, action) => to < 0 ? null : [[to, 2 / 3, counts], [s, 1 / 3, counts.map((_, k) => Number(k === 0 && action !== own))]]),
  );
  slipped.chance = { world: 'slippery', state: 0, spared: [0] };
  room.worlds.set('slippery', slippery);
  const { board: small } = views.predict.predict;
  room.worlds.set('handling', { table: handlingWorld(small, false) });
  room.worlds.set('endless', { table: handlingWorld(small, true) });
  views['predict-handling'] = { ...views.predict, predict: { ...views.predict.predict, world: 'handling', draft: [] } };
  views['predict-full'] = { ...views.predict, predict: { ...views.predict.predict, world: 'handling', draft: [1, 0, 1, 0, 1] } };
  views['predict-endless'] = { ...views.predict, predict: { ...views.predict.predict, world: 'endless', draft: [1, 0] } };
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
  views.patchwork = { ...views.watch, watch: { ...views.watch.watch, board: patchwork(lesson.domain), frames: [{ robot: [1, 1], items: [], stations: [] }] } };
  room.worlds.set('mapless', { table: kMaplessWorld });
  const frame = (state, action) => ({ state, action });
  const way = [frame('far from the dock', 'drive'), frame('at the dock', 'wait'), frame('at the dock', 'dock'), frame('docked', null)];
  const plain = [frame('far from the dock', 'drive'), frame('at the dock', 'dock'), frame('docked', null)];
  views['mapless-watch'] = { ...views.watch, watch: { index: 0, of: 1, board: mapless(0), frames: way } };
  views['mapless-predict'] = { ...views.predict, predict: { ...views.predict.predict, board: mapless(0), world: 'mapless', draft: [0] } };
  views['mapless-feedback'] = {
    ...views['feedback-wrong'],
    feedback: {
      tests: [{ board: mapless(0), right: false, mine: plain, robot: way, differs_at: 1, unfinished: false, why: ['waiting is safer'], cost: 'One step too few' }],
      all_right: false,
      learned: true,
      others_unsure: false,
    },
  };
  return { views, room };
}

// Of a path: its first move, and then there and back for ever.
function endless({ frames: [a, b, c] }) {
  const back = { up: 'down', down: 'up', left: 'right', right: 'left' }[b.action];
  return { frames: [a, b, { ...c, action: back }, { ...b, action: null }], repeats_from: 1, repeats_text: 'it never delivers the parcel' };
}

// A finished path that is not the best: the fewest steps, whatever they cost.
function shortestFinish({ table }) {
  const before = new Map([[0, null]]);
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

export const framesOfPath = (world, actions) => framesOf(world, judge(world, 0, actions).states, actions);
