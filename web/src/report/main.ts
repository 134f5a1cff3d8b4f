// Puts the report together from the document inside the page.
import { readReport } from './document';
import { el } from '../shared/dom';
import { figureSections } from './sections/figures';
import { findingsSection } from './sections/findings';
import { methodsSection } from './sections/methods';
import { noticesSection } from './sections/notices';
import { parametersSection } from './sections/parameters';
import { reproduceSection } from './sections/reproduce';
import { openForPrinting } from './print';
import type { Section } from './sections/section';
import { notesSection, summarySection } from './sections/summary';
import { Study } from './study';
import { installTheme, themeToggle } from '../shared/theme';

function sectionView({ id, title, content }: Section): HTMLElement {
  return el('section', { id, 'aria-labelledby': `${id}-title` }, el('h2', { id: `${id}-title` }, title), ...content);
}

function contents(sections: Section[]): HTMLElement {
  return el(
    'nav',
    { class: 'contents', 'aria-label': 'Contents' },
    el('ol', {}, ...sections.map(({ id, title }) => el('li', {}, el('a', { href: `#${id}` }, title)))),
  );
}

function show(page: HTMLElement): void {
  const study = new Study(readReport());
  const sections = [
    summarySection(study),
    notesSection(study),
    ...figureSections(study),
    findingsSection(study),
    parametersSection(study),
    methodsSection(study),
    reproduceSection(study),
    noticesSection(),
  ].filter((section): section is Section => section !== null);
  page.replaceChildren(
    el(
      'header',
      {},
      el('div', { class: 'masthead' }, el('p', { class: 'kicker' }, 'kith report'), themeToggle()),
      el('h1', {}, study.report.title),
    ),
    el(
      'div',
      { class: 'columns' },
      contents(sections),
      el('main', { id: 'main', tabindex: -1 }, ...sections.map(sectionView)),
    ),
  );
}

installTheme();
openForPrinting();
const page = document.getElementById('page');
if (page) {
  try {
    show(page);
  } catch (error) {
    page.replaceChildren(
      el('main', { id: 'main' }, el('h1', {}, 'This report cannot be shown'), el('p', {}, String(error))),
    );
    throw error;
  }
}
