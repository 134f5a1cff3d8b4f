// The page: a Markdown file with generated parts between comments.
//
//   <!--table NAME--> ... <!--end-->   a table, made by the content of the page (such as validation_content.mjs)
//   <!--f NAME-->7.72<!--/f-->         a figure in a sentence
//   <!--holds NAME-->                  the sentence before it states what a claim of the content tests
//
// Outside of these and of `code`, a number with a decimal point, a percentage (but 95 %) or one with
// thousands set apart is an error: nobody computed it.

const PART = /<!--table ([^>]*?)-->\n([\s\S]*?)<!--end-->|<!--f ([\w.-]+)-->([\s\S]*?)<!--\/f-->|<!--holds ([\w.-]+)-->/g;

// [{text} | {table, text} | {figure, text} | {claim}], in the order of the page.
export function parsePage(page) {
  const parts = [];
  let end = 0;
  for (const match of page.matchAll(PART)) {
    parts.push({ kind: 'text', text: page.slice(end, match.index), at: end });
    const [all, table, content, figure, printed, claim] = match;
    if (table) parts.push({ kind: 'table', name: table, text: content, at: match.index });
    else if (figure) parts.push({ kind: 'figure', name: figure, text: printed, at: match.index });
    else parts.push({ kind: 'claim', name: claim, text: '', at: match.index });
    end = match.index + all.length;
  }
  parts.push({ kind: 'text', text: page.slice(end), at: end });
  return parts;
}

export function printPage(parts) {
  return parts
    .map(({ kind, name, text }) => {
      if (kind === 'text') return text;
      if (kind === 'figure') return `<!--f ${name}-->${text}<!--/f-->`;
      if (kind === 'claim') return `<!--holds ${name}-->`;
      return `<!--table ${name}-->\n${text}<!--end-->`;
    })
    .join('');
}

const lineOf = (page, at) => page.slice(0, at).split('\n').length;

// Marks that are not closed, and figures typed by hand.
export function findTypedFigures(page) {
  const found = [];
  for (const part of parsePage(page)) {
    if (part.kind !== 'text') continue;
    for (const mark of part.text.matchAll(/<!--/g)) {
      found.push(`line ${lineOf(page, part.at + mark.index)}: a mark that is not closed or not known`);
    }
    const prose = part.text.replace(/```[\s\S]*?```|`[^`]*`|\]\([^)]*\)|<!--[\s\S]*?-->/g, (code) => ' '.repeat(code.length));
    for (const number of prose.matchAll(/(?<![\w.])[+-]?\d*\.\d+|\b(?!95 %)\d+ %|\b\d{1,3} \d{3}\b/g)) {
      found.push(`line ${lineOf(page, part.at + number.index)}: the figure ${number[0].trim()} is typed by hand`);
    }
  }
  return found;
}

// A table of cells: text, or {text, value, se}, where se is undefined for what is exact.
export function printTable({ columns, rows }) {
  const print = (cells) => `| ${cells.map((cell) => (typeof cell === 'string' ? cell : cell.text)).join(' | ')} |`;
  const rule = `|${columns.map(() => '---').join('|')}|`;
  return [print(columns), rule, ...rows.map(print)].join('\n') + '\n';
}

const cellsOf = (line) => line.replace(/^\| ?| ?\|$/g, '').split(/ *\| */);

// What differs between a printed table and a new one: [{figure, printed, now, se, value}].
export function compareTables(name, printed, table) {
  const lines = printed.split('\n').filter((line) => line.startsWith('|'));
  const now = printTable(table);
  if (printed === now) return [];
  const fresh = now.split('\n').filter(Boolean);
  if (lines.length !== fresh.length || lines.some((line, i) => cellsOf(line).length !== cellsOf(fresh[i]).length)) {
    return [{ figure: name, printed: `${lines.length} lines`, now: `${fresh.length} lines, or other columns` }];
  }
  const differences = [];
  lines.forEach((line, i) => {
    const old = cellsOf(line);
    cellsOf(fresh[i]).forEach((text, k) => {
      if (i === 1 || old[k] === text) return;
      const cell = i > 1 ? table.rows[i - 2][k] : {};
      const place = i > 1 ? `${name}, ${old[0]}, ${table.columns[k]}` : `${name}, header`;
      differences.push({ figure: place, printed: old[k], now: text, value: cell.value, se: cell.se });
    });
  });
  return differences.length ? differences : [{ figure: name, printed: 'other spacing', now: 'as generated' }];
}

const numberIn = (text) => {
  const match = /-?\d[\d ]*(?:\.\d+)?/.exec(text.replace(/(\d) (?=\d{3}\b)/g, '$1'));
  return match ? Number(match[0]) : NaN;
};

// Whether a difference is more than the figure's Monte-Carlo error explains, and a line that says so.
// What has no such error is exact, or follows from figures that have one.
export function describe({ figure, printed, now, se }) {
  const errors = Math.abs(numberIn(printed) - numberIn(now)) / se;
  const line = `${figure}: the page has ${printed}, now ${now}`;
  if (!(se > 0) || !Number.isFinite(errors)) return { beyond: true, line: `${line} (no Monte-Carlo error)` };
  const beyond = errors > 2;
  return { beyond, line: `${line} (${errors.toFixed(1)} Monte-Carlo standard errors, ${beyond ? 'beyond' : 'within'} chance)` };
}
