// Two things that a study varies against each other, as a heat map with the values in it.
import type { Json, Spec } from '../chart';
import { type Matrix, type Outcome, type Row, num } from '../document';
import { type Study, rowsOf } from '../study';
import type { Figure } from './figure';
import { counted } from './gist';

const kLetter = 6.3; // width of a letter of a name, px
const kLeft = 130; // most room for the names of rows
const kLeast = 56; // width of a column: fewer of them stand beside each other where there is no room
const kTitle = 22; // room for the name of what varies
const kHeight = 27;
const kFaintest = 0.04; // opacity of the best value; text stays readable on the strongest
const kStrongest = 0.44;
const kWide = 20; // from the least to the greatest value, a scale of ratios tells more
const kRange = 1000; // and smaller parts of the greatest, such as none, look alike

// "teacher.process_noise": process noise.
const inWords = (factor: string): string => factor.slice(factor.lastIndexOf('.') + 1).replaceAll('_', ' ');
const levels = (rows: Row[], name: string): string[] => [...new Set(rows.map((row) => String(row[name])))];
const valuesOf = (rows: Row[], { column }: Outcome): number[] =>
  rows.map((row) => num(row[`${column}_mean`])).filter((value): value is number => value !== null);
const isOfRatios = (values: number[]): boolean =>
  Math.min(...values) >= 0 && Math.max(...values) > kWide * Math.min(...values);

// How bad a value is among all of an outcome, from 0 to 1.
function badness(values: number[], { less_is_better: less }: Outcome): (value: number) => number {
  const floor = Math.max(...values) / kRange;
  const place = isOfRatios(values) ? (value: number): number => Math.log(Math.max(value, floor)) : (value: number): number => value;
  const [least, most] = [place(Math.min(...values)), place(Math.max(...values))];
  return (value) => {
    const share = most > least ? (place(value) - least) / (most - least) : 0;
    return less ? share : 1 - share;
  };
}

// The levels of the first factor for which one of the second is clearly worse than the best.
const levelsThatDiffer = (rows: Row[], down: string, { column }: Outcome): Set<string> =>
  new Set(rows.filter((row) => row[`${column}_standing`] === '' && num(row[`${column}_mean`]) !== null).map((row) => String(row[down])));

const widest = (names: string[]): number => kLetter * Math.max(...names.map((name) => name.length));
const leftOf = (rows: Row[], { factors: [down] }: Matrix): number => Math.min(kLeft, widest(levels(rows, down)) + 10);

function block(matrix: Matrix, outcome: Outcome, rows: Row[], columns: string[], cell: number, title: string | null): Spec {
  const [down, across] = matrix.factors;
  const { column, digits } = outcome;
  const bad = badness(valuesOf(rows, outcome), outcome);
  const differ = levelsThatDiffer(rows, down, outcome);
  const shown = rows
    .filter((row) => columns.includes(String(row[across])))
    .map((row) => {
      const value = num(row[`${column}_mean`]);
      const standing = differ.has(String(row[down])) ? String(row[`${column}_standing`]) : '';
      return {
        down: String(row[down]),
        across: String(row[across]),
        teams: row.teams ?? null,
        low: num(row[`${column}_low`]),
        high: num(row[`${column}_high`]),
        value,
        standing,
        text: value === null ? '' : value.toFixed(digits),
        bad: value === null || differ.size === 0 ? 0 : bad(value),
      };
    });
  const axis = { ticks: false, domain: false, labelFontSize: 11, labelColor: 'var(--text)' };
  const band = (field: string, domain: string[], more: Spec): Spec => ({
    field,
    type: 'nominal',
    scale: { domain, paddingInner: 0.06, paddingOuter: 0.03 },
    axis: { ...axis, ...more },
  });
  const named = { labelOverlap: false, labelPadding: 6 };
  const isBroken = widest(columns) > cell; // at the hyphen, and the second line stands on the cells
  const heads = isBroken ? { labelExpr: "indexof(datum.label, '-') < 0 ? ['', datum.label] : split(datum.label, '-')", labelPadding: 19 } : {};
  const place = {
    x: band('across', columns, { ...named, ...heads, title: inWords(across), orient: 'top', labelAngle: 0, labelLimit: cell }),
    y: band('down', levels(rows, down), { ...named, title: inWords(down), labelLimit: kLeft }),
  };
  const tooltip = [
    { field: 'down', title: down },
    { field: 'across', title: across },
    { field: 'value', title: outcome.name, format: '.3~r' },
    { field: 'low', title: '95\u00a0% from', format: '.3~r' },
    { field: 'high', title: 'to', format: '.3~r' },
    { field: 'teams', title: 'Teams' },
    { field: 'standing', title: 'Within its row' },
  ];
  const opacity = { field: 'bad', type: 'quantitative', legend: null, scale: { domain: [0, 1], range: [kFaintest, kStrongest] } };
  return {
    title: title ?? undefined,
    width: cell * columns.length,
    height: kHeight * levels(rows, down).length,
    data: { values: shown as unknown as Json },
    encoding: place,
    layer: [
      { mark: { type: 'rect', fill: 'var(--link)' }, encoding: { fillOpacity: opacity, tooltip } },
      { mark: { type: 'text', fontSize: 11.5 }, encoding: { text: { field: 'text' } } },
    ],
  };
}

