// Why the robot does not do what somebody predicted, in the words of the domain: "it would rather take 2 more steps than
// cross rubble".
import { listed } from '../shared/texts';
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

const nouns = (all: Surplus[]): string => listed(all.map(({ feature, n, more }) => said(feature.words, feature.many, n, more)));
const verbs = (all: Surplus[]): string => listed(all.map(({ feature, n, more }) => said(feature.do, feature.do_many, n, more)));

// Of two paths that count differently, the robot's being the better one. Empty where expectations decide.
export function choiceText({ domain, judge }: Lesson, robot: number[], mine: number[]): string {
  const taken: { costs: Surplus[]; gains: Surplus[] } = { costs: [], gains: [] };
  const spared: { costs: Surplus[]; gains: Surplus[] } = { costs: [], gains: [] };
  domain.features.forEach((feature, k) => {
    const [ours, theirs] = [(robot[k] ?? 0) / judge.scale, (mine[k] ?? 0) / judge.scale];
    if (ours === theirs) return;
    const side = ours > theirs ? taken : spared;
    const surplus = { feature, n: Math.abs(ours - theirs), more: ours !== 0 && theirs !== 0 };
    (feature.weight < 0 ? side.costs : side.gains).push(surplus);
  });
  const all = [...taken.costs, ...taken.gains, ...spared.costs, ...spared.gains];
  if (all.length === 0 || all.some(({ n }) => n !== Math.round(n))) return '';
  if (taken.costs.length === 0 && spared.gains.length === 0) {
    const lost = taken.gains.length > 0 ? `does without ${nouns(taken.gains)}` : '';
    const extra = spared.costs.length > 0 ? `makes the robot accept ${nouns(spared.costs)}` : '';
    return `this path ${[extra, lost].filter((text) => text !== '').join(' and ')} for nothing`;
  }
  const hasVerbs = all.every(({ feature }) => feature.do !== '');
  const joined = ({ costs, gains }: typeof taken): string => {
    const words = hasVerbs ? verbs : nouns;
    if (costs.length === 0 || gains.length === 0) return words(costs.length === 0 ? gains : costs);
    return `${words(costs)}${hasVerbs ? ' to ' : ' for '}${words(gains)}`;
  };
  const isEmpty = ({ costs, gains }: typeof taken): boolean => costs.length === 0 && gains.length === 0;
  if (isEmpty(spared)) {
    return hasVerbs ? `it will ${verbs(taken.costs)} to ${verbs(taken.gains)}` : `it accepts ${nouns(taken.costs)} for ${nouns(taken.gains)}`;
  }
  if (isEmpty(taken)) return `it would rather do without ${nouns(spared.gains)} than ${hasVerbs ? verbs(spared.costs) : `accept ${nouns(spared.costs)}`}`;
  return hasVerbs ? `it would rather ${joined(taken)} than ${joined(spared)}` : `it prefers ${joined(taken)} to ${joined(spared)}`;
}
