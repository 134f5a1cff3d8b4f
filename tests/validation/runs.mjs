// The commands behind a page, {name: [words]}. Each runs once, when its result is first asked for. DIR is the folder of the
// run itself, DIR(NAME) that of another.
import { spawnSync } from 'node:child_process';
import { createHash } from 'node:crypto';
import { existsSync, mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';

const quoted = (word) => (/^[\w./=,()-]+$/.test(word) ? word : `'${word}'`);
export const commandLine = (words) => ['kith', ...words.map(quoted)].join(' ');

// A study into the folder of its run; settings are KEY=VALUE.
export const study = (file, ...settings) => ['study', file, '-o', 'DIR', ...settings.flatMap((one) => ['--set', one])];

const digest = (data) => createHash('sha256').update(data).digest('hex').slice(0, 16);
const otherRun = (word) => /^DIR\((.*)\)$/.exec(word)?.[1];

export class Runs {
  // `folder` keeps results; those of another program in it are not used.
  constructor(commands, kith, source, folder, say) {
    Object.assign(this, { commands, kith, source, say, folder: join(folder, digest(readFileSync(kith))), results: new Map(), tables: new Map() });
    mkdirSync(this.folder, { recursive: true });
  }

  // What a command printed.
  run(name) {
    if (this.results.has(name)) return this.results.get(name);
    const file = `${this.directory(name)}.out`;
    const args = this.commands[name].map((word) => {
      if (word === 'DIR') return this.directory(name);
      const other = otherRun(word);
      if (other === undefined) return word;
      this.run(other);
      return this.directory(other);
    });
    let text;
    if (existsSync(file)) {
      text = readFileSync(file, 'utf8');
    } else {
      const start = Date.now();
      const env = Object.fromEntries(Object.entries(process.env).filter(([key]) => !key.startsWith('KITH_')));
      const { status, stdout, stderr } = spawnSync(this.kith, args, { cwd: this.source, env, encoding: 'utf8', maxBuffer: 1 << 28 });
      if (status !== 0) throw new Error(`${this.commandLine(name)} failed (${status}):\n${stderr}`);
      text = stdout;
      writeFileSync(file, text);
      this.say(`${((Date.now() - start) / 1000).toFixed(1).padStart(7)} s  ${this.commandLine(name)}`);
    }
    this.results.set(name, text);
    return text;
  }

  commandLine(name) {
    return commandLine(this.commands[name]);
  }

  // Pages give other commands the same name.
  directory(name) {
    return join(this.folder, `${name.replace(/ /g, '-')}-${this.digestOf(name)}`);
  }

  digestOf(name) {
    const words = this.commands[name].map((word) => (otherRun(word) === undefined ? word : this.digestOf(otherRun(word))));
    return digest(JSON.stringify(words));
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
    if (!found) throw new Error(`${this.commandLine(name)} has no finding '${id}'`);
    return found;
  }
}
