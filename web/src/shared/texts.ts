// All strings of the page, in the study's language. English is built in; what another language lacks is English.
import english from './texts/en.json';
import { transport } from './transport';

export interface TextsDocument {
  lang: string;
  dir: 'ltr' | 'rtl';
  strings: Record<string, string>;
}

// A text, or one in several forms: "key.one" and "key.other" are those of "key".
export type TextKey = WithBase<keyof typeof english>;
type WithBase<Key> = Key extends `${infer Base}.${'zero' | 'one' | 'other'}` ? Base | Key : Key;

const kBuiltIn: Record<string, string> = english;
const kAvailable = ['de']; // languages with a file beside this script

export type Values = Record<string, string | number>;

let strings: Record<string, string> = {};
let language = 'en';
let plurals = new Intl.PluralRules('en');
let lists = new Intl.ListFormat('en', { type: 'conjunction' });

function lookUp(key: string): string | undefined {
  return strings[key] ?? kBuiltIn[key];
}

// The text of a key with {names} filled in. With a number `n`, "key.one" and "key.other" (and what else the language
// needs) are its forms, and "key.zero" is for nothing in every language.
export function t(key: TextKey, values: Values = {}): string {
  const { n } = values;
  const zero = n === 0 ? lookUp(`${key}.zero`) : undefined;
  const form = zero ?? (typeof n === 'number' ? lookUp(`${key}.${plurals.select(n)}`) : undefined);
  const text = form ?? lookUp(key) ?? lookUp(`${key}.other`) ?? key;
  return text.replace(/\{(\w+)\}/g, (_, name: string) => String(values[name] ?? ''));
}

const kBoth = ' and ';

// What somebody else has named, translated if the texts have a translation: "name.rubble".
// What two kinds of ground have in common is named after both: "lane and wet".
export const named = (name: string): string =>
  lookUp(`name.${name}`) ?? (name.includes(kBoth) ? listed(name.split(kBoth).map(named)) : name);

const labels = new Map<string, string>();

// Labels come with the tables of moves and are used wherever an action is named.
export function rememberLabels(actions: readonly { name: string; label: string }[]): void {
  for (const { name, label } of actions) labels.set(name, label);
}

// The label of an action: "up", "pick up".
export const actionLabel = (name: string): string => lookUp(`action.${name}`) ?? labels.get(name) ?? name;

// With a capital letter in front: "Pick up".
export const capitalised = (text: string): string => text.charAt(0).toLocaleUpperCase(language) + text.slice(1);

// In English: "1 board", "2 boards".
export const counted = (n: number, one: string, many = `${one}s`): string => `${n} ${n === 1 ? one : many}`;

export const listed = (things: string[]): string => lists.format(things);

// Sentences from the server name things, not cells.
export const withoutCells = (text: string): string =>
  text
    .replace(/ from \(\d+,\d+\) to \(\d+,\d+\)/g, '')
    .replace(/ at \(\d+,\d+\)(?:(?:, | and )\(\d+,\d+\))*/g, '');

// A sentence of the server as one: first letter in upper case, a full stop at the end.
export function sentence(text: string): string {
  const plain = withoutCells(text.trim());
  if (plain === '') return '';
  const upper = capitalised(plain);
  return /[.!?:\u2026\u061f\u3002]$/.test(upper) ? upper : `${upper}.`;
}

function use(lang: string, dir: 'ltr' | 'rtl', own: Record<string, string>): void {
  let known = lang;
  try {
    known = Intl.getCanonicalLocales(lang)[0] ?? 'en';
  } catch {
    known = 'en';
  }
  language = known;
  strings = own;
  plurals = new Intl.PluralRules(known);
  lists = new Intl.ListFormat(known, { type: 'conjunction' });
  document.documentElement.lang = known;
  document.documentElement.dir = dir;
}

async function fetchJson<T>(address: string): Promise<T | null> {
  try {
    return (await transport().get(address)) as T;
  } catch {
    return null;
  }
}

export const currentLanguage = (): string => language;

// The server's own sentences are English.
export const isEnglish = (): boolean => bare(language) === 'en';

export const hasText = (key: string): key is TextKey => lookUp(key) !== undefined;

const bare = (lang: string): string => lang.toLowerCase().split('-')[0] ?? 'en';

// The study's own texts, or those of this page in the study's (or else the browser's) language.
export async function loadTexts(viewLanguage?: string): Promise<void> {
  const own = await fetchJson<TextsDocument>('/api/texts');
  const lang = own?.lang ?? viewLanguage ?? navigator.language;
  const hasStrings = own !== null && Object.keys(own.strings ?? {}).length > 0;
  let file: Record<string, string> | null = null;
  if (kAvailable.includes(bare(lang))) file = await fetchJson(`/assets/live/texts/${bare(lang)}.json`);
  if (hasStrings) use(lang, own.dir === 'rtl' ? 'rtl' : 'ltr', { ...file, ...own.strings });
  else if (file) use(lang, 'ltr', file);
  else use('en', 'ltr', {});
}
