// The commands behind the page. Each runs once, when its result is first asked for.
import { spawnSync } from 'node:child_process';
import { createHash } from 'node:crypto';
import { existsSync, mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';

const both = (key, value) => [`learner.N.${key}=${value}`, `learner.P.${key}=${value}`];
const study = (file, ...settings) => ['study', file, '-o', 'DIR', ...settings.flatMap((one) => ['--set', one])];
const DOMAINS = ['two-goals', 'cookie-crumb', 'colored-tiles', 'skateboard'];
const COMMON = 'common - the others: common - individual-low - individual-high - joint';
const teamsOnly = 'record.level="team"';

// Name of a run: its command. DIR is the folder of the run itself, DIR(NAME) that of another.
export const COMMANDS = {
  version: ['version', '--json'],
  facts: ['inspect', 'item-delivery', '--show', 'demos', '--json'],
  large: study('studies/paper.toml', 'replicates=500'),
  small: study('studies/paper.toml', teamsOnly),
  'scale 0.9': study('studies/paper-uncalibrated.toml', 'replicates=500', ...both('ability_scale', 0.9), teamsOnly),
  'scale 1.0': study('studies/paper-uncalibrated.toml', 'replicates=500', ...both('ability_scale', 1.0), teamsOnly),
  'less known': study('studies/paper.toml', 'replicates=200', ...both('prior', '[]'), teamsOnly),
  'more known': study('studies/paper.toml', 'replicates=200', ...both('prior', '[{step=-1},{rubble=-1}]'), teamsOnly),
  ...Object.fromEntries(
    DOMAINS.map((domain) => [
      domain,
      study('studies/paper.toml', 'replicates=100', `domain="${domain}"`, teamsOnly),
    ]),
  ),
  'analysis, large': ['analyze', 'DIR(large)', '--json'],
  'analysis, small': ['analyze', 'DIR(small)', '--json'],
  ...Object.fromEntries(
    DOMAINS.map((domain) => [`analysis, ${domain}`, ['analyze', `DIR(${domain})`, '--contrast', COMMON, '--json']]),
  ),
  calibration: ['calibrate', 'studies/paper-uncalibrated.toml', '--targets', 'studies/paper-targets.toml', '--json'],
  'findings, paired': ['power', 'studies/paper.toml', '--findings', 'studies/paper-targets.toml', '--json'],
  'findings, unpaired': [
    'power', 'studies/paper.toml', '--findings', 'studies/paper-targets.toml', '--set', 'design.pairing="none"', '--json',
  ],
};

const quoted = (word) => (/^[\w./=,()-]+$/.test(word) ? word : `'${word}'`);
export const commandLine = (name) => ['kith', ...COMMANDS[name].map(quoted)].join(' ');

export class Runs {
  // `folder` keeps results; those of another program in it are not used.
  constructor(kith, source, folder, say) {
    const digest = createHash('sha256').update(readFileSync(kith)).digest('hex').slice(0, 16);
    Object.assign(this, { kith, source, say, folder: join(folder, digest), results: new Map(), tables: new Map() });
    mkdirSync(this.folder, { recursive: true });
  }

  // What a command printed.
  run(name) {
    if (this.results.has(name)) return this.results.get(name);
    const file = join(this.folder, `${name}.out`);
    const args = COMMANDS[name].map((word) => {
      if (word === 'DIR') return this.directory(name);
      const other = /^DIR\((.*)\)$/.exec(word);
      if (!other) return word;
      this.run(other[1]);
      return this.directory(other[1]);
    });
    let text;
    if (existsSync(file)) {
      text = readFileSync(file, 'utf8');
    } else {
      const start = Date.now();
      const env = Object.fromEntries(Object.entries(process.env).filter(([key]) => !key.startsWith('KITH_')));
      const { status, stdout, stderr } = spawnSync(this.kith, args, { cwd: this.source, env, encoding: 'utf8', maxBuffer: 1 << 28 });
      if (status !== 0) throw new Error(`${commandLine(name)} failed (${status}):\n${stderr}`);
      text = stdout;
      writeFileSync(file, text);
      this.say(`${((Date.now() - start) / 1000).toFixed(1).padStart(7)} s  ${commandLine(name)}`);
    }
    this.results.set(name, text);
    return text;
  }

  directory(name) {
    return join(this.folder, name.replace(/ /g, '-'));
  }

  json(name) {
    return JSON.parse(this.run(name));
  }

  // Rows of a table of a run folder as objects; numbers are numbers.
  table(name, table) {
    const key = `${name}/${table}`;
    if (this.tables.has(key)) return this.tables.get(key);
    this.run(name);
    const [header, ...lines] = readFileSync(join(this.directory(name), 'tables', `${table}.csv`), 'utf8').trimEnd().split('\n');
    const columns = header.split(',');
    const rows = lines.map((line) => {
      const cells = line.split(',');
      return Object.fromEntries(columns.map((column, i) => [column, cells[i] === '' || isNaN(cells[i]) ? cells[i] : Number(cells[i])]));
    });
    this.tables.set(key, rows);
    return rows;
  }

  finding(name, id) {
    const found = this.json(name).findings.find((finding) => finding.id === id);
    if (!found) throw new Error(`${commandLine(name)} has no finding '${id}'`);
    return found;
  }
}
