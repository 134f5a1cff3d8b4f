import { el } from '../../shared/dom';
import type { Section } from './section';

// The texts are put into the page when it is bundled.
export function noticesSection(): Section | null {
  const notices = document.getElementById('kith-notices');
  if (!(notices instanceof HTMLTemplateElement)) return null;
  return {
    id: 'notices',
    title: 'Notices',
    content: [
      el(
        'details',
        { class: 'licences' },
        el('summary', {}, 'Licences of the software inside this page'),
        notices.content,
      ),
    ],
  };
}
