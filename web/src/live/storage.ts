// What this tab keeps across a reload. A browser that refuses storage loses nothing but that.
import type { DriveStore, Kept } from '../shared/play/drive';

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

// What somebody was driving, for `useDrive`.
export const driveStore: DriveStore = { recall: () => recall<Kept>('drive'), keep: (kept) => keep('drive', kept) };

export function forget(key: string): void {
  try {
    sessionStorage.removeItem(kPrefix + key);
  } catch {
    // not allowed
  }
}
