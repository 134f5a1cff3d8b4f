// Draws what anytime.py found: regret after every number of items, a small chart per domain.
// usage: node figure.mjs NODE_PACKAGES OUT.csv > teachers.svg   (build/release/web/node_modules has the packages)
import { createRequire } from 'node:module';
import { readFileSync } from 'node:fs';
import { resolve } from 'node:path';

const SHOWN = ['plan', 'joint', 'set-cover', 'random', 'highlights'];
const [packages, ...files] = process.argv.slice(2);
const load = createRequire(resolve(packages, 'x.js'));
const vega = load('vega');
const rows = files
  .flatMap((file) => vega.read(readFileSync(file, 'utf8'), { type: 'csv', parse: { k: 'number', regret: 'number' } }))
  .filter((row) => row.kind === 'bayesian' && SHOWN.includes(row.strategy) && row.regret > 0);
const axis = { gridColor: '#ddd', domainColor: '#888', tickColor: '#888' };
const chart = load('vega-lite').compile({
  data: { values: rows },
  facet: { field: 'domain', title: null, sort: null },
  columns: 5,
  spec: {
    width: 130,
    height: 130,
    mark: { type: 'line', point: { size: 18 } },
    encoding: {
      x: { field: 'k', type: 'quantitative', title: 'Demonstrations and tests', axis: { ...axis, values: [4, 8, 15, 25, 40] } },
      y: { field: 'regret', type: 'quantitative', scale: { type: 'log' }, title: 'Regret', axis: { ...axis, grid: false, tickCount: 4, format: '.0e' } },
      color: { field: 'strategy', type: 'nominal', title: 'Strategy', sort: SHOWN, scale: { domain: SHOWN, range: ['#1f5fbf', '#222', '#b45f06', '#999', '#7a3e9d'] } },
      strokeWidth: { condition: { test: "datum.strategy === 'plan'", value: 3 }, value: 1.2 },
    },
  },
  resolve: { scale: { y: 'independent' } },
  config: { font: 'sans-serif', background: 'white' },
}).spec;
process.stdout.write(`${await new vega.View(vega.parse(chart), { renderer: 'none' }).toSVG()}\n`);
