// The table of docs/gallery.md.

// {file: what the page calls it}, in the order of the page.
const ROBOTS = {
  'domains/gallery/frozen_lake.toml': 'FrozenLake 4 x 4',
  'domains/gallery/frozen_lake_8x8.toml': 'FrozenLake 8 x 8',
  'domains/gallery/cliff_walking.toml': 'CliffWalking',
  'domains/gallery/taxi.toml': 'Taxi',
  'domains/gallery/four_rooms.toml': 'four rooms',
  'domains/warehouse.toml': 'warehouse',
};

export const COMMANDS = Object.fromEntries(
  Object.entries(ROBOTS).flatMap(([file, title]) => ['inspect', 'lesson'].map((command) => [`${command} ${title}`, [command, file, '--json']])),
);

export const makeContent = (runs) => ({
  tables: {
    robots: () => ({
      columns: ['robot', 'worlds', 'start states', 'the lesson begins with'],
      rows: Object.entries(ROBOTS).map(([file, title]) => {
        const { mdps, demonstrations } = runs.json(`inspect ${title}`);
        const texts = runs.json(`lesson ${title}`).components.flatMap(({ sentences }) => sentences.map(({ text }) => text));
        return [title, String(mdps), String(demonstrations), [...new Set(texts)].filter(Boolean).slice(0, 2).join('; ')];
      }),
    }),
  },
  figures: {},
  claims: {},
});
