import { copyButton } from '../copy';
import { el } from '../../shared/dom';
import type { Study } from '../study';
import { tableView } from '../table_view';
import type { Section } from './section';

const file = (name: string, text: string): HTMLElement =>
  el('details', {}, el('summary', {}, name), el('pre', { tabindex: 0 }, text), copyButton(name, text));

export function reproduceSection(study: Study): Section | null {
  const about = study.report.reproduce;
  if (!about) return null;
  const content: HTMLElement[] = [];
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
  return { id: 'reproduce', title: 'How to reproduce', content };
}
