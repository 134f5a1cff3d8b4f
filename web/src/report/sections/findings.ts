// Every test in one table; each opens to its tables and its text for a paper.
import { copyButton } from '../copy';
import type { Finding, Row } from '../document';
import { el, lazyDetails } from '../../shared/dom';
import type { Study } from '../study';
import { resultTableView } from '../table_view';
import { formatResult } from '../words';
import type { Section } from './section';

const kEffects: { field: string; name: string; kind: 'number' | 'fraction'; level: string }[] = [
  { field: 'difference', name: '', kind: 'number', level: '' },
  { field: 'ratio', name: 'ratio ', kind: 'number', level: '' },
  { field: 'odds_ratio', name: 'odds ratio ', kind: 'number', level: '' },
  { field: 'variance_ratio', name: 'ratio of variances ', kind: 'fraction', level: '' },
  { field: 'partial_eta_squared', name: '\u03b7\u00b2p ', kind: 'fraction', level: ' (90\u00a0%)' },
];
const kP = ['corrected_p_value', 'adjusted_p_value', 'p_value'];

function statistic(row: Row): string {
  const value = (field: string): string => formatResult(row[field], 'number');
  const df = [row.df, row.residual_df].filter((part) => part !== undefined && part !== '').join(', ');
  if (typeof row.f === 'number') return `F(${df}) = ${value('f')}`;
  if (typeof row.t !== 'number') return '';
  const tDf = typeof row.df === 'number' ? value('df') : typeof row.n === 'number' ? String(row.n - 1) : '';
  return `t${tDf ? `(${tDf})` : ''} = ${value('t')}`;
}

function effect(row: Row): string {
  const known = kEffects.find(({ field }) => typeof row[field] === 'number');
  if (!known) return '';
  const at = (field: string): string => formatResult(row[field], known.kind);
  const hasLimits = typeof row.lower_limit === 'number' && typeof row.upper_limit === 'number';
  return `${known.name}${at(known.field)}${hasLimits ? ` [${at('lower_limit')}, ${at('upper_limit')}]${known.level}` : ''}`;
}

// The rows of a finding's first table that are tests.
function testRows(finding: Finding): HTMLElement[] {
  const table = finding.tables?.[0];
  if (!table) return [];
  const texts = table.columns.filter(({ kind, field }) => kind === 'text' && !/df$/.test(field));
  const p = kP.find((field) => table.columns.some((column) => column.field === field)) ??
    table.columns.find(({ kind }) => kind === 'p')?.field;
  if (!p) return [];
  return table.rows
    .filter((row) => row[p] !== undefined)
    .map((row) => {
      const isShown = typeof row[p] === 'number' && row[p] < 0.05;
      return el(
        'tr',
        { class: isShown ? 'shown' : undefined },
        el('th', { scope: 'row' }, texts.map(({ field }) => String(row[field] ?? '')).join(', ').replaceAll(' - ', ' \u2212 ')),
        el('td', {}, statistic(row)),
        el('td', {}, effect(row)),
        el('td', { class: 'number' }, `${formatResult(row[p], 'p')}${p === 'p_value' || !kP.includes(p) ? '' : '*'}`),
      );
    });
}

const note = (text: string): HTMLElement => el('p', { class: 'warning' }, el('strong', {}, 'Note: '), text);

const kHeads = ['Test', 'Statistic', 'Effect [95\u00a0% interval]', 'p'];

// The tests of a finding; the rest opens below them.
function view(one: Finding, repeated: Set<string>): HTMLElement {
  const rows = testRows(one);
  const content = (): HTMLElement =>
    el(
      'div',
      {},
      one.question ? el('p', { class: 'question' }, one.question) : null,
      el('p', {}, one.sentence),
      ...(one.warnings ?? []).filter((text) => !repeated.has(text)).map(note),
      one.results ? el('p', { class: 'results' }, el('strong', {}, 'For a paper: '), one.results) : null,
      one.results ? copyButton('text for a paper', one.results) : null,
      ...(one.tables ?? []).map(resultTableView),
    );
  const title = one.title.replace(/^./, (letter) => letter.toUpperCase());
  return el(
    'div',
    { class: 'finding', id: `finding-${one.id}` },
    el('h3', {}, title),
    rows.length === 0
      ? el('p', {}, one.sentence)
      : el(
          'div',
          { class: 'scroll tests', tabindex: 0, role: 'region', 'aria-label': `Tests: ${title}` },
          el('table', {}, el('caption', { class: 'visually-hidden' }, title), el('thead', {}, el('tr', {}, ...kHeads.map((head, i) => el('th', { scope: 'col', class: i === 3 ? 'number' : undefined }, head)))), el('tbody', {}, ...rows)),
        ),
    lazyDetails('What was asked, text for a paper, all tables', content),
  );
}

export function findingsSection(study: Study): Section | null {
  const findings = study.report.findings ?? [];
  if (findings.length === 0) return null;
  const all = findings.flatMap(({ warnings = [] }) => warnings);
  const repeated = new Set(all.filter((text, i) => all.indexOf(text) !== i));
  return {
    id: 'findings',
    title: 'Statistical tests',
    content: [
      el(
        'p',
        { class: 'about' },
        'p: two-sided; * corrected for the number of tests of its table. \u03b7\u00b2p: partial eta squared, with its 90\u00a0% interval. Rows in bold have p below 0.05.',
      ),
      ...[...repeated].map(note),
      ...findings.map((one) => view(one, repeated)),
    ],
  };
}
