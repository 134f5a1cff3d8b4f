// The first screen: what was found, how large it is, and what the study cannot say.
import type { Answer } from '../document';
import { el } from '../../shared/dom';
import { differencesFigures } from '../figures/differences';
import { figureView } from '../figure_view';
import type { Study } from '../study';
import { formatFixed, formatP } from '../words';
import type { FigureNumbers } from './figures';
import type { Section } from './section';

// A bound is rounded away from 0, so that it stays one.
function roundedUp(value: number, digits: number): string {
  const scale = 10 ** digits;
  return formatFixed(Math.ceil(value * scale - 1e-9) / scale, digits);
}

function effect({ estimate, low, high, bound, digits }: Answer): string {
  if (bound !== null) return `any two differ by less than ${roundedUp(bound, digits)}`;
  if (estimate === null) return '\u2013';
  const value = formatFixed(estimate, digits);
  return low === null || high === null ? value : `${value} [${formatFixed(low, digits)}, ${formatFixed(high, digits)}]`;
}

function answersTable(answers: Answer[]): HTMLElement {
  const isTested = answers.some(({ p }) => p !== null);
  const heads = isTested
    ? ['Question', 'Means', 'Difference [95\u00a0% interval]', 'p', 'Answer']
    : ['Outcome', 'Mean [95\u00a0% interval]'];
  const row = (answer: Answer): HTMLElement => {
    const { outcome, finding, p } = answer;
    const name = finding ? el('a', { href: `#finding-${finding}` }, outcome) : outcome;
    const compared = answer.compared ? ` ${answer.compared.replaceAll(' - ', ' \u2212 ')}` : '';
    const size = el('td', {}, effect(answer), compared ? el('small', {}, compared) : null);
    return el(
      'tr',
      { class: p !== null && p < 0.05 ? 'shown' : undefined },
      el('th', { scope: 'row' }, name),
      ...(isTested
        ? [
            el('td', {}, answer.means ?? ''),
            size,
            el('td', {}, p === null ? '\u2013' : formatP(p)),
            el('td', {}, answer.answer),
          ]
        : [size]),
    );
  };
  const questions = [...new Set(answers.map(({ question }) => question))];
  const groups = questions.map((question) =>
    el(
      'tbody',
      {},
      el('tr', { class: 'group' }, el('th', { scope: 'rowgroup', colspan: heads.length }, question)),
      ...answers.filter((one) => one.question === question).map(row),
    ),
  );
  const caption = 'Answers';
  return el(
    'div',
    { class: 'scroll answers', tabindex: 0, role: 'region', 'aria-label': `Table: ${caption}` },
    el(
      'table',
      {},
      el('caption', { class: 'visually-hidden' }, caption),
      el('thead', {}, el('tr', {}, ...heads.map((head) => el('th', { scope: 'col' }, head)))),
      ...groups,
    ),
  );
}

function limitsBox(limits: string[]): HTMLElement {
  return el(
    'div',
    { class: 'limits' },
    el('h3', {}, 'What this study cannot say'),
    el('ul', {}, ...limits.map((text) => el('li', {}, text))),
  );
}

export function summarySection(study: Study, numbers: FigureNumbers): Section {
  const { overview, study: name } = study.report;
  const { answers = [], limits = [] } = overview;
  return {
    id: 'summary',
    title: 'Summary',
    content: [
      ...(overview.summary ?? []).map((sentence) => el('p', { class: 'lead' }, sentence)),
      ...differencesFigures(study)
        .slice(0, 1)
        .map((figure) => figureView(figure, numbers.next(), name, study.words)),
      ...(answers.length > 0 ? [answersTable(answers)] : []),
      ...(limits.length > 0 ? [limitsBox(limits)] : []),
    ],
  };
}

export function notesSection(study: Study): Section | null {
  const notes = study.report.notes ?? [];
  if (notes.length === 0) return null;
  return {
    id: 'notes',
    title: 'Notes on the data',
    content: [el('ul', { class: 'notes' }, ...notes.map((note) => el('li', {}, note)))],
  };
}
