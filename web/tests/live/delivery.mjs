// What item delivery costs, and its best paths, by its tables of moves: for people who answer.
const kCosts = [3, -3.5, 1]; // rubble, charger, step

// A table of moves with the cost of every action.
export function priced(table) {
  const price = table.kinds.map((counts) => counts.reduce((sum, n, k) => sum + n * kCosts[k], 0));
  return { table, costs: table.counts.map((row) => [...row].map((kind) => price[Number(kind)])) };
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
