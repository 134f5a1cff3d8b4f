// Makes a page's template: one HTML file which holds the script, the style and the licences of
// everything that is in it, and needs no network.
//
//   node build.mjs --out FILE [--page report|audit|lesson|file] [--modules DIR] [--engine DIR]
//
// DIR is a folder with node_modules (this one unless said otherwise), so that a build outside the
// source tree leaves no file here. A lesson file (the page `file`) also holds the engine, which DIR of
// --engine has as kith_engine.js and kith_engine.wasm. kith puts a document (schema kith.report/1,
// kith.audit/1 or kith.curriculum/1) where DATA_PLACEHOLDER stands and the escaped title where TITLE_PLACEHOLDER
// stands, each once.
import { createHash } from 'node:crypto';
import { existsSync, mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { dirname, join, resolve } from 'node:path';
import { parseArgs } from 'node:util';
import { bundlerOf, here, kScript, kTarget } from './bundle.mjs';
import { collectNotices, noticesHtml } from './notices.mjs';
import { lzma, textOf } from './pack.mjs';

const DATA_PLACEHOLDER = '/*KITH_REPORT_JSON*/';
const TITLE_PLACEHOLDER = '/*KITH_REPORT_TITLE*/';
const MAX_BYTES = 2_000_000;
// Per page what it is and what it draws, as people without scripts are told.
const PICTURES = { report: ['report', 'figures'], audit: ['audit', 'boards'], lesson: ['lesson', 'boards'], file: ['lesson', 'boards'] };

const { values } = parseArgs({
  options: {
    out: { type: 'string' },
    modules: { type: 'string' },
    page: { type: 'string', default: 'report' },
    engine: { type: 'string' },
  },
});
const isFile = values.page === 'file';
const source = join('src', values.page);
if (!values.out || !Object.hasOwn(PICTURES, values.page) || isFile !== (values.engine !== undefined)) {
  console.error('usage: node build.mjs --out FILE [--page report|audit|lesson|file] [--modules DIR] [--engine DIR]');
  process.exit(2);
}
const modulesRoot = resolve(values.modules ?? here);
const bundle = bundlerOf(modulesRoot);

// Browsers hash what is between the tags after their own normalisation, so what they would change must not occur.
function checkInlineScript(script) {
  for (const [what, found] of [
    ['</script', /<\/script/i.test(script)],
    ['<!--', script.includes('<!--')],
    ['a carriage return', script.includes('\r')],
  ]) {
    if (found) throw new Error(`the script contains ${what}, which ends or changes an inlined script`);
  }
}

// A function as replacement: in a string, `$&` and the like would be expanded.
function fill(template, name, value) {
  const parts = template.split(name);
  if (parts.length !== 2) throw new Error(`the template must contain ${name} once, not ${parts.length - 1} times`);
  return parts[0] + value + parts[1];
}

// Texts that only live sessions have.
const kOnlyLive = new RegExp(
  [
    '(page|status|notice|refused|landing|connecting|consent|intro|screening|lobby|person|wait|questions|explore|debrief|end|bye)\\.',
    '(pause|trouble|progress|file|data|door|stored|discuss|common\\.(?!words)|check\\.(?!end|stopped))',
    'feedback\\.(?!title|showed|right_other|robot|mine|here)',
    'watch\\.(count|title|question|sketch_|see|compare|think|finish|done|over|for_ever)',
    'predict\\.(title|count|question|submit|unfinished|empty|anyway|keep|end|stopped)',
  ]
    .map((start) => `^${start}`)
    .join('|'),
);
const kStarting = /^(trouble\.title|file\.(old_browser|broken))$/; // all that is said before a lesson file is unpacked
const textsThat = (isKept) => ({
  name: 'texts',
  setup({ onLoad }) {
    onLoad({ filter: /shared.texts.en\.json$/ }, ({ path }) => {
      const texts = Object.entries(JSON.parse(readFileSync(path, 'utf8'))).filter(([key]) => isKept(key));
      return { contents: JSON.stringify(Object.fromEntries(texts)), loader: 'json' };
    });
  },
});

// Style sheets that a script puts into a tree of its own: `import sheet from './x.css?text'`.
const sheets = {
  name: 'sheets',
  setup({ onResolve, onLoad }) {
    onResolve({ filter: /\.css\?text$/ }, ({ path, resolveDir }) => ({ path: join(resolveDir, path.slice(0, -5)), namespace: 'sheet' }));
    onLoad({ filter: /./, namespace: 'sheet' }, async ({ path }) => ({ contents: (await bundle(path, { target: kTarget })).text, loader: 'text' }));
  },
};

const script = await bundle(existsSync(join(here, source, 'main.tsx')) ? `${source}/main.tsx` : `${source}/main.ts`, {
  ...kScript,
  plugins: isFile ? [sheets] : [sheets, textsThat((key) => !kOnlyLive.test(key))],
});

// The page of a lesson file, what its worker runs, and what that runs on.
async function packedParts(folder) {
  const packed = (id, bytes) => `<script type="application/x-lzma" id="${id}">${textOf(lzma(bytes))}</script>\n`;
  const worker = await bundle(`${source}/worker.ts`, { platform: 'browser', format: 'iife', target: kTarget });
  const engine = `${readFileSync(join(folder, 'kith_engine.js'), 'utf8')}\n${worker.text}`;
  return (
    packed('kith-page', Buffer.from(script.text)) +
    packed('kith-engine-script', Buffer.from(engine)) +
    packed('kith-engine', readFileSync(join(folder, 'kith_engine.wasm')))
  );
}
const engine = values.engine ? await packedParts(values.engine) : '';

// A lesson file brings its style along.
const boot = isFile ? await bundle(`${source}/boot.ts`, { platform: 'browser', plugins: [textsThat((key) => kStarting.test(key))], format: 'iife', target: kTarget }) : script;
const style = isFile ? { text: '' } : await bundle(`${source}/style.css`, { target: kTarget });
const code = boot.text.trimEnd();
checkInlineScript(code);
if (/<\/style/i.test(style.text)) throw new Error('the style contains </style');

const hash = createHash('sha256').update(code, 'utf8').digest('base64');
const policy = [
  "default-src 'none'",
  `script-src 'sha256-${hash}'${engine ? " 'wasm-unsafe-eval' blob:" : ''}`,
  ...(engine ? ['worker-src blob:', "connect-src 'none'"] : []), // packages for learning systems may connect
  "style-src 'unsafe-inline'",
  'img-src data: blob:',
  "base-uri 'none'",
  "form-action 'none'",
].join('; ');

let page = readFileSync(join(here, 'src/shared/template.html'), 'utf8');
const [what, pictures] = PICTURES[values.page];
page = page.replaceAll('__PAGE__', what).replaceAll('__PICTURES__', pictures);
page = fill(page, '__POLICY__', policy);
page = fill(page, '__STYLE__', style.text.trim());
page = fill(page, '__NOTICES__', noticesHtml(collectNotices(script.metafile, modulesRoot)));
page = fill(page, '__ENGINE__', engine);
page = fill(page, '__SCRIPT__', code);
for (const name of [DATA_PLACEHOLDER, TITLE_PLACEHOLDER]) {
  if (page.split(name).length !== 2) throw new Error(`${name} must occur once`);
}
const bytes = Buffer.byteLength(page);
if (bytes > MAX_BYTES) throw new Error(`the page has ${bytes} bytes, more than ${MAX_BYTES}`);
mkdirSync(dirname(resolve(values.out)), { recursive: true });
writeFileSync(values.out, page);
console.log(`${values.out}: ${(bytes / 1e6).toFixed(2)} MB`);
