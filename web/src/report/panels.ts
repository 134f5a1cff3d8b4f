// Small multiples which reflow: as many columns as the width allows.
import type { Json, Spec } from './chart';

export interface Place {
  firstColumn: boolean;
  lastRow: boolean;
  width: number;
}

export interface Grid {
  left: number; // room for the labels of the left axis, px
  min: number; // least width of a panel, px
  max?: number; // most columns
  gap?: number; // between columns, px
  first?: number | undefined; // panels before these, where the figure has others too
  rowGap?: number; // between rows, px: axis, title of the next panel
}

const kLetter = 6.8; // px, of titles
const kLine = 14;

// A title that is wider than its panel, broken at a comma.
function inLines(title: string, width: number): string | string[] {
  const lines: string[] = [];
  for (const part of title.split(/(?<=,) /)) {
    const longer = `${lines[lines.length - 1] ?? ''} ${part}`;
    if (lines.length > 0 && longer.length * kLetter <= width) lines[lines.length - 1] = longer;
    else lines.push(part);
  }
  return lines.length === 1 ? title : lines;
}

const letter = (i: number): string => String.fromCharCode(97 + (i % 26));

export function panels(count: number, width: number, grid: Grid, make: (i: number, place: Place) => Spec): Spec {
  const gap = grid.gap ?? 18;
  const fitting = Math.floor((width - grid.left - 16 + gap) / (grid.min + gap));
  const most = Math.max(1, Math.min(fitting, grid.max ?? count, count));
  const columns = Math.ceil(count / Math.ceil(count / most)); // 4 in 3 columns would leave one alone
  const inner = Math.floor((width - grid.left - 16 - gap * (columns - 1)) / columns);
  const concat: Json[] = [];
  let deepest = 1; // lines of a title
  for (let i = 0; i < count; ++i) {
    const panel = make(i, { firstColumn: i % columns === 0, lastRow: i + columns >= count, width: Math.max(inner, 80) });
    const isLettered = typeof panel.title === 'string' && (count > 1 || grid.first !== undefined);
    const title = isLettered ? `${letter((grid.first ?? 0) + i)}  ${String(panel.title)}` : panel.title;
    const lines = typeof title === 'string' ? inLines(title, inner) : title;
    if (Array.isArray(lines)) deepest = Math.max(deepest, lines.length);
    concat.push({ ...panel, title: lines });
  }
  return {
    $schema: 'https://vega.github.io/schema/vega-lite/v5.json',
    concat,
    columns,
    spacing: { row: (grid.rowGap ?? 48) + kLine * (deepest - 1), column: gap },
    bounds: 'flush',
  };
}

// Parts with axes of their own, one below the other.
export function stacked(parts: Spec[]): Spec {
  const [only] = parts;
  return parts.length === 1 && only ? only : { $schema: only?.$schema, vconcat: parts, spacing: 28, resolve: { scale: { color: 'independent', shape: 'independent' } } };
}

// Axes of inner panels keep their grid and lose their words. Labels that reach above the panel stay
// as invisible ones, or the title would stand lower than its neighbour's.
export function yAxis(place: Place, axis: Spec, hold = false): Spec {
  if (place.firstColumn) return axis;
  return { ...axis, title: null, ticks: false, domain: false, ...(hold ? { labelOpacity: 0 } : { labels: false }) };
}

export function extent(values: (number | null)[], zero = false): [number, number] {
  const known = values.filter((value): value is number => value !== null);
  if (zero) known.push(0);
  if (known.length === 0) return [0, 1];
  const low = Math.min(...known);
  const high = Math.max(...known);
  return low === high ? [low - 0.5, high + 0.5] : [low, high];
}

// Whole numbers within a domain, at most so many: periods, of which none lies between two.
export function wholeTicks([low, high]: [number, number], most: number): number[] {
  const step = Math.max(1, Math.ceil((high - low) / Math.max(1, most)));
  const first = Math.ceil(low / step) * step;
  return Array.from({ length: Math.max(0, Math.floor((high - first) / step) + 1) }, (_, i) => first + i * step);
}

// A domain that ends at round ticks, so that the axes of neighbours reach equally high.
export function roundTicks([low, high]: [number, number], count = 5): { domain: [number, number]; values: number[] } {
  const rough = (high - low) / count;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = power * ([1, 2, 5].find((factor) => factor * power >= rough * 0.9) ?? 10);
  const first = Math.floor(low / step + 1e-9);
  const last = Math.ceil(high / step - 1e-9);
  const values = Array.from({ length: last - first + 1 }, (_, i) => Number(((first + i) * step).toPrecision(12)));
  return { domain: [values[0] ?? low, values[values.length - 1] ?? high], values };
}
