// A figure on the page: drawing, caption, save buttons and its data as a table.
import { type Drawing, draw, toPng, toSvg } from './chart';
import type { Table } from './document';
import { announce, button, el, lazyDetails } from '../shared/dom';
import type { Figure } from './figures/figure';
import { download } from '../shared/download';
import { toCsv } from './save';
import { tableView } from './table_view';
import type { Words } from './words';

export const kPaperWidth = 720; // px, of saved figures
const kSettleMs = 150; // after the last change of width

export interface Saves {
  file: string;
  what: string; // "figure 3", for the buttons' names
  svg(): Promise<Blob>;
  png(): Promise<Blob>;
  table: Table;
  raw?: Figure['raw'];
}

export function saveButtons(saves: Saves): HTMLElement {
  const kinds: { label: string; name: string; file: string; ending: string; make(): Promise<Blob> }[] = [
    { label: 'SVG', name: `Save ${saves.what} as SVG`, file: saves.file, ending: 'svg', make: saves.svg },
    { label: 'PNG', name: `Save ${saves.what} as PNG`, file: saves.file, ending: 'png', make: saves.png },
    {
      label: 'CSV',
      name: `Save the data of ${saves.what} as CSV`,
      file: saves.file,
      ending: 'csv',
      make: () => Promise.resolve(toCsv(saves.table)),
    },
  ];
  const raw = saves.raw;
  if (raw) {
    kinds.push({
      label: `CSV of ${raw.what}`,
      name: `Save the ${raw.what} of ${saves.what} as CSV`,
      file: `${saves.file}-${raw.what}`,
      ending: 'csv',
      make: () => Promise.resolve(toCsv(raw.table)),
    });
  }
  const buttons = kinds.map(({ label, name, file, ending, make }) => {
    const save = async (): Promise<void> => {
      download(await make(), `${file}.${ending}`);
      announce(`Saved ${file}.${ending}`);
    };
    return button(label, () => void save(), { 'aria-label': name, title: name, 'data-save': ending });
  });
  return el('div', { class: 'actions', role: 'group', 'aria-label': `Save ${saves.what}` }, ...buttons);
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
      svg: () => toSvg(figure.spec(kPaperWidth)),
      png: () => toPng(figure.spec(kPaperWidth)),
      table: figure.table,
      raw: figure.raw,
    }),
    lazyDetails(`Data of ${what}`, () => tableView(figure.table, `Data of ${what}: ${figure.title}`, words)),
  );
  keepDrawn(drawing, figure);
  return view;
}
