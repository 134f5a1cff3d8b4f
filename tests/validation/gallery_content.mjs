// The tables of docs/gallery.md.
import { fixed } from './format.mjs';
import { study } from './runs.mjs';
import { groupBy, mean } from './statistics.mjs';

// {file: what the page calls it}, in the order of the page.
const ROBOTS = {
  frozen_lake: 'FrozenLake 4 x 4',
  frozen_lake_8x8: 'FrozenLake 8 x 8',
  cliff_walking: 'CliffWalking',
  taxi: 'Taxi',
  four_rooms: 'four rooms',
  warehouse: 'warehouse',
};
const STRATEGIES = ['plan', 'joint', 'baseline'];
const SOON = 30; // periods

// What a robot that can be taught has to meet.
const FINISHED = 0.9;
const REGRET_LEFT = 0.1;
const SHARE_RIGHT = 0.85;

const folderOf = (robot) => (robot === 'warehouse' ? 'domains' : 'domains/gallery');
const fileOf = (robot) => `${folderOf(robot)}/${robot}.toml`;

export const COMMANDS = {
  ...Object.fromEntries(Object.keys(ROBOTS).map((robot) => [robot, study('studies/gallery.toml', `domain="${fileOf(robot)}"`)])),
  ...Object.fromEntries(Object.keys(ROBOTS).map((robot) => [`inspect ${robot}`, ['inspect', fileOf(robot), '--json']])),
  ...Object.fromEntries(Object.keys(ROBOTS).map((robot) => [`lesson ${robot}`, ['lesson', fileOf(robot), '--json']])),
};

export function makeContent(runs) {
  // Means over the members of all teams of a strategy: before teaching, and after it.
  const exam = (robot, strategy) => {
    const rows = runs.table(robot, 'exam').filter((row) => row.strategy === strategy && row.kc === '');
    const people = [...groupBy(rows, (row) => `${row.team} ${row.member}`).values()];
    const last = (all) => all.reduce((latest, row) => (row.period > latest.period ? row : latest));
    const of = (list) => ({ share: mean(list.map((row) => row.share_right)), regret: mean(list.map((row) => row.regret)) });
    return { before: of(people.map((all) => all.find((row) => row.period === 0))), after: of(people.map(last)) };
  };

  const measure = (robot, strategy) => {
    const teams = runs.table(robot, 'teams').filter((team) => team.strategy === strategy);
    const { before, after } = exam(robot, strategy);
    const finished = mean(teams.map((team) => Number(team.completed === 'true' && team.periods <= SOON)));
    const left = after.regret / before.regret;
    const missed = [
      ...(finished < FINISHED ? ['finished'] : []),
      ...(left > REGRET_LEFT ? ['regret'] : []),
      ...(after.share < SHARE_RIGHT ? ['share right'] : []),
    ];
    return { periods: mean(teams.map((team) => team.periods)), after, left, missed };
  };

  const tables = {
    robots: () => ({
      columns: ['robot', 'worlds', 'start states', 'the lesson begins with'],
      rows: Object.entries(ROBOTS).map(([robot, title]) => {
        const { mdps, demonstrations } = runs.json(`inspect ${robot}`);
        const texts = runs.json(`lesson ${robot}`).components.flatMap(({ sentences }) => sentences.map(({ text }) => text));
        return [title, String(mdps), String(demonstrations), [...new Set(texts)].filter(Boolean).slice(0, 2).join('; ')];
      }),
    }),

    crews: () => ({
      columns: ['robot', 'periods', 'share right', 'regret left, %', 'missed'],
      rows: Object.keys(ROBOTS).map((robot) => {
        const crews = STRATEGIES.map((strategy) => ({ strategy, ...measure(robot, strategy) }));
        const listed = (print) => crews.map(print).join(', ');
        return [
          ROBOTS[robot],
          listed(({ periods }) => fixed(periods, 1)),
          listed(({ after }) => fixed(after.share, 3)),
          listed(({ left }) => fixed(100 * left, 0)),
          crews.flatMap(({ strategy, missed }) => missed.map((what) => `${what} of \`${strategy}\``)).join(', '),
        ];
      }),
    }),
  };

  const robotsThatMeet = (strategy) => Object.keys(ROBOTS).filter((robot) => measure(robot, strategy).missed.length === 0);

  return {
    tables,
    figures: {
      'plan-meets': () => String(robotsThatMeet('plan').length),
      robots: () => String(Object.keys(ROBOTS).length),
      finished: () => `${fixed(100 * FINISHED, 0)} %`,
      'regret-left': () => `${fixed(100 * REGRET_LEFT, 0)} %`,
      'share-right': () => fixed(SHARE_RIGHT, 2),
    },
    claims: {},
  };
}
