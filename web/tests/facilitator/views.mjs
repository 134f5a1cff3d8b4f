// Synthetic views of a server with rooms: for the mock of the server and for screenshots.
import { readFileSync } from 'node:fs';
import { makeRandom } from '../../sample/random.mjs';

const lesson = JSON.parse(readFileSync(new URL('../../sample/lesson.json', import.meta.url), 'utf8'));
const { id, legend, surfaces, width, height } = lesson.domain;
const domain = { id, legend, surfaces, width, height };
const kSecond = 1000;
const kMinute = 60 * kSecond;

const normalise = (v) => v.map((x) => x / Math.hypot(...v));
const dot = (a, b) => a.reduce((sum, x, i) => sum + x * b[i], 0);
const truth = normalise([-3, 3.5, -1]);
const bec = [
  [-0.194134, 0.963171, -0.186047],
  [-0.438098, 0.755607, -0.486957],
  [-0.851214, 0.381348, -0.360565],
  [-0.899102, 0.437217, -0.021361],
  [-0.519174, 0.850196, 0.087328],
];
const prior = Array.from({ length: 24 }, (_, i) => [Math.cos((-i * Math.PI) / 12), Math.sin((-i * Math.PI) / 12), 0]);

// 300 particles of a belief that is drawn to the truth by `pull`, as base64 of int16.
function cloud(random, pull) {
  const data = new Int16Array(900);
  for (let i = 0; i < 300; ++i) {
    let w;
    do {
      w = normalise([0, 1, 2].map((j) => 2.4 * pull * truth[j] + random.normal() * (1.05 - 0.55 * pull)));
    } while (dot(w, [0, 0, -1]) < 0);
    w.forEach((x, j) => (data[3 * i + j] = Math.round(32767 * x)));
  }
  return Buffer.from(data.buffer).toString('base64');
}

const boardOf = ({ world, map, start }) => ({ domain, world, map, start });
const textsOf = (sentences) => sentences.map(({ text }) => text);

function lessonOf(component) {
  const { demonstrations, tests } = lesson.components[component % lesson.components.length];
  const others = lesson.components.flatMap(({ demonstrations: all, tests: more }) => [...all, ...more]);
  return {
    source: 'joint belief',
    why: 'the joint belief still allows rubble to cost less than 2 steps. This demonstration removes the largest part of what is left and needs the fewest new facts.',
    demonstrations: demonstrations.map((one, i) => ({
      board: boardOf(one),
      frames: one.frames,
      gain: [6.78, 2.66, 1.9][i % 3],
      sentences: textsOf(one.conveys),
    })),
    tests: tests.map((one) => ({ board: boardOf(one), frames: one.frames, sentences: textsOf(one.covers) })),
    runners_up: others.slice(1, 6).map((one, i) => ({
      board: boardOf(one),
      gain: [6.1, 4.75, 4.4, 3.1, 2.02][i],
      sentences: textsOf(one.conveys ?? one.covers),
    })),
  };
}

const kStrategies = [
  { name: 'joint', description: 'for what the members know together' },
  { name: 'common', description: 'for what every member knows' },
  { name: 'individual-low', description: 'for the member who knows least' },
];
const kTypes = [
  { letter: 'N', label: 'novice' },
  { letter: 'P', label: 'proficient' },
];
const kNames = ['Ada', 'Ben', 'Chidi', 'Dana', 'Emre', 'Fatima', 'Georg', 'Hana', 'Ines', 'Jun', 'Kofi', 'Lena'];
const letterOf = (seat) => String.fromCharCode(64 + seat);

