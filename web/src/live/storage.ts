// What this tab keeps across a reload. A browser that refuses storage loses nothing but that.
const kPrefix = 'kith.';

export function recall<T>(key: string): T | null {
  try {
    const text = sessionStorage.getItem(kPrefix + key);
    return text === null ? null : (JSON.parse(text) as T);
  } catch {
    return null;
  }
}

export function keep(key: string, value: unknown): void {
  try {
    sessionStorage.setItem(kPrefix + key, JSON.stringify(value));
  } catch {
    // full or not allowed
  }
}

export function forget(key: string): void {
  try {
    sessionStorage.removeItem(kPrefix + key);
  } catch {
    // not allowed
  }
}

// Random ids also where crypto.randomUUID is missing: pages that are not served over TLS.
export function uuid(): string {
  const bytes = crypto.getRandomValues(new Uint8Array(16));
  bytes[6] = ((bytes[6] ?? 0) & 0x0f) | 0x40;
  bytes[8] = ((bytes[8] ?? 0) & 0x3f) | 0x80;
  const hex = [...bytes].map((byte) => byte.toString(16).padStart(2, '0')).join('');
  return [hex.slice(0, 8), hex.slice(8, 12), hex.slice(12, 16), hex.slice(16, 20), hex.slice(20)].join('-');
}
