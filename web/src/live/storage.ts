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
