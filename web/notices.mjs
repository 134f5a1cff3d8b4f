// The licences of the packages whose code is in a bundle, found through esbuild's metafile.
import { readFileSync, readdirSync } from 'node:fs';
import { join, resolve } from 'node:path';

const LICENCE_FILE = /^(licen[cs]e|copying|notice)/i;

// What some packages carry inside their own built file, where the metafile cannot see it. Their
// version inside is unknown, so it is not stated.
const CARRIED = {
  'd3-delaunay': ['delaunator', 'robust-predicates'],
  'vega-embed': ['fast-json-patch', 'semver'],
};

// Folder of the package that a bundled file belongs to; null for our own files.
function packageFolder(file) {
  const inside = /^(.*node_modules\/(?:@[^/]+\/)?[^/]+)\//.exec(file);
  return inside ? inside[1] : null;
}

function describe(folder) {
  const about = JSON.parse(readFileSync(join(folder, 'package.json'), 'utf8'));
  const author = typeof about.author === 'string' ? about.author : about.author?.name;
  const texts = readdirSync(folder)
    .filter((name) => LICENCE_FILE.test(name))
    .sort()
    .map((name) => readFileSync(join(folder, name), 'utf8').replace(/\r/g, '').trim());
  return { name: about.name, version: about.version, licence: about.license, author, text: texts.join('\n\n') };
}

// [{name, version, licence, author, text}], sorted by name. A package without a licence file is
// listed with what its package.json says; one without even that is an error.
export function collectNotices(metafile, root) {
  const folders = new Set();
  for (const output of Object.values(metafile.outputs)) {
    for (const [file, { bytesInOutput }] of Object.entries(output.inputs)) {
      const folder = bytesInOutput > 0 ? packageFolder(file) : null;
      if (folder) folders.add(resolve(root, folder));
    }
  }
  const packages = [...folders].map(describe);
  for (const { name } of [...packages]) {
    for (const carried of CARRIED[name] ?? []) {
      packages.push({ ...describe(join(root, 'node_modules', carried)), version: `inside ${name}` });
    }
  }
  for (const one of packages) {
    if (!one.licence && !one.text) throw new Error(`${one.name} states no licence`);
  }
  const order = (a, b) => (a.name < b.name ? -1 : a.name > b.name ? 1 : a.version < b.version ? -1 : 1);
  return packages.sort(order);
}

const escapeHtml = (text) => text.replace(/&/g, '&amp;').replace(/</g, '&lt;').replace(/>/g, '&gt;');

// Packages that share a text (many do) share one entry.
export function noticesHtml(packages) {
  const byText = new Map();
  for (const one of packages) {
    const text = one.text || `Licence: ${one.licence}${one.author ? `. Author: ${one.author}` : ''}.`;
    byText.set(text, [...(byText.get(text) ?? []), one]);
  }
  return [...byText]
    .map(([text, sharing]) => {
      const names = sharing.map((one) => `${one.name} ${one.version} (${one.licence})`).join(', ');
      return `<h3>${escapeHtml(names)}</h3>\n<pre tabindex="0">${escapeHtml(text)}</pre>`;
    })
    .join('\n');
}
