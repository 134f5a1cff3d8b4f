// What a belief is of, from its name: "member 3", "common", "joint".
import type { SeatRow } from '../protocol';

export type BeliefKind = 'own' | 'common' | 'joint' | 'other';

export function beliefKind(name: string): BeliefKind {
  if (/common/i.test(name)) return 'common';
  if (/joint/i.test(name)) return 'joint';
  return memberOf(name) === null ? 'other' : 'own';
}

// The member of the session whose belief it is.
export function memberOf(name: string): number | null {
  const found = /^member (\d+)/.exec(name);
  return found ? Number(found[1]) : null;
}

// The member whose place a seat has: labels have its letter, also when somebody takes over. 0: a reserve.
export function memberOfSeat({ seat, label, member }: SeatRow): number {
  if (member !== undefined) return member;
  const letter = /^Learner ([A-Z])$/.exec(label)?.[1];
  if (letter) return letter.charCodeAt(0) - 64;
  return /reserve/i.test(label) ? 0 : seat;
}

// Who sits on a member's place now: of several, the last who is not gone.
export function seatOf(seats: SeatRow[], name: string): SeatRow | undefined {
  const member = memberOf(name);
  const own = seats.filter((seat) => memberOfSeat(seat) === member);
  return own.filter(({ presence }) => presence !== 'left').pop() ?? own.pop();
}

// "Learner C" -> "C", for small drawings.
export const shortName = (name: string): string => name.replace(/^.* (?=\S+$)/, '');
