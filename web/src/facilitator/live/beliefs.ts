// What a belief is of, from its name: "member 3", "common", "joint".
import type { SeatRow } from '../protocol';

export type BeliefKind = 'own' | 'common' | 'joint';

export function beliefKind(name: string): BeliefKind {
  if (/common/i.test(name)) return 'common';
  return /joint/i.test(name) ? 'joint' : 'own';
}

// The member of the session whose belief it is.
export function memberOf(name: string): number | null {
  const found = /^member (\d+)/.exec(name);
  return found ? Number(found[1]) : null;
}

// Who sits on a member's place now: of several, the last who is not gone.
export function seatOf(seats: SeatRow[], name: string): SeatRow | undefined {
  const member = memberOf(name);
  const own = seats.filter((seat) => (seat.member ?? seat.seat) === member);
  return own.filter(({ presence }) => presence !== 'left').pop() ?? own.pop();
}

// "Learner C" -> "C", for small drawings.
export const shortName = (name: string): string => name.replace(/^.* (?=\S+$)/, '');
