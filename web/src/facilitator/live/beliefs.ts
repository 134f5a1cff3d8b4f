// What a belief is of, from its name: "member 3", "common", "joint".
export type BeliefKind = 'own' | 'common' | 'joint';

export function beliefKind(name: string): BeliefKind {
  if (/common/i.test(name)) return 'common';
  return /joint/i.test(name) ? 'joint' : 'own';
}

export function seatOf(name: string): number | null {
  const found = /^member (\d+)/.exec(name);
  return found ? Number(found[1]) : null;
}

// "Learner C" -> "C", for small drawings.
export const shortName = (name: string): string => name.replace(/^.* (?=\S+$)/, '');
