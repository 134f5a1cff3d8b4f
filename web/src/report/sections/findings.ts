import type { Finding } from '../document';
import { el } from '../../shared/dom';
import type { Study } from '../study';
import { resultTableView } from '../table_view';
import type { Section } from './section';

function finding(one: Finding): HTMLElement {
  const tables = one.tables ?? [];
  return el(
    'article',
    { class: 'finding', id: `finding-${one.id}` },
    el('h3', {}, one.title),
    one.question ? el('p', { class: 'question' }, one.question) : null,
    el('p', {}, one.sentence),
    ...(one.warnings ?? []).map((text) => el('p', { class: 'warning' }, el('strong', {}, 'Note: '), text)),
    ...tables.slice(0, 1).map(resultTableView),
    one.results ? el('p', { class: 'results' }, el('strong', {}, 'For a paper: '), one.results) : null,
    tables.length > 1
      ? el('details', {}, el('summary', {}, `More tables: ${one.title}`), ...tables.slice(1).map(resultTableView))
      : null,
  );
}

export function findingsSection(study: Study): Section | null {
  const findings = study.report.findings ?? [];
  if (findings.length === 0) return null;
  return { id: 'findings', title: 'Statistical tests', content: findings.map(finding) };
}
