// Checks the types of the pages where their packages are: beside a copy of the sources.
//
//   node tests/types_test.mjs --modules DIR
import { cpSync, rmSync } from 'node:fs';
import { dirname, join, resolve } from 'node:path';
import { spawnSync } from 'node:child_process';
import { fileURLToPath } from 'node:url';
import { parseArgs } from 'node:util';

const web = join(dirname(fileURLToPath(import.meta.url)), '..');
const { values } = parseArgs({ options: { modules: { type: 'string', default: web } } });
const modules = resolve(values.modules);
if (modules !== resolve(web)) {
  rmSync(join(modules, 'src'), { recursive: true, force: true });
  for (const name of ['src', 'tsconfig.json']) cpSync(join(web, name), join(modules, name), { recursive: true });
}
const compiler = join(modules, 'node_modules/typescript/bin/tsc');
const { status } = spawnSync(process.execPath, [compiler, '--noEmit', '-p', modules], { stdio: 'inherit' });
process.exit(status ?? 1);
