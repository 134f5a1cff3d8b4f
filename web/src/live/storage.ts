// What this tab keeps across a reload. A browser that refuses storage loses it with a reload, and nothing else.
import type { DriveStore, Kept } from '../shared/play/drive';

const kPrefix = 'kith.';
const unkept = new Map<string, string>(); // what the browser refused to keep

export function recall<T>(key: string): T | null {
  try {
    const text = unkept.get(key) ?? sessionStorage.getItem(kPrefix + key);
    return text === null ? null : (JSON.parse(text) as T);
  } catch {
    return null;
  }
}

export function keep(key: string, value: unknown): void {
  const text = JSON.stringify(value);
  try {
    sessionStorage.setItem(kPrefix + key, text);
    unkept.delete(key);
  } catch {
    unkept.set(key, text); // full or not allowed
  }
}

// What all tabs of this browser know; nothing where it refuses storage.
export function recallInBrowser<T>(key: string): T | null {
  try {
    return JSON.parse(localStorage.getItem(kPrefix + key) ?? 'null') as T | null;
  } catch {
    return null;
  }
}

export function keepInBrowser(key: string, value: unknown): void {
  try {
    localStorage.setItem(kPrefix + key, JSON.stringify(value));
  } catch {
    // not allowed
  }
}

// What somebody was driving, for `useDrive`.
export const driveStore: DriveStore = { recall: () => recall<Kept>('drive'), keep: (kept) => keep('drive', kept) };

export function forget(key: string): void {
  unkept.delete(key);
  try {
    sessionStorage.removeItem(kPrefix + key);
  } catch {
    // not allowed
  }
}
