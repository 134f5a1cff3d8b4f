// Who this tab is: a token from the link's fragment, kept in this tab only.
import { transport } from '../shared/transport';
import { forgetPerson, keepFor, keepInBrowser, recall, recallInBrowser } from './storage';

const pattern = /^[A-Za-z0-9_-]{8,200}$/;

function tokenOfLink(): string | null {
  const token = new URLSearchParams(location.hash.slice(1)).get('t');
  return token !== null && pattern.test(token) ? token : null;
}

// The code of a link that anybody may have: in the fragment, or in the query beside what a platform adds.
export function codeOfLink(): string {
  const inFragment = new URLSearchParams(location.hash.slice(1)).get('c');
  return inFragment ?? new URLSearchParams(location.search).get('code') ?? '';
}

// The token of the link, else of this tab. The landing page alone asks before it goes back to a session. A lesson in a
// file is for whoever opens it, whatever its address says and the browser keeps.
export function knownToken(): { token: string | null; isOfLink: boolean } {
  if (transport().isLocal) return { token: 'lesson-file', isOfLink: true };
  const ofLink = tokenOfLink();
  if (ofLink) {
    keepFor(ofLink);
    return { token: ofLink, isOfLink: true };
  }
  return { token: recall<string>('token'), isOfLink: false };
}

// Who has joined from this browser, in any tab, and when: several people may share a computer.
export interface JoinedHere {
  token: string;
  at: number; // milliseconds since 1970
}

const kLongest = 86_400_000; // a day

export const joinedHere = (): JoinedHere[] => (recallInBrowser<JoinedHere[]>('joined') ?? []).filter((one) => Date.now() - one.at < kLongest);

export function rememberJoining(token: string): void {
  keepInBrowser('joined', [...joinedHere(), { token, at: Date.now() }].slice(-12));
}

// The address then has the token too, so that a bookmark or the history leads back to the session.
export function becomeParticipant(token: string): void {
  keepFor(token);
  history.replaceState(null, '', `/j#t=${encodeURIComponent(token)}`);
}

export function forgetParticipant(): void {
  const token = recall<string>('token');
  keepInBrowser('joined', joinedHere().filter((one) => one.token !== token));
  forgetPerson();
  history.replaceState(null, '', '/');
}
