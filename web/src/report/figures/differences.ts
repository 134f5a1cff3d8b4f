// How much strategies and compositions differ: the one figure of the first screen.
import type { Spec } from '../chart';
import type { Cell, Differences, Row, Table } from '../document';
import type { Look } from '../palette';
import type { Study } from '../study';
import { baseOf, formatFixed, listOf } from '../words';
import { dots } from './dots';
import type { Figure } from './figure';
import { counted } from './gist';

const kWide = 620; // px; from here names say what a strategy does
const kLineLength = 36; // letters of a name beside the panels
const kColumns = ['factor', 'level', 'against', 'outcome', 'difference', 'low', 'high', 'n'];

type Group = Differences['groups'][number];

function tableOf({ factor, against, rows: levels }: Group, outcomes: Differences['outcomes']): Table {
  const rows = levels.flatMap(({ code, differences: list }) =>
    list.map(({ estimate, low, high, n }, k): Cell[] => {
      return [factor, code, against, outcomes[k]?.name ?? '', estimate, low, high, n];
    }),
  );
  return { columns: kColumns, rows };
}

// A name on an axis: what the code means above the code, where there is room for it.
function label(study: Study, factor: string, code: string, width: number): string {
  const [name, meaning] =
    factor === 'strategy'
      ? [study.words.strategy(code), study.factors.length > 0 ? '' : study.words.plainStrategy(code)]
      : [code, study.words.plainComposition(code)];
  if (!meaning || width < kWide) return name;
  if (meaning.length <= kLineLength) return `${meaning}|(${name})`;
  const middle = meaning.lastIndexOf(' ', kLineLength); // a row has room for two lines
  const rest = `${meaning.slice(middle + 1)} (${name})`;
  return middle > 0 && rest.length <= kLineLength ? `${meaning.slice(0, middle)}|${rest}` : name;
}

function spec(study: Study, { factor, rows }: Group, outcomes: Differences['outcomes'], width: number): Spec {
  const names = rows.map(({ code }) => label(study, factor, code, width));
  const looks = rows.map(({ code }, i): Look => {
    const look = factor === 'strategy' ? study.palette.looksOf([baseOf(code)])[0] : undefined;
    const plain = { color: 'var(--text)', shape: 'circle', dash: [1, 0] };
    return { ...(look ?? plain), label: names[i] ?? code };
  });
  const isVaried = (k: number): boolean => rows.some(({ differences: list }) => list[k]?.estimate !== 0); // no constants
  const panels = outcomes.flatMap((_, k) => (isVaried(k) ? [k] : [])).map((k) => ({
    title: outcomes[k]?.name ?? '',
    means: rows.map(({ differences: list }, i): Row => {
      const one = list[k];
      return { label: names[i] ?? '', mean: one?.estimate ?? null, low: one?.low ?? null, high: one?.high ?? null };
    }),
  }));
  const left = width >= kWide ? 226 : 104;
  return dots(
    {
      looks,
      panels,
      mean: 'mean',
      low: 'low',
      high: 'high',
      xTitle: '\u2190 less \u00b7 more \u2192',
      zero: true,
      ownScales: true,
      left: study.factors.length > 0 ? undefined : left,
      rows: factor === 'strategy' ? undefined : 'Teams',
      strategyOf: (row) => String(row.label),
    },
    width,
  );
}

function reading(study: Study, { factor, against, rows }: Group, interval: string): string {
  const n = counted(rows.flatMap(({ differences }) => differences).map((one): Row => ({ n: one.n })), 'n', 'a row');
  const [name, meaning] =
    factor === 'strategy'
      ? [study.words.strategy(against).toLowerCase(), study.factors.length > 0 ? '' : study.words.plainStrategy(against)]
      : [against, study.words.plainComposition(against)];
  const setting = factor === 'strategy' && study.factors.length > 0 && !against.includes('[') ? ' at the same setting' : '';
  return `Right of the line is more than with ${name}${meaning ? ` (${meaning})` : ''}${setting}. Bars are 95\u00a0% intervals: ${interval}; every panel has a scale of its own. ${n} ${study.words.letters()}`;
}

// Strategies first; the first figure belongs to the first screen.
export function differencesFigures(study: Study): Figure[] {
  const { differences } = study.report.overview;
  if (!differences) return [];
  const { outcomes, groups, interval } = differences;
  const names = outcomes.map(({ name }) => name.toLowerCase());
  return groups.map((group) => {
    const gists = group.rows.map(({ code, differences: list }) => {
      const values = list.map(({ estimate }, k) => `${names[k] ?? ''} ${formatFixed(estimate, outcomes[k]?.digits ?? 2)}`);
      return `${code} minus ${group.against}: ${values.join(', ')}`;
    });
    const ofStrategies = study.factors.length > 0 ? 'settings' : 'strategies';
    const what = group.factor === 'strategy' ? ofStrategies : 'compositions of the team';
    return {
      id: `differences-${group.factor}`,
      title: `Differences between ${what}: ${listOf(names)}`,
      reading: reading(study, group, group.factor === 'strategy' ? interval : 'Welch\u2019s t intervals'),
      gist: `Differences. ${gists.join('; ')}.`,
      table: tableOf(group, outcomes),
      spec: (width) => spec(study, group, outcomes, width),
    };
  });
}
