// A figure on the page: drawing, caption, save buttons and its data as a table.
import { type Drawing, type Spec, draw } from './chart';
import type { Cell, Table } from './document';
import { announce, button, el, lazyDetails } from '../shared/dom';
import type { Figure } from './figures/figure';
import { download } from '../shared/download';
import { type Format, kWidths, paperFile } from './paper';
import { toCsv } from './save';
import { kOpenTeam } from './sections/team';
import { tableView } from './table_view';
import type { Words } from './words';

const kSettleMs = 150; // after the last change of width

export interface Saves {
  file: string;
  what: string; // "figure 3", for the buttons' names
  spec(width: number): Spec | string; // or an SVG
  table: Table;
  raw?: Figure['raw'];
}

export function saveButtons(saves: Saves): HTMLElement {
  const { file, what, raw } = saves;
  const width = el(
    'select',
    { 'aria-label': `Width of ${what} in print` },
    ...kWidths.map((mm, i) => el('option', { value: mm, selected: i === kWidths.length - 1 }, `${mm} mm`)),
  );
  const save = async (name: string, make: () => Promise<Blob>): Promise<void> => {
    download(await make(), name);
    announce(`Saved ${name}`);
  };
  const saving = (label: string, ending: string, title: string, name: string, make: () => Promise<Blob>): HTMLElement =>
    button(label, () => void save(name, make), { 'aria-label': title, title, 'data-save': ending });
  const formats: Format[] = ['svg', 'png'];
  const pictures = formats.map((format) =>
    saving(format.toUpperCase(), format, `Save ${what} as ${format.toUpperCase()}`, `${file}.${format}`, () =>
      paperFile((pixels) => saves.spec(pixels), Number(width.value), format),
    ),
  );
  const csv = (label: string, title: string, name: string, table: Table): HTMLElement =>
    saving(label, 'csv', title, `${name}.csv`, () => Promise.resolve(toCsv(table)));
  return el(
    'div',
    { class: 'actions', role: 'group', 'aria-label': `Save ${what}` },
    width,
    ...pictures,
    csv('CSV', `Save the data of ${what} as CSV`, file, saves.table),
    raw ? csv(`CSV of ${raw.what}`, `Save the ${raw.what} of ${what} as CSV`, `${file}-${raw.what}`, raw.table) : null,
  );
}

// A dot that is a team leads to it.
function openTeam(datum: { team?: Cell } | undefined): void {
  if (typeof datum?.team !== 'number') return;
  document.dispatchEvent(new CustomEvent(kOpenTeam, { detail: datum.team }));
}

// Draws now and again whenever the width has changed for good.
function keepDrawn(box: HTMLElement, figure: Figure): void {
  let drawing: Drawing | null = null;
  let drawnWidth = 0;
  let timer = 0;
  let queue = Promise.resolve(); // one drawing at a time: two in one box would both stay
  const redraw = async (): Promise<void> => {
    const width = Math.floor(box.clientWidth);
    if (width === 0 || width === drawnWidth) return;
    drawnWidth = width;
    drawing?.finish();
    drawing = await draw(box, figure.spec(Math.min(width, 980)));
    drawing.view.addEventListener('click', (_, item) => openTeam(item?.datum as { team?: Cell } | undefined));
    box.dataset.drawn = String(width);
  };
  const schedule = (): void => {
    queue = queue.then(redraw).catch((error: unknown) => {
      console.error(error);
      box.textContent = `This figure could not be drawn: ${String(error)}`;
    });
  };
  new ResizeObserver(() => {
    clearTimeout(timer);
    timer = window.setTimeout(schedule, drawnWidth === 0 ? 0 : kSettleMs);
  }).observe(box);
}

export function figureView(figure: Figure, number: number, study: string, words: Words): HTMLElement {
  const what = `figure ${number}`;
  const drawing = el('div', { class: 'drawing', 'aria-hidden': 'true' });
  const chart = el('div', { class: 'chart', role: 'img', 'aria-label': figure.gist }, drawing);
  const captionId = `${figure.id}-caption`;
  const view = el(
    'figure',
    { id: `figure-${figure.id}`, 'aria-labelledby': captionId },
    chart,
    el('figcaption', { id: captionId }, el('strong', {}, `Figure ${number}. ${figure.title}.`), ` ${figure.reading}`),
    saveButtons({
      file: `${study}-${figure.id}`,
      what,
      spec: (width) => figure.spec(width),
      table: figure.table,
      raw: figure.raw,
    }),
    lazyDetails(`Data of ${what}`, () => tableView(figure.table, `Data of ${what}: ${figure.title}`, words)),
  );
  keepDrawn(drawing, figure);
  return view;
}
