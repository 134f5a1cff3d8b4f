/** What the action returns; null where it throws, as a browser does that refuses storage. */
export function attempt<T>(action: () => T): T | null {
  try {
    return action();
  } catch {
    return null;
  }
}
