// Item delivery without kith: moves, costs and the best paths, for a server that plays a session and for people who
// answer. The sample lesson's paths are checked against it.
const kActions = [
  { name: 'up', label: 'up', dx: 0, dy: -1 },
  { name: 'down', label: 'down', dx: 0, dy: 1 },
  { name: 'left', label: 'left', dx: -1, dy: 0 },
  { name: 'right', label: 'right', dx: 1, dy: 0 },
  { name: 'pickup', label: 'pick up', dx: null, dy: null },
  { name: 'dropoff', label: 'drop off', dx: null, dy: null },
];
const kCosts = { step: 1, rubble: 3, charger: -3.5 };

function partsAt(domain, map, [column, row]) {
  const symbol = map[row - 1]?.[column - 1];
  return domain.legend.filter((entry) => entry.symbol === symbol).flatMap(({ parts }) => parts);
}

// The state after an action, or null if nothing happens. A state is {robot, item, carried, stations, done}.
function after(domain, map, state, action) {
  const { dx, dy, name } = kActions[action];
  if (state.done) return null;
  if (dx !== null) {
    const robot = [state.robot[0] + dx, state.robot[1] + dy];
    const isInside = robot[0] >= 1 && robot[1] >= 1 && robot[0] <= domain.width && robot[1] <= domain.height;
    if (!isInside || partsAt(domain, map, robot).some(({ kind }) => kind === 'wall')) return null;
    const stations = state.stations.filter((cell) => cell.join() !== state.robot.join());
    return { ...state, robot, item: state.carried ? robot : state.item, stations };
  }
  if (name === 'pickup') {
    const isThere = !state.carried && state.item.join() === state.robot.join();
    return isThere ? { ...state, carried: true } : null;
  }
  const isPlace = partsAt(domain, map, state.robot).some(({ kind }) => kind === 'destination');
  return state.carried && isPlace ? { ...state, carried: false, done: true } : null;
}

// Rubble, charger, step.
function countsOf(domain, map, state, action) {
  const isMove = kActions[action].dx !== null;
  const isRubble = partsAt(domain, map, state.robot).some(({ name }) => name === 'rubble');
  const isCharging = state.stations.some((cell) => cell.join() === state.robot.join());
  return [isMove && isRubble ? 1 : 0, isMove && isCharging ? 1 : 0, 1];
}

function costOf(domain, map, state, action) {
  const [rubble, charger, step] = countsOf(domain, map, state, action);
  return kCosts.step * step + kCosts.rubble * rubble + kCosts.charger * charger;
}

const stateOf = ({ robot, items, stations }) => ({
  robot,
  item: items[0].cell,
  carried: items[0].carried,
  stations: stations ?? [],
  done: false,
});

// All that can be reached from a frame, as GET /api/world/KEY gives it, with the costs beside it.
export function makeWorld(domain, board, key) {
  const states = [stateOf(board.start)];
  const numbers = new Map([[JSON.stringify(states[0]), 0]]);
  const [next, costs] = [[], []];
  for (let i = 0; i < states.length; i += 1) {
    costs.push(kActions.map((_, action) => costOf(domain, board.map, states[i], action)));
    next.push(
      kActions.map((_, action) => {
        const to = after(domain, board.map, states[i], action);
        if (!to) return -1;
        const text = JSON.stringify(to);
        if (!numbers.has(text)) {
          numbers.set(text, states.length);
          states.push(to);
        }
        return numbers.get(text);
      }),
    );
  }
  const stations = board.start.stations ?? [];
  const compact = (state) => [
    ...state.robot,
    [[...state.item, state.carried ? 1 : 0]],
    stations.flatMap((cell, i) => (state.stations.some((one) => one.join() === cell.join()) ? [i] : [])),
  ];
  // rubble, charger, step: what the sample lesson counts
  const kinds = [];
  const kindOf = (counts) => {
    if (!kinds.some((one) => String(one) === String(counts))) kinds.push(counts);
    return kinds.findIndex((one) => String(one) === String(counts));
  };
  const table = {
    key,
    actions: kActions,
    items: [board.start.items[0].name],
    stations,
    frames: states.map(compact),
    next,
    end: states.map(({ done }) => done),
    counts: states.map((state, i) =>
      kActions.map((_, action) => (next[i][action] < 0 ? '-' : kindOf(countsOf(domain, board.map, state, action)))).join(''),
    ),
    kinds,
    chance: false,
    may_repeat: false,
    max_actions: 60,
  };
  return { table, costs };
}

// A table of moves with its costs, for any world of item delivery.
export function priced({ domain, map }, table) {
  const costs = table.frames.map(([column, row, , stations]) => {
    const state = { robot: [column, row], stations: stations.map((index) => table.stations[index]) };
    return table.actions.map((_, action) => costOf(domain, map, state, action));
  });
  return { table, costs };
}

// The cheapest path to an end: Bellman-Ford, since charging has a negative cost. Rewarded cycles do not exist: a
// charger is gone once the robot has left it.
export function bestPath({ table, costs }, start = 0) {
  const best = table.next.map(() => ({ cost: Infinity, from: -1, action: -1 }));
  best[start].cost = 0;
  for (let changed = true; changed; ) {
    changed = false;
    table.next.forEach((row, state) =>
      row.forEach((to, action) => {
        const cost = best[state].cost + costs[state][action];
        if (to < 0 || cost >= best[to].cost - 1e-9) return;
        best[to] = { cost, from: state, action };
        changed = true;
      }),
    );
  }
  const ends = table.end.flatMap((isEnd, state) => (isEnd ? [state] : []));
  const end = ends.reduce((a, b) => (best[b].cost < best[a].cost ? b : a));
  const actions = [];
  for (let at = end; at !== start; at = best[at].from) actions.unshift(best[at].action);
  return { actions, cost: best[end].cost };
}

// The states of a path, and what it costs; legal: every action did something.
export function judge({ table, costs }, start, actions) {
  const states = [start];
  let cost = 0;
  for (const action of actions) {
    const from = states[states.length - 1];
    const to = table.next[from]?.[action] ?? -1;
    if (to < 0) return { isLegal: false, states, cost: Infinity, isFinished: false };
    cost += costs[from][action];
    states.push(to);
  }
  return { isLegal: true, states, cost, isFinished: table.end[states[states.length - 1]] };
}

export function framesOf({ table }, states, actions) {
  return states.map((state, i) => {
    const [column, row, items, stations] = table.frames[state];
    return {
      robot: [column, row],
      items: items.map(([x, y, carried], k) => ({ name: table.items[k], cell: [x, y], carried: carried === 1 })),
      stations: stations.map((index) => table.stations[index]),
      action: i < actions.length ? table.actions[actions[i]].name : null,
      ...(i < actions.length && table.kinds ? { counts: table.kinds[Number(table.counts[state][actions[i]])] } : {}),
    };
  });
}
