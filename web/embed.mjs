// Writes a C++ source with the files of folders as constants: what `kith serve` serves.
//
//   node embed.mjs --out FILE NAME=FOLDER...
//
// Defines kith::cli::web_assets() (see apps/kith/src/web_assets.hpp): every file of FOLDER under the path
// /assets/NAME/, with its type, the SHA-256 of its content and, where that is smaller, a gzip copy.
import { createHash } from 'node:crypto';
import { readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { extname, join } from 'node:path';
import { parseArgs } from 'node:util';
import { gzipSync } from 'node:zlib';

const TYPES = {
  '.html': 'text/html; charset=utf-8',
  '.js': 'text/javascript; charset=utf-8',
  '.css': 'text/css; charset=utf-8',
  '.json': 'application/json',
  '.svg': 'image/svg+xml',
  '.png': 'image/png',
  '.ico': 'image/x-icon',
  '.woff2': 'font/woff2',
  '.txt': 'text/plain; charset=utf-8',
};
const LINE = 4000; // bytes of content per line of source

const { values, positionals } = parseArgs({ options: { out: { type: 'string' } }, allowPositionals: true });
if (!values.out || positionals.length === 0) {
  console.error('usage: node embed.mjs --out FILE NAME=FOLDER...');
  process.exit(2);
}

function filesOf(folder, below = '') {
  return readdirSync(join(folder, below), { withFileTypes: true }).flatMap((entry) => {
    const name = below ? `${below}/${entry.name}` : entry.name;
    return entry.isDirectory() ? filesOf(folder, name) : [name];
  });
}

// A string literal, in lines that are concatenated. An octal escape of three digits ends by itself.
function literal(bytes) {
  const lines = [];
  for (let at = 0; at < bytes.length; at += LINE) {
    let line = '';
    for (const byte of bytes.subarray(at, at + LINE)) {
      const plain = byte >= 0x20 && byte < 0x7f && byte !== 0x22 && byte !== 0x5c && byte !== 0x3f;
      line += plain ? String.fromCharCode(byte) : `\\${byte.toString(8).padStart(3, '0')}`;
    }
    lines.push(`"${line}"`);
  }
  return lines.length === 0 ? '""' : lines.join('\n');
}

const assets = [];
for (const positional of positionals) {
  const [name, folder] = positional.split('=');
  for (const file of filesOf(folder).sort()) {
    const type = TYPES[extname(file)];
    if (!type) throw new Error(`${file}: files of this kind are not served`);
    const body = readFileSync(join(folder, file));
    const gzip = gzipSync(body, { level: 9 });
    assets.push({
      path: `/assets/${name}/${file}`,
      type,
      etag: createHash('sha256').update(body).digest('hex'),
      body,
      gzip: gzip.length < body.length ? gzip : Buffer.alloc(0),
    });
  }
}

const constants = assets.map(
  ({ body, gzip }, i) =>
    `constexpr std::string_view kBody${i}{${literal(body)}, ${body.length}};\n` +
    `constexpr std::string_view kGzip${i}{${gzip.length ? `${literal(gzip)}, ${gzip.length}` : ""}};\n`,
);
const rows = assets.map(
  ({ path, type, etag }, i) => `    {"${path}", "${type}", "${etag}", kBody${i}, kGzip${i}},\n`,
);
writeFileSync(
  values.out,
  `#include <array>

#include "web_assets.hpp"

namespace kith::cli {
namespace {

${constants.join('\n')}
constexpr std::array<Asset, ${assets.length}> kAssets{{
${rows.join('')}}};

}  // namespace

std::span<const Asset> web_assets() { return kAssets; }

}  // namespace kith::cli
`,
);
console.log(`${values.out}: ${assets.length} files`);
