// Checks the types of the pages where their packages are: beside a copy of the sources. Then that pages read every field
// of the views that are printed from libs/live: what nobody reads should not be sent.
//
//   node tests/types_test.mjs --modules DIR
import { cpSync, readFileSync, rmSync } from 'node:fs';
import { dirname, join, resolve } from 'node:path';
import { spawnSync } from 'node:child_process';
import { createRequire } from 'node:module';
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
if (status !== 0) process.exit(status ?? 1);

const ts = createRequire(join(modules, 'package.json'))('typescript');
const config = ts.parseJsonConfigFileContent(ts.readConfigFile(join(modules, 'tsconfig.json'), ts.sys.readFile).config, ts.sys, modules);
const service = ts.createLanguageService({
  getCompilationSettings: () => config.options,
  getScriptFileNames: () => config.fileNames,
  getScriptVersion: () => '1',
  getScriptSnapshot: (file) => (ts.sys.fileExists(file) ? ts.ScriptSnapshot.fromString(readFileSync(file, 'utf8')) : undefined),
  getCurrentDirectory: () => modules,
  getDefaultLibFileName: ts.getDefaultLibFilePath,
  fileExists: ts.sys.fileExists,
  readFile: ts.sys.readFile,
});

// Fields of a printed file that are mentioned nowhere else, but for commands, which pages write.
function unread(file) {
  const source = service.getProgram().getSourceFile(join(modules, 'src', file));
  const found = [];
  const visit = (node, path) => {
    const name = node.name && ts.isIdentifier(node.name) ? [...path, node.name.text] : path;
    if (ts.isInterfaceDeclaration(node) && /Commands$/.test(node.name.text)) return;
    if (ts.isPropertySignature(node)) {
      const references = service.getReferencesAtPosition(source.fileName, node.name.getStart()) ?? [];
      const isRead = references.some((one) => one.fileName !== source.fileName) || kOfTheService.includes(name.join('.'));
      if (!isRead) found.push(`${file}: no page reads ${name.join('.')}`);
    }
    ts.forEachChild(node, (child) => visit(child, name));
  };
  visit(source, []);
  return found;
}

// What the service reads of rooms to say who needs help.
const kOfTheService = ['SeatRow.right', 'SeatRow.tests', 'PersonAudit.right', 'PersonAudit.tests', 'PersonAudit.needs_help'];

const missing = ['live/protocol.ts', 'facilitator/room.ts'].flatMap(unread);
for (const one of missing) console.error(`${one}; take it out of libs/live/src/views.hpp`);
process.exit(missing.length > 0 ? 1 : 0);