function seatsOf(random, now, room, size, stage) {
  return Array.from({ length: size }, (_, i) => {
    const seat = i + 1;
    const isSimulated = size > 2 && i === size - 1;
    const isAway = stage === 'paused' && i === 1;
    const row = {
      seat,
      label: `Learner ${letterOf(seat)}`,
      kind: isSimulated ? 'simulated' : 'person',
      type: i % 3 === 2 ? 'P' : 'N',
      presence: isAway ? 'away' : stage === 'lobby' && i > 1 && !isSimulated ? 'empty' : 'here',
      since_ms: now - (isAway ? 34 * kSecond : Math.round(random.uniform() * 50) * kSecond),
      stage: stage === 'lobby' ? 'lobby' : stage === 'ended' ? 'debrief' : i % 4 === 1 ? 'wait' : 'predict',
      estimate: 0.66 + 0.2 * random.uniform(),
    };
    if (isSimulated) return row;
    return {
      ...row,
      name: kNames[i % kNames.length],
      latency_ms: 18 + Math.round(70 * random.uniform()),
      link: `http://127.0.0.1:8080/j#t=${room}seat${seat}-0123456789abcdefABCD`,
      ...(stage === 'ended' ? { code: `KITH-${room}-${seat}` } : {}),
    };
  });
}

export function roomRow(random, now, room, { size = 3, stage = 'running', strategy = 'joint', period = 6, ended } = {}) {
  return {
    id: room,
    code: room.toUpperCase(),
    stage,
    strategy,
    seats: seatsOf(random, now, room, size, stage),
    period: stage === 'lobby' ? 0 : period,
    component: 2,
    ...(stage === 'lobby' ? {} : { started_ms: now - 14 * kMinute - 12 * kSecond }),
    ...(ended ? { ended } : {}),
    ...(stage === 'running' || stage === 'paused' ? { forecast: { periods: 4, minutes_low: 7, minutes_high: 12 } } : {}),
  };
}

export function roomDetail(random, now, row) {
  const { period, seats, stage } = row;
  const answers = [];
  for (let p = 1; p <= period; ++p) {
    for (const { seat } of seats) {
      for (let test = 1; test <= (p === 1 ? 1 : 2); ++test) {
        if (p === period && seat % 4 !== 2) continue;
        const right = random.uniform() < 0.35 + 0.08 * p;
        answers.push({
          seat,
          period: p,
          test,
          right,
          regret: right ? 0 : Number((0.2 + random.uniform()).toFixed(3)),
          ms: Math.round(4000 + 26000 * random.uniform()),
          stopped_short: !right && random.uniform() < 0.15,
        });
      }
    }
  }
  const speed = seats.map(() => 0.6 + 0.5 * random.uniform());
  const pullAt = (p, i) => Math.min(1, (p / (period + 4)) * speed[i]);
  const share = (pull) => Number(Math.min(0.98, 0.02 + 0.9 * pull ** 1.3).toFixed(3));
  const curves = Array.from({ length: period }, (_, p) => ({
    period: p,
    p_bec: {
      ...Object.fromEntries(seats.map(({ seat }, i) => [`member ${seat}`, share(pullAt(p, i))])),
      ...(seats.length > 1 ? { common: share(0.75 * pullAt(p, 0)), joint: share(Math.min(1, 1.3 * pullAt(p, 0))) } : {}),
    },
    right:
      p === 0
        ? {}
        : Object.fromEntries(
            seats.map(({ seat }) => {
              const own = answers.filter((answer) => answer.seat === seat && answer.period <= p);
              return [seat, own.length === 0 ? 0 : own.filter(({ right }) => right).length / own.length];
            }),
          ),
  }));
  const named = [...seats.map(({ seat }) => `member ${seat}`), ...(seats.length > 1 ? ['common', 'joint'] : [])];
  return {
    id: row.id,
    session: {
      period,
      component: 2,
      components: [
        { name: 'rubble', status: stage === 'lobby' ? 'open' : 'learned' },
        { name: 'recharge', status: 'open' },
        { name: 'rubble and recharge', status: 'open' },
      ],
      phase: 'predict',
    },
    ...(stage === 'lobby' ? {} : { lesson: lessonOf(1) }),
    answers,
    curves: stage === 'lobby' ? [] : curves,
    people:
      stage === 'running' || stage === 'paused'
        ? seats.map((_, i) => ({
            seat: i + 1,
            member: i + 1,
            tests: answers.filter(({ seat }) => seat === i + 1).length,
            right: answers.filter(({ seat, right }) => seat === i + 1 && right).length,
            knows: share(pullAt(period, i)),
            components: [{ name: 'rubble', understanding: 'cannot-tell', verdict: 'cannot tell yet: the answers do not decide it', level: share(pullAt(period, i)) }],
            ...(i % 3 === 2 ? {} : { thinks: `crossing rubble costs at most ${1 + (i % 4)} steps`, probability: 0.42 }),
          }))
        : [],
    beliefs: named.map((name, i) => ({ name, points: cloud(random, pullAt(period, Math.min(i, seats.length - 1))) })),
    truth: { weights: truth, bec, prior, features: ['rubble', 'recharge', 'step'] },
    timers: [
      { name: 'phase', since_ms: now - 42 * kSecond },
      ...(stage === 'paused' ? [{ name: 'away: Learner B', since_ms: now - 34 * kSecond, until_ms: now + 56 * kSecond }] : []),
    ],
  };
}

