import { copyButton } from '../copy';
import { el } from '../../shared/dom';
import type { Study } from '../study';
import type { Section } from './section';

export function methodsSection(study: Study): Section | null {
  const methods = study.report.methods;
  if (!methods) return null;
  const references = methods.references ?? [];
  const bibtex = references
    .map(({ bibtex: entry }) => entry ?? '')
    .filter(Boolean)
    .join('\n\n');
  const content: HTMLElement[] = [
    el('p', { class: 'paragraph' }, methods.paragraph),
    copyButton('paragraph', methods.paragraph),
  ];
  if (references.length > 0) {
    content.push(
      el('h3', {}, 'References'),
      el(
        'ul',
        { class: 'references' },
        ...references.map(({ key, text }) => el('li', { id: `reference-${key}` }, text)),
      ),
    );
  }
  if (bibtex) {
    content.push(
      el('details', {}, el('summary', {}, 'BibTeX'), el('pre', { tabindex: 0 }, bibtex), copyButton('BibTeX', bibtex)),
    );
  }
  return { id: 'methods', title: 'Methods', content };
}
