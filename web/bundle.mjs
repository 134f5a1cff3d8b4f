// What both kinds of pages are bundled with.
import { createRequire } from 'node:module';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';

export const kTarget = ['chrome100', 'firefox100', 'safari15.4'];
export const here = dirname(fileURLToPath(import.meta.url));
// Of what people see.
export const kScript = { jsx: 'automatic', jsxImportSource: 'preact', platform: 'browser', format: 'iife', target: kTarget };

// `modules` is a folder with node_modules.
export function bundlerOf(modules) {
  const { build } = createRequire(join(modules, 'package.json'))('esbuild');
  return async (entry, options) => {
    const result = await build({
      entryPoints: [resolve(here, entry)],
      absWorkingDir: modules,
      nodePaths: [join(modules, 'node_modules')],
      bundle: true,
      minify: true,
      write: false,
      metafile: true,
      charset: 'ascii',
      legalComments: 'none', // pages have whole licences instead
      ...options,
    });
    return { text: result.outputFiles[0].text, metafile: result.metafile };
  };
}
