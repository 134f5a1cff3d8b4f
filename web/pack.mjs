// Bytes as a text that HTML keeps as it is, and what is larger than a page should be, packed. src/file/packed.ts reads it.
import { execFileSync } from 'node:child_process';

const kSpared = [0, 8, 9, 10, 11, 12, 13, 26, 27, 34, 38, 60, 62, 92, 127];

// As a character of seven bits, or, where that is spared, with the next seven as one of two bytes.
export function textOf(bytes) {
  const sevens = [];
  let [bits, kept] = [0, 0];
  for (const byte of bytes) {
    bits = (bits << 8) | byte;
    kept += 8;
    while (kept >= 7) {
      kept -= 7;
      sevens.push((bits >> kept) & 127);
    }
    bits &= 127;
  }
  if (kept > 0) sevens.push((bits << (7 - kept)) & 127);
  const codes = [];
  for (let i = 0; i < sevens.length; ++i) {
    const spared = kSpared.indexOf(sevens[i]);
    codes.push(spared < 0 ? sevens[i] : 128 + 128 * spared + (sevens[++i] ?? 0));
  }
  let text = '';
  for (let i = 0; i < codes.length; i += 8192) text += String.fromCharCode(...codes.slice(i, i + 8192));
  return text;
}

// With its size in the header.
export function lzma(bytes) {
  const packed = execFileSync('xz', ['--format=lzma', '-9e', '--stdout'], { input: bytes, maxBuffer: 2 ** 28 });
  packed.writeBigUInt64LE(BigInt(bytes.length), 5);
  return packed;
}
