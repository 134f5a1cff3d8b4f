// What the page keeps for this tab only: the token and where the reader was.
const kTokenKey = 'kith.facilitator.token';

// The token of the link, which is taken out of the address bar so that it is not seen or copied by accident.
export function takeToken(): string | null {
  const found = /^#t=([A-Za-z0-9_-]+)$/.exec(window.location.hash);
  if (found?.[1]) {
    sessionStorage.setItem(kTokenKey, found[1]);
    window.history.replaceState(null, '', window.location.pathname);
  }
  return sessionStorage.getItem(kTokenKey);
}

export function forgetToken(): void {
  sessionStorage.removeItem(kTokenKey);
}

// The token in a link or a text that somebody pasted.
export function tokenIn(text: string): string | null {
  return /(?:#t=|^)([A-Za-z0-9_-]{16,})\s*$/.exec(text.trim())?.[1] ?? null;
}

export const remembered = (key: string): string | null => sessionStorage.getItem(`kith.facilitator.${key}`);
export const remember = (key: string, value: string): void => sessionStorage.setItem(`kith.facilitator.${key}`, value);
