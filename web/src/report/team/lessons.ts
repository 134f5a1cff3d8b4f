// The lessons of single teams, as the document has them (docs/json.md).
import type { Board, MapDomain } from '../../shared/board/types';
import { plural } from '../words';

// [period, component, member or 0 for all, shown boards, conveyed sentences, [[board, "10-"]], knowledge in hundredths]
export type PeriodRow = [number, number, number, number[], number[], [number, string][], (number | null)[]];

export interface TeamRow {
  team: number;
  strategy: string;
  composition: string;
  replicate: number;
  periods: PeriodRow[];
}

export interface Lessons {
  domain: MapDomain & { features?: { name: string; weight: number }[] };
  features: string[];
  boards: (Board & { text: string })[];
  sentences: { normal: number[]; text: string }[];
  teams: TeamRow[];
}

// How much of the unit a feature counts as: the ends that were shown; null where there is none yet.
export interface Bracket {
  feature: string;
  unit: string;
  isCost: boolean; // of amounts at the true weights
  ends: { low: number | null; high: number | null }[]; // after every period
}

// The trade-offs between a feature and the last one, as the sentences of the periods narrow them down.
export function bracketsOf(lessons: Lessons, periods: PeriodRow[]): Bracket[] {
  const weights = (lessons.domain.features ?? []).map(({ weight }) => weight);
  const unit = lessons.features.length - 1;
  const sign = Math.sign(weights[unit] ?? -1) || -1;
  return lessons.features.slice(0, unit).flatMap((feature, k): Bracket[] => {
    const isCost = (weights[k] ?? -1) < 0;
    let [low, high]: [number | null, number | null] = [null, null];
    const ends = periods.map(([, , , , says]) => {
      for (const i of says) {
        const { normal = [] } = lessons.sentences[i] ?? {};
        const [own, other] = [normal[k] ?? 0, normal[unit] ?? 0];
        if (own === 0 || normal.some((entry, j) => entry !== 0 && j !== k && j !== unit)) continue;
        // own c + sign other >= 0 for c, the weight in units; amounts are told without their sign.
        const end = Number(((isCost ? -1 : 1) * ((-sign * other) / own)).toFixed(2));
        const isLow = own > 0 !== isCost;
        if (isLow) low = Math.max(low ?? -Infinity, end);
        else high = Math.min(high ?? Infinity, end);
      }
      return { low, high };
    });
    return ends.some((end) => end.low !== null || end.high !== null)
      ? [{ feature, unit: lessons.features[unit] ?? '', isCost, ends }]
      : [];
  });
}

export function amountText({ low, high }: Bracket['ends'][number], unit: string): string {
  if (low === null && high === null) return 'not shown yet';
  if (low === null) return `at most ${plural(high ?? 0, unit)}`;
  if (high === null) return low <= 0 ? 'something' : `more than ${plural(low, unit)}`;
  return `${Math.max(0, low)} to ${plural(high, unit)}`;
}
