import { copyButton } from '../copy';
import { el, lazyDetails } from '../../shared/dom';
import type { Study } from '../study';
import { tableView } from '../table_view';
import { listOf } from '../words';
import type { Section } from './section';

// What the study is.
function factsList(study: Study): HTMLElement {
  const { overview, domain, version, created } = study.report;
  const count = (value: number | undefined): string => (value === undefined ? '' : String(value));
  const list: [string, string][] = [
    ['Domain', domain],
    ['Strategies', listOf(overview.strategies.map((code) => study.words.strategy(code)))],
    ['Compositions', listOf(overview.compositions)],
    [
      'Teams',
      overview.completed === undefined
        ? count(overview.teams)
        : `${count(overview.teams)}, of which ${overview.completed} ${overview.done ?? 'passed all tests'}` +
          (overview.skipped ? ` and ${overview.skipped} left components out` : ''),
    ],
    ['People', count(overview.people)],
    ['Replicates per cell', count(overview.replicates)],
    ['Seed', String(overview.seed ?? '')],
    [
      'Made',
      [created?.replace('T', ' ').replace('Z', ' UTC'), version ? `by kith ${version}` : ''].filter(Boolean).join(' '),
    ],
  ];
  const shown = list.filter(([, value]) => value !== '');
  return el(
    'dl',
    { class: 'facts' },
    ...shown.map(([name, value]) => el('div', {}, el('dt', {}, name), el('dd', {}, value))),
  );
}

const file = (name: string, text: string): HTMLElement =>
  el('details', {}, el('summary', {}, name), el('pre', { tabindex: 0 }, text), copyButton(name, text));

export function reproduceSection(study: Study): Section | null {
  const about = study.report.reproduce;
  if (!about) return null;
  const content: HTMLElement[] = [factsList(study)];
  if (about.command) {
    content.push(
      el('p', {}, 'The same files and command give the same tables, byte for byte:'),
      el('pre', { tabindex: 0 }, about.command),
      copyButton('command', about.command),
    );
  }
  if (about.version) content.push(el('p', {}, `Program: ${about.version}.`));
  if (about.study_toml) content.push(file('study.toml', about.study_toml));
  if (about.domain_toml) content.push(file('domain.toml', about.domain_toml));
  const hashes = Object.entries(about.hashes ?? {});
  if (hashes.length > 0) {
    content.push(
      el(
        'details',
        {},
        el('summary', {}, 'SHA-256 of inputs and tables'),
        tableView({ columns: ['file', 'SHA-256'], rows: hashes }, 'SHA-256 of inputs and tables', study.words),
      ),
    );
  }
  const timings = study.table('timings');
  if (timings) content.push(lazyDetails('Seconds per phase of the run', () => tableView(timings, 'Seconds per phase of the run', study.words)));
  return { id: 'reproduce', title: 'How to reproduce', content };
}
