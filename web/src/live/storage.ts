// What this tab keeps across a reload. A browser that refuses storage loses it with a reload, and nothing else.
import { attempt } from '../shared/attempt';
import type { DriveStore, Kept } from '../shared/play/drive';

const kPrefix = 'kith.';
const unkept = new Map<string, string>(); // what the browser refused to keep

export function recall<T>(key: string): T | null {
  return attempt(() => JSON.parse(unkept.get(key) ?? sessionStorage.getItem(kPrefix + key) ?? 'null') as T | null);
}

export function keep(key: string, value: unknown): void {
  const text = JSON.stringify(value);
  unkept.set(key, text);
  attempt(() => {
    sessionStorage.setItem(kPrefix + key, text);
    unkept.delete(key);
  });
}

export function forget(key: string): void {
  unkept.delete(key);
  attempt(() => sessionStorage.removeItem(kPrefix + key));
}

/** Forgets what the person has done in this tab. What a facilitator or a visit to a learning system keeps stays. */
export function forgetPerson(): void {
  const inTab = (attempt(() => Object.keys(sessionStorage)) ?? []).filter((key) => key.startsWith(kPrefix));
  const keys = [...unkept.keys(), ...inTab.map((key) => key.slice(kPrefix.length))];
  keys.filter((key) => !/^(facilitator|visit)\./.test(key)).forEach(forget);
}

/** From now on this tab is of whoever has the token: what somebody else has done in it is forgotten. */
export function keepFor(token: string): void {
  if (recall('token') !== token) forgetPerson();
  keep('token', token);
}

// What all tabs of this browser know; nothing where it refuses storage.
export function recallInBrowser<T>(key: string): T | null {
  return attempt(() => JSON.parse(localStorage.getItem(kPrefix + key) ?? 'null') as T | null);
}

export function keepInBrowser(key: string, value: unknown): void {
  attempt(() => localStorage.setItem(kPrefix + key, JSON.stringify(value)));
}

// What somebody was driving, for `useDrive`.
export const driveStore: DriveStore = { recall: () => recall<Kept>('drive'), keep: (kept) => keep('drive', kept) };
