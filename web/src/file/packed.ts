// What is packed into a page as text: bytes in characters that neither HTML nor a change of line ends touches, and LZMA,
// which browsers cannot expand by themselves, and which makes the engine a quarter smaller than gzip does.

// Seven bits are a character of their code, unless it is one of these: then they and the next seven bits are one
// character of two bytes in UTF-8. web/pack.mjs writes it.
const kSpared = [0, 8, 9, 10, 11, 12, 13, 26, 27, 34, 38, 60, 62, 92, 127];

export function bytesOf(text: string): Uint8Array<ArrayBuffer> {
  const bytes = new Uint8Array(Math.ceil((text.length * 14) / 8));
  let [size, bits, kept] = [0, 0, 0];
  const take = (seven: number): void => {
    bits = (bits << 7) | seven;
    kept += 7;
    if (kept < 8) return;
    kept -= 8;
    bytes[size++] = bits >> kept;
    bits &= (1 << kept) - 1;
  };
  for (let i = 0; i < text.length; ++i) {
    const code = text.charCodeAt(i);
    if (code < 128) {
      take(code);
    } else {
      take(kSpared[(code - 128) >> 7] ?? 0);
      take(code & 127);
    }
  }
  return bytes.subarray(0, size);
}

/** The bytes that are packed into the element. */
export const packedIn = (id: string): Uint8Array<ArrayBuffer> => bytesOf(document.getElementById(id)?.textContent ?? '');

/** An address of the script that is packed into the element. */
export const scriptIn = (id: string): string =>
  URL.createObjectURL(new Blob([expanded(packedIn(id))], { type: 'text/javascript' }));

// Places in the table of probabilities; "LZMA specification", Pavlov 2015.
const kIsMatch = 0; // by state and place
const kIsRepeat = 192; // by state, like the next three
const kIsOlder = 204;
const kIsThird = 216;
const kIsFourth = 228;
const kIsLong = 240; // by state and place
const kSlot = 432; // of a distance, by length
const kFar = 688; // low bits of a distance, by slot
const kAlign = 804;
const kLength = 820; // of a match; 2 choices, 16 x 8 short ones, 16 x 8 middle ones, 256 long ones
const kRepeatLength = 1334;
const kLiteral = 1848;

/** Expands what `xz --format=lzma` has made. Its size must be in the header. */
export function expanded(packed: Uint8Array): Uint8Array<ArrayBuffer> {
  const header = new DataView(packed.buffer, packed.byteOffset);
  const numbers = header.getUint8(0);
  const [before, low, placed] = [numbers % 9, Math.floor(numbers / 9) % 5, Math.floor(numbers / 45)];
  const out = new Uint8Array(header.getUint32(5, true));
  const odds = new Uint16Array(kLiteral + (0x300 << (before + low))).fill(1024);
  let [at, range, code] = [18, 0xffffffff, header.getUint32(14)];

  const next = (): void => {
    if (range >= 0x1000000) return;
    range = (range << 8) >>> 0;
    code = ((code << 8) | (packed[at++] ?? 0)) >>> 0;
  };
  const bit = (i: number): number => {
    const odd = odds[i] ?? 0;
    const bound = (range >>> 11) * odd;
    if (code < bound) {
      range = bound;
      odds[i] = odd + ((2048 - odd) >> 5);
      next();
      return 0;
    }
    range -= bound;
    code -= bound;
    odds[i] = odd - (odd >> 5);
    next();
    return 1;
  };
  const evenBits = (count: number): number => {
    let value = 0;
    for (let i = 0; i < count; ++i) {
      range >>>= 1;
      const one = code >= range ? 1 : 0;
      if (one) code -= range;
      value = 2 * value + one;
      next();
    }
    return value;
  };
  const tree = (base: number, count: number): number => {
    let node = 1;
    for (let i = 0; i < count; ++i) node = 2 * node + bit(base + node);
    return node - (1 << count);
  };
  const lowFirst = (base: number, count: number): number => {
    let [node, value] = [1, 0];
    for (let i = 0; i < count; ++i) {
      const one = bit(base + node);
      node = 2 * node + one;
      value |= one << i;
    }
    return value;
  };
  const length = (base: number, place: number): number => {
    if (!bit(base)) return 2 + tree(base + 2 + 8 * place, 3);
    if (!bit(base + 1)) return 10 + tree(base + 130 + 8 * place, 3);
    return 18 + tree(base + 258, 8);
  };
  const distance = (size: number): number => {
    const slot = tree(kSlot + 64 * Math.min(size - 2, 3), 6);
    if (slot < 4) return slot;
    const count = (slot >> 1) - 1;
    const start = (2 | (slot & 1)) * 2 ** count;
    if (slot < 14) return start + lowFirst(kFar + start - slot, count);
    return start + evenBits(count - 4) * 16 + lowFirst(kAlign, 4);
  };

  let [size, state] = [0, 0];
  let repeats: [number, number, number, number] = [0, 0, 0, 0];
  const literal = (): void => {
    const place = ((size & ((1 << low) - 1)) << before) + ((out[size - 1] ?? 0) >> (8 - before));
    const base = kLiteral + 0x300 * place;
    let node = 1;
    if (state >= 7) {
      let match = out[size - repeats[0] - 1] ?? 0;
      while (node < 0x100) {
        const expected = (match >> 7) & 1;
        match <<= 1;
        const one = bit(base + ((1 + expected) << 8) + node);
        node = 2 * node + one;
        if (one !== expected) break;
      }
    }
    while (node < 0x100) node = 2 * node + bit(base + node);
    out[size++] = node;
    state = state < 4 ? 0 : state < 10 ? state - 3 : state - 6;
  };
  while (size < out.length) {
    const place = size & ((1 << placed) - 1);
    if (!bit(kIsMatch + 16 * state + place)) {
      literal();
      continue;
    }
    let count = 0;
    if (!bit(kIsRepeat + state)) {
      count = length(kLength, place);
      repeats = [distance(count), repeats[0], repeats[1], repeats[2]];
      state = state < 7 ? 7 : 10;
    } else {
      const [first, second, third, fourth] = repeats;
      if (!bit(kIsOlder + state)) {
        if (!bit(kIsLong + 16 * state + place)) count = 1;
      } else if (!bit(kIsThird + state)) {
        repeats = [second, first, third, fourth];
      } else if (!bit(kIsFourth + state)) {
        repeats = [third, first, second, fourth];
      } else {
        repeats = [fourth, first, second, third];
      }
      if (count === 1) {
        state = state < 7 ? 9 : 11;
      } else {
        count = length(kRepeatLength, place);
        state = state < 7 ? 8 : 11;
      }
    }
    if (repeats[0] >= size) throw new Error('what is packed into this page is damaged');
    for (let i = 0; i < count && size < out.length; ++i, ++size) out[size] = out[size - repeats[0] - 1] ?? 0;
  }
  return out;
}
