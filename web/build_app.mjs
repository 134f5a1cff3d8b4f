// Makes the folder of a page that `kith serve` serves: index.html, app.js, app.css and, if the page has
// them, worker.js and texts/. The server's policy allows neither inline scripts nor inline styles, so both
// are files of their own.
//
//   node build_app.mjs --page NAME --out DIR [--modules DIR]
//
// NAME is a folder of src with main.tsx and style.css. The server serves the two assets as /assets/NAME/app.js and
// /assets/NAME/app.css.
import { cpSync, existsSync, mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { dirname, join, resolve } from 'node:path';
import { parseArgs } from 'node:util';
import { gzipSync } from 'node:zlib';
import { bundlerOf, here, kScript, kTarget } from './bundle.mjs';
import { collectNotices, noticesHtml } from './notices.mjs';

const kMaxGzipped = 200_000; // bytes of script that a participant may have to wait for

const { values } = parseArgs({
  options: { page: { type: 'string' }, out: { type: 'string' }, modules: { type: 'string', default: here } },
});
const source = join('src', values.page ?? '');
if (!values.page || !values.out || !existsSync(join(here, source, 'main.tsx'))) {
  console.error('usage: node build_app.mjs --page NAME --out DIR [--modules DIR]');
  process.exit(2);
}
const modules = resolve(values.modules);
const bundle = bundlerOf(modules);

// The colours are defined in TypeScript; served pages need them as a style sheet.
async function themeSheet() {
  const { text } = await bundle('src/shared/theme.ts', { platform: 'node', format: 'esm' });
  const theme = await import(`data:text/javascript;base64,${Buffer.from(text).toString('base64')}`);
  return theme.themeSheet();
}

const script = await bundle(`${source}/main.tsx`, kScript);
const style = await bundle(`${source}/style.css`, { target: kTarget });
const template = readFileSync(join(here, 'src/shared/app.html'), 'utf8');
const index = template
  .replaceAll('__PAGE__', values.page)
  .replace('__NOTICES__', () => noticesHtml(collectNotices(script.metafile, modules)));
if (/ style=| on[a-z]+=|<style|<script>/.test(template)) throw new Error('index.html has inline style or script');

const gzipped = gzipSync(script.text).length;
if (gzipped > kMaxGzipped) throw new Error(`app.js has ${gzipped} bytes gzipped, more than ${kMaxGzipped}`);
mkdirSync(values.out, { recursive: true });
writeFileSync(join(values.out, 'index.html'), index);
writeFileSync(join(values.out, 'app.js'), script.text);
writeFileSync(join(values.out, 'app.css'), `${await themeSheet()}\n${style.text}`);
const worker = join(source, 'worker.ts');
if (existsSync(join(here, worker))) {
  const { text } = await bundle(worker, { platform: 'browser', format: 'iife', target: kTarget });
  writeFileSync(join(values.out, 'worker.js'), text);
}
const texts = join(here, 'src/shared/texts'); // of pages for participants
if (values.page === 'live') cpSync(texts, join(values.out, 'texts'), { recursive: true });
console.log(`${values.out}: app.js ${(script.text.length / 1e3).toFixed(0)} kB, ${(gzipped / 1e3).toFixed(0)} kB gzipped`);
