// All colours, once, for light and dark. The page and its figures use them as CSS variables, so a
// change of theme or printing recolours everything at once; what is saved gets the light values.
import { button } from './dom';

type Scheme = Record<string, string>;

// Strategies have t0 to t7. The first five, those of the strategies that kith compares, differ in lightness, too: they
// stay apart in grey and for all kinds of colour vision, and contrast with the ground by 3 : 1 (tests/report_test.mjs).
const kLight: Scheme = {
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
  s2: '#d55e00',
  s3: '#00875f',
  s4: '#b24a8b',
  k0: '#a9c3dc',
  k1: '#5b8db8',
  k2: '#1f5a8c',
  k3: '#0b2f52',
  k4: '#c9b79c',
  k5: '#7d6a4b',
  bec: '#e69f00',
  truth: '#1c2127',
  own: '#332896',
  teacher: '#6b7280',
  common: '#12643e',
  joint: '#c67d9f',
  sphere: '#fafbfc',
  'board-floor': '#ffffff',
  'board-grid': '#d5d9de',
  'board-frame': '#57606a',
  'board-wall': '#3c444d',
  'board-ink': '#1c2127',
  'board-station': '#ffe08a',
  'board-thing': '#cfe6d8',
  'board-goal': '#b9e2c6',
  'board-done': '#00714a',
  'board-robot': '#1c2127',
  'board-own': '#0b5cad',
  'board-other': '#b8480a',
  'board-decisive': '#e69f00',
  'tint-brown': '#e9dcc9',
  'mark-brown': '#8f6f45',
  'tint-blue': '#d3e4f7',
  'mark-blue': '#5b8db8',
  'tint-green': '#d9ecd9',
  'mark-green': '#5d9a64',
  'tint-purple': '#e6dcf3',
  'mark-purple': '#8d6fb5',
  'tint-grey': '#e1e4e8',
  'mark-grey': '#87909b',
  'tint-orange': '#fbdcbf',
  'mark-orange': '#c9762b',
  'tint-red': '#f7d4d0',
  'mark-red': '#c25a50',
  'tint-yellow': '#f8edc0',
  'mark-yellow': '#b39a3a',
  'tint-dark': '#4a525c',
  'mark-dark': '#2b3138',
};
const kDark: Scheme = {
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
  s2: '#f28a3c',
  s3: '#2fc18f',
  s4: '#e08fc0',
  k0: '#2f5f8a',
  k1: '#5f97c7',
  k2: '#a3cbee',
  k3: '#dcecfa',
  k4: '#8a7651',
  k5: '#cbb68f',
  bec: '#e6a817',
  truth: '#ffffff',
  own: '#628bdf',
  teacher: '#aab2bd',
  common: '#63ed96',
  joint: '#9f5088',
  sphere: '#191d22',
  'board-floor': '#1f252c',
  'board-grid': '#343c46',
  'board-frame': '#8b949e',
  'board-wall': '#7d8691',
  'board-ink': '#f1f3f5',
  'board-station': '#6d5710',
  'board-thing': '#27523d',
  'board-goal': '#27563a',
  'board-done': '#2fc18f',
  'board-robot': '#f1f3f5',
  'board-own': '#7cb8f2',
  'board-other': '#f7a072',
  'board-decisive': '#f0b429',
  'tint-brown': '#3f3426',
  'mark-brown': '#97784f',
  'tint-blue': '#1f3a57',
  'mark-blue': '#5f8fbd',
  'tint-green': '#24402a',
  'mark-green': '#5d9a64',
  'tint-purple': '#382c4d',
  'mark-purple': '#8d72b8',
  'tint-grey': '#3a4149',
  'mark-grey': '#838d98',
  'tint-orange': '#55361b',
  'mark-orange': '#c47a38',
  'tint-red': '#522a28',
  'mark-red': '#c0625a',
  'tint-yellow': '#48401d',
  'mark-yellow': '#a8923f',
  'tint-dark': '#0a0c0f',
  'mark-dark': '#3a424c',
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
  const toggle = button(
    'Dark theme',
    () => {
      root.dataset.theme = isDark() ? 'light' : 'dark';
      toggle.setAttribute('aria-pressed', String(isDark()));
    },
    { class: 'theme-toggle' },
  );
  toggle.setAttribute('aria-pressed', String(isDark()));
  window.matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => {
    toggle.setAttribute('aria-pressed', String(isDark()));
  });
  return toggle;
}
