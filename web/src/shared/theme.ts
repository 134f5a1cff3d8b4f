// All colours, once, for light and dark. The page and its figures use them as CSS variables, so a
// change of theme or printing recolours everything at once; what is saved gets the light values.
import { colors, tints } from './board/drawing.json';
import { button } from './dom';

type Scheme = Record<string, string>;

// Of boards, which pictures of the program have, too: the light one of each pair, or the dark one.
function boardScheme(which: 0 | 1): Scheme {
  const of = (pair: string[]): string => pair[which] ?? '';
  return Object.fromEntries([
    ...Object.entries(colors).map(([name, pair]) => [`board-${name}`, of(pair)]),
    ['robot', of(colors.own)], // elsewhere than on boards, which may have another pair
    ['person', of(colors.other)],
    ...tints.flatMap(({ name, ground, mark }) => [
      [`tint-${name}`, of(ground)],
      [`mark-${name}`, of(mark)],
    ]),
  ]) as Scheme;
}

// Strategies have t0 to t7. The first five, those of the strategies that kith compares, differ in lightness, too: they
// stay apart in grey and for all kinds of colour vision, and contrast with the ground by 3 : 1 (tests/report_test.mjs).
const kLight: Scheme = {
  ...boardScheme(0),
  ground: '#ffffff',
  panel: '#f6f7f9',
  text: '#1c2127',
  muted: '#57606a',
  line: '#d5d9de',
  grid: '#e6e8eb',
  link: '#0b5cad',
  focus: '#0b5cad',
  warn: '#8a4b00',
  'warn-panel': '#fff6e5',
  shade: '#eef4fb',
  t0: '#14171b',
  t1: '#332896',
  t2: '#bf560f',
  t3: '#12643e',
  t4: '#c67d9f',
  t5: '#9a6f00',
  t6: '#2b8cbe',
  t7: '#1c2127',
  k0: '#a9c3dc',
  k1: '#5b8db8',
  k2: '#1f5a8c',
  k3: '#0b2f52',
  k4: '#c9b79c',
  k5: '#7d6a4b',
  bec: '#e69f00',
  'third-own': '#6b1fb1',
  'third-other': '#1c2127',
};
const kDark: Scheme = {
  ...boardScheme(1),
  ground: '#14171b',
  panel: '#1c2127',
  text: '#e8eaed',
  muted: '#aab2bd',
  line: '#3a424c',
  grid: '#2a3038',
  link: '#7cb8f2',
  focus: '#7cb8f2',
  warn: '#ffc56b',
  'warn-panel': '#33280f',
  shade: '#1b2836',
  t0: '#f8f9fa',
  t1: '#628bdf',
  t2: '#eb9f32',
  t3: '#63ed96',
  t4: '#9f5088',
  t5: '#e3b505',
  t6: '#9ad0f5',
  t7: '#f4f4f4',
  k0: '#2f5f8a',
  k1: '#5f97c7',
  k2: '#a3cbee',
  k3: '#dcecfa',
  k4: '#8a7651',
  k5: '#cbb68f',
  bec: '#e6a817',
  'third-own': '#d3adff',
  'third-other': '#f1f3f5',
};

export const color = (name: string): string => `var(--${name})`;

// Replaces the variables in a specification by their light values: a file has no page around it.
export function inLight<T>(spec: T): T {
  const text = JSON.stringify(spec).replace(/var\(--([a-z0-9-]+)\)/g, (_, name: string) => kLight[name] ?? '#000000');
  return JSON.parse(text) as T;
}

function rules(scheme: Scheme): string {
  return Object.entries(scheme)
    .map(([name, value]) => `--${name}:${value}`)
    .join(';');
}

// The style sheet that defines the colours: a part of app.css where the page's policy allows no inline style.
export function themeSheet(): string {
  return [
    `:root{${rules(kLight)};color-scheme:light}`,
    `@media (prefers-color-scheme:dark){:root{${rules(kDark)};color-scheme:dark}}`,
    `:root[data-theme=light]{${rules(kLight)};color-scheme:light}`,
    `:root[data-theme=dark]{${rules(kDark)};color-scheme:dark}`,
    // Where tiles are blue or orange, as the paths are elsewhere.
    ':root:root:root:root.third-pair{--board-own:var(--third-own);--board-other:var(--third-other)}',
    // Paper is white whatever the screen is; the doubled selector outweighs the ones above.
    `@media print{:root:root:root{${rules(kLight)};color-scheme:light}}`,
  ].join('\n');
}

export function installTheme(): void {
  const style = document.createElement('style');
  style.textContent = themeSheet();
  document.head.append(style);
}

const prefersDark = (): boolean => window.matchMedia('(prefers-color-scheme: dark)').matches;

export function themeToggle(): HTMLButtonElement {
  const root = document.documentElement;
  const isDark = (): boolean => (root.dataset.theme ?? (prefersDark() ? 'dark' : 'light')) === 'dark';
  const say = (): void => {
    toggle.textContent = isDark() ? 'Light theme' : 'Dark theme';
  };
  const toggle = button(
    '',
    () => {
      root.dataset.theme = isDark() ? 'light' : 'dark';
      say();
    },
    { class: 'theme-toggle' },
  );
  say();
  window.matchMedia('(prefers-color-scheme: dark)').addEventListener('change', say);
  return toggle;
}
