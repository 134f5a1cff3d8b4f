import type { Headline } from '../document';
import { el } from '../../shared/dom';
import type { Study } from '../study';
import { formatFixed, listOf, plural } from '../words';
import type { Section } from './section';

// Shares need a digit more than counts.
const digitsOf = ({ value }: Headline): number => (value !== null && Math.abs(value) < 2 ? 3 : 2);

function card(headline: Headline): HTMLElement {
  const { label, value, sd, low, high, n } = headline;
  const digits = digitsOf(headline);
  const details = [
    typeof sd === 'number' ? `sd ${formatFixed(sd, digits)}` : '',
    typeof low === 'number' && typeof high === 'number'
      ? `95\u00a0% interval ${formatFixed(low, digits)} to ${formatFixed(high, digits)}`
      : '',
    typeof n === 'number' ? plural(n, 'team') : '',
  ].filter(Boolean);
  return el(
    'div',
    { class: 'card' },
    el('dt', {}, label),
    el('dd', { class: 'value' }, formatFixed(value, digits)),
    ...details.map((text) => el('dd', {}, text)),
  );
}

function facts(study: Study): [string, string][] {
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
        : `${count(overview.teams)}, of which ${overview.completed} learned everything` +
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
  return list.filter(([, value]) => value !== '');
}

export function summarySection(study: Study): Section {
  const headlines = study.report.overview.headlines ?? [];
  return {
    id: 'summary',
    title: 'Summary',
    content: [
      ...(study.report.overview.summary ?? []).map((sentence) => el('p', { class: 'lead' }, sentence)),
      ...(headlines.length > 0 ? [el('dl', { class: 'cards' }, ...headlines.map(card))] : []),
      el(
        'dl',
        { class: 'facts' },
        ...facts(study).map(([name, value]) => el('div', {}, el('dt', {}, name), el('dd', {}, value))),
      ),
    ],
  };
}

export function notesSection(study: Study): Section | null {
  const notes = [...(study.report.notes ?? [])];
  if (study.factors.length > 0) {
    notes.push(
      `The study also varies ${listOf(study.factors)}; where a table tells its variants apart, figures show the first one.`,
    );
  }
  if (notes.length === 0) return null;
  return {
    id: 'notes',
    title: 'Notes on the data',
    content: [el('ul', { class: 'notes' }, ...notes.map((note) => el('li', {}, note)))],
  };
}
