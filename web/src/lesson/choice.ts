// Why the robot does not do what somebody predicted, in the words of the domain: "it would rather take 2 more steps than
// cross rubble".
import type { Domain, Lesson } from './document';

type Feature = Domain['features'][number];

interface Surplus {
  feature: Feature;
  n: number;
  more: boolean; // the other path has some, too
}

const numbered = (many: string, n: number, more: boolean): string =>
  (!more && n === 2 ? many.replace('{n} times', 'twice') : many).replaceAll('{n}', `${n}${more ? ' more' : ''}`);

// "take a step" -> "take one more step"; "cross rubble" -> "cross rubble once more".
function oneMore(once: string): string {
  const changed = once.replace(/(^| )(?:a|an|one) /, '$1one more ');
  return changed === once ? `${once} once more` : changed;
}

const said = (one: string, many: string, n: number, more: boolean): string =>
  n === 1 ? (more ? oneMore(one) : one) : numbered(many, n, more);

function deed({ feature, n, more }: Surplus): string {
  if (feature.do !== '') return said(feature.do, feature.do_many, n, more);
  return `${feature.weight < 0 ? 'accept' : 'choose'} ${said(feature.words, feature.many, n, more)}`;
}

// Of two paths that count differently, the robot's being the better one, in two things; else empty.
export function choiceText({ domain }: Lesson, robot: number[], mine: number[]): string {
  const all = domain.features.flatMap((feature, k): (Surplus & { isTaken: boolean })[] => {
    const [ours, theirs] = [robot[k] ?? 0, mine[k] ?? 0];
    return ours === theirs ? [] : [{ feature, n: Math.abs(ours - theirs), more: ours !== 0 && theirs !== 0, isTaken: ours > theirs }];
  });
  const worth = all.reduce((sum, { feature, n, isTaken }) => sum + feature.weight * (isTaken ? n : -n), 0);
  if (all.length === 0 || all.length > 2 || worth <= 0 || all.some(({ n }) => n !== Math.round(n))) return '';
  const words = (isTaken: boolean, between: string): string => {
    const some = all.filter((one) => one.isTaken === isTaken).sort((a, b) => a.feature.weight - b.feature.weight);
    return some.map(deed).join(new Set(some.map(({ feature }) => feature.weight < 0)).size === 1 ? between : ' to ');
  };
  const [taken, spared] = [words(true, ' and '), words(false, ' or ')];
  if (spared === '') return `it will ${taken}`;
  if (taken !== '') return `it would rather ${taken} than ${spared}`;
  return all.some(({ feature }) => feature.weight > 0) ? `it will not ${spared}` : `it would rather not ${spared}`;
}