function spec(matrix: Matrix, rows: Row[], width: number): Spec {
  const columns = levels(rows, matrix.factors[1]);
  const room = width - leftOf(rows, matrix) - kTitle - 16;
  const blocks = Math.ceil(columns.length / Math.max(1, Math.floor(room / kLeast)));
  const each = Math.ceil(columns.length / blocks);
  const cell = Math.min(96, Math.floor(room / each));
  const parts = matrix.outcomes.flatMap((outcome, i) =>
    Array.from({ length: blocks }, (_, b) =>
      block(
        matrix,
        outcome,
        rows,
        columns.slice(b * each, (b + 1) * each),
        cell,
        b === 0 ? `${matrix.outcomes.length > 1 ? `${String.fromCharCode(97 + i)}  ` : ''}${outcome.name}` : null,
      ),
    ),
  );
  return { $schema: 'https://vega.github.io/schema/vega-lite/v5.json', vconcat: parts, spacing: 16 };
}

function bestOf(rows: Row[], [down, across]: Matrix['factors'], outcome: Outcome): string {
  const { column, name, digits } = outcome;
  const parts = levels(rows, down).map((level) => {
    if (!levelsThatDiffer(rows, down, outcome).has(level)) return `${level}: none is clearly worse than another`;
    const best = rows.filter((row) => String(row[down]) === level && row[`${column}_standing`] === 'best');
    const value = num(best[0]?.[`${column}_mean`]);
    return `${level}: ${best.map((row) => String(row[across])).join(' and ')}${value === null ? '' : ` ${value.toFixed(digits)}`}`;
  });
  return `${name}, best in each row: ${parts.join('; ')}.`;
}

export function matrixFigures(study: Study): Figure[] {
  return (study.report.matrices ?? []).map((matrix, i) => {
    const rows = rowsOf(matrix.table);
    const [down, across] = matrix.factors;
    const title = `${inWords(across).replace(/^./, (letter) => letter.toUpperCase())} by ${inWords(down)}`;
    const ratios = matrix.outcomes.filter((outcome) => isOfRatios(valuesOf(rows, outcome)));
    const scale = ratios.length > 0 ? ` (${ratios.map(({ name }) => name.toLowerCase()).join(', ')}: on a scale of ratios)` : '';
    const sums = matrix.outcomes.some(({ column }) => column === 'periods') && rows.some((row) => row.strategy === 'baseline');
    return {
      id: `matrix-${i + 1}`,
      title,
      reading: `Means over teams at the end of teaching; the stronger the colour, the worse${scale}. Where nothing is clearly worse than the best of its panel, there is no colour.${sums ? ' Periods of the baseline are summed over members.' : ''} ${counted(rows, 'teams', 'teams in a cell')} ${study.words.letters()}`,
      gist: `${title}. ${matrix.outcomes.map((outcome) => bestOf(rows, matrix.factors, outcome)).join(' ')}`,
      table: matrix.table,
      spec: (width) => spec(matrix, rows, width),
    };
  });
}