const kStages = ['running', 'running', 'lobby', 'running', 'paused', 'questions', 'running', 'ended'];

// `sizes`: of the first rooms; others have three seats.
export function makeView({ role = 'facilitator', rooms = 8, sizes = [3, 12, 1], selected = null, now = Date.now(), stages = [], periods = [] } = {}) {
  const random = makeRandom(7);
  const rows = Array.from({ length: rooms }, (_, i) => {
    const stage = stages[i] ?? kStages[i % kStages.length];
    return roomRow(random, now, `a${i + 1}`, {
      size: sizes[i] ?? 3,
      stage,
      strategy: kStrategies[i % 3].name,
      period: periods[i] ?? (i === 1 ? 9 : 6),
      ...(stage === 'ended' ? { ended: 'everything learned' } : {}),
    });
  });
  const chosen = rows.find((row) => row.id === selected);
  const view = {
    v: 1,
    role,
    server_ms: now,
    study: {
      id: 'delivery-live',
      title: 'Learn how a robot works: group study',
      domain: 'item-delivery',
      strategies: kStrategies,
      compositions: ['NNN', 'NNP', 'NPP', 'PPP'],
      types: kTypes,
      dropout: 'pause-then-continue',
      grace_s: 90,
      stores: { names: true, text: true, questions: true, query: ['PROLIFIC_PID'], screening: false, discussion: false },
      time: { watch_s: 0, predict_s: 0, feedback_s: 0, lobby_s: 1200, leave_after_s: 300, max_minutes: 60 },
    },
    links: {
      facilitator: 'http://127.0.0.1:8080/f#t=facilitator-0123456789',
      observer: 'http://127.0.0.1:8080/f#t=observer-0123456789abcd',
      join: 'http://127.0.0.1:8080/j#c=K7MQ2P',
      code: 'K7MQ2P',
    },
    rooms: rows,
    ...(chosen ? { room: roomDetail(random, now, chosen) } : {}),
    log: [
      { at_ms: now - 15 * kMinute, room: 'a1', actor: 'facilitator', what: 'made the room', reason: 'Set-up' },
      { at_ms: now - 14 * kMinute, room: 'a1', actor: 'server', what: 'started: all seats are taken' },
      { at_ms: now - 9 * kMinute, room: 'a2', actor: 'facilitator', what: 'paused the room', reason: 'A participant has a question' },
      { at_ms: now - 8 * kMinute, room: 'a2', actor: 'facilitator', what: 'resumed the room', reason: 'The problem is solved' },
      { at_ms: now - 34 * kSecond, room: 'a5', actor: 'seat:2', what: 'is away' },
    ],
    integrity: { events: 4711, stored: 4711, unsaved: 0, free_mb: 51_234, last_commit_ms: now - 2 * kSecond, problems: [] },
  };
  return role === 'observer' ? forObserver(view) : view;
}

export function forObserver({ links: _, ...view }) {
  return {
    ...view,
    rooms: view.rooms.map(({ code: _code, ...room }) => ({
      ...room,
      seats: room.seats.map(({ name: _n, link: _l, code: _c, ...seat }) => seat),
    })),
  };
}
