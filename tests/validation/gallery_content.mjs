// The tables of docs/gallery.md.
import { statSync } from 'node:fs';
import { join } from 'node:path';
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
};
const STRATEGIES = ['plan', 'joint', 'common', 'individual-low', 'individual-high', 'baseline'];
const SOON = 30; // periods

// What a robot that can be taught has to meet.
const FINISHED = 0.9;
const REGRET_LEFT = 0.1;
const SHARE_RIGHT = 0.85;

const short = (value) => (value === 0 ? '0' : value.toPrecision(2));
const fileOf = (robot) => `domains/gallery/${robot}.toml`;

export const COMMANDS = {
  ...Object.fromEntries(Object.keys(ROBOTS).map((robot) => [robot, study('studies/gallery.toml', `domain="${fileOf(robot)}"`)])),
  ...Object.fromEntries(Object.keys(ROBOTS).map((robot) => [`inspect ${robot}`, ['inspect', fileOf(robot), '--json']])),
  ...Object.fromEntries(Object.keys(ROBOTS).map((robot) => [`lesson ${robot}`, ['curriculum', fileOf(robot), '--json']])),
};

export function makeContent(runs, source) {
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
    return { finished, periods: mean(teams.map((team) => team.periods)), before, after, left, missed };
  };

  const each = (visit) => Object.keys(ROBOTS).flatMap((robot) => STRATEGIES.map((strategy) => visit(robot, strategy)));

  const tables = {
    commands: () => ({
      columns: ['robot', 'command'],
      rows: Object.entries(ROBOTS).map(([robot, title]) => [title, `\`${runs.commandLine(robot)}\``]),
    }),

    robots: () => ({
      columns: ['robot', 'worlds', 'start states', 'what the lesson says'],
      rows: Object.entries(ROBOTS).map(([robot, title]) => {
        const { mdps, demonstrations } = runs.json(`inspect ${robot}`);
        const texts = runs.json(`lesson ${robot}`).components.flatMap(({ sentences }) => sentences.map(({ text }) => text));
        return [title, String(mdps), String(demonstrations), [...new Set(texts)].filter(Boolean).join('; ')];
      }),
    }),

    sizes: () => ({
      columns: ['robot', 'files', 'kB'],
      rows: Object.entries(ROBOTS).map(([robot, title]) => {
        const files = [`${robot}.toml`, ...(robot === 'four_rooms' ? [] : [`${robot}_states.csv`, `${robot}_transitions.csv`])];
        const bytes = files.map((file) => statSync(join(source, 'domains/gallery', file)).size).reduce((sum, size) => sum + size, 0);
        return [title, files.map((file) => `\`${file}\``).join(', '), fixed(bytes / 1000, 0)];
      }),
    }),

    crews: () => ({
      columns: ['robot', 'strategy', `finished in ${SOON} periods`, 'periods', 'share right', 'regret', 'regret left', 'missed'],
      rows: each((robot, strategy) => {
        const { finished, periods, before, after, left, missed } = measure(robot, strategy);
        return [
          ROBOTS[robot],
          `\`${strategy}\``,
          `${fixed(100 * finished, 0)} %`,
          fixed(periods, 1),
          `${fixed(before.share, 3)} to ${fixed(after.share, 3)}`,
          `${short(before.regret)} to ${short(after.regret)}`,
          `${fixed(100 * left, 0)} %`,
          missed.join(', ') || 'none',
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
