// One colour, one shape and one dash per strategy, the same in every figure.
import { color } from '../shared/theme';
import type { Report } from './document';
import { baseOf, type Words } from './words';

const kShapes = ['square', 'circle', 'triangle-up', 'diamond', 'triangle-down', 'cross', 'triangle-right', 'triangle-left'];
const kDashes = [
  [1, 0],
  [1, 0],
  [6, 2],
  [2, 2],
  [8, 2, 2, 2],
  [4, 4],
  [10, 3],
  [3, 1],
];
const kKnown = ['baseline', 'individual-low', 'individual-high', 'common', 'joint'];

export interface Look {
  label: string;
  color: string;
  shape: string;
  dash: number[];
}

export class Palette {
  private readonly looks = new Map<string, Look>();

  // Known strategies keep their colours whichever of them a study has; others take what is left.
  constructor(report: Report, words: Words) {
    const all = [...Object.keys(report.labels?.strategies ?? {}), ...report.overview.strategies];
    const codes = [...new Set([...all.map(baseOf), ...all])];
    const taken = new Set(codes.map((code) => kKnown.indexOf(code)).filter((place) => place >= 0));
    let next = 0;
    for (const code of codes) {
      let place = kKnown.indexOf(code);
      if (place < 0) {
        while (taken.has(next)) ++next;
        place = next;
        taken.add(place);
      }
      const at = place % kShapes.length;
      this.looks.set(code, {
        label: words.strategy(code),
        color: color(`t${at}`),
        shape: kShapes[at] ?? 'circle',
        dash: kDashes[at] ?? [1, 0],
      });
    }
  }

  // In the study's order, those among `codes`.
  looksOf(codes: Iterable<string>): Look[] {
    const wanted = new Set(codes);
    return [...this.looks].filter(([code]) => wanted.has(code)).map(([, look]) => look);
  }
}
