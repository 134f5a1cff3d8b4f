// What people get wrong after so many items (demonstrations and tests).
import { groupBy, mean } from '../../tests/validation/statistics.mjs';

// Linear between the points of a path [[items, value], ...], level after the last.
function valueAt(path, items) {
  let [x, y] = path[0];
  for (const [nextX, nextY] of path.slice(1)) {
    if (nextX >= items) return nextX > x ? y + ((nextY - y) * (items - x)) / (nextX - x) : nextY;
    [x, y] = [nextX, nextY];
  }
  return y;
}

// Of every team of a run, in the order of its tables, means over its members: {row, before, regret}, with a row of its
// exam, and the regret before teaching and after so many items.
export function teamsAfter(runs, name, items) {
  const periods = groupBy(runs.table(name, 'periods'), (row) => row.team);
  const exams = groupBy(runs.table(name, 'exam').filter((row) => row.kc === ''), (row) => row.team);
  return [...exams].map(([team, rows]) => {
    const members = [...groupBy(rows, (row) => row.member)].map(([member, exam]) => {
      let seen = 0;
      const itemsAfter = new Map([[0, 0]]);
      for (const row of periods.get(team)) {
        if (row.strategy === 'baseline' && row.source !== `member ${member}`) continue;  // taught alone
        seen += row.demonstrations + row.tests;
        itemsAfter.set(row.period, seen);
      }
      const path = exam.map((row) => [itemsAfter.get(row.period) ?? seen, row.regret]);
      return { before: path[0][1], regret: valueAt(path, items) };
    });
    const average = (measure) => mean(members.map((one) => one[measure]));
    return { row: rows[0], before: average('before'), regret: average('regret') };
  });
}
