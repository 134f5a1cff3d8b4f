import { el, lazyDetails } from '../../shared/dom';
import type { Study } from '../study';
import { tableView } from '../table_view';
import type { Table } from '../document';
import type { Section } from './section';

// One table per group, where the table is grouped.
function byGroup(table: Table): [string, Table][] {
  const at = table.columns.indexOf('group');
  if (at < 0) return [['Parameters', table]];
  const groups = [...new Set(table.rows.map((row) => String(row[at] ?? '')))];
  const without = <T>(row: T[]): T[] => row.filter((_, i) => i !== at);
  return groups.map((group) => [
    group,
    { columns: without(table.columns), rows: table.rows.filter((row) => String(row[at] ?? '') === group).map(without) },
  ]);
}

export function parametersSection(study: Study): Section | null {
  const table = study.table('parameters');
  if (!table) return null;
  return {
    id: 'parameters',
    title: 'Parameters',
    content: [
      lazyDetails('Every parameter of the study as it was used', () =>
        el(
          'div',
          {},
          ...byGroup(table).map(([group, part]) =>
            el('div', { class: 'parameters' }, tableView(part, group, study.words)),
          ),
        ),
      ),
    ],
  };
}
