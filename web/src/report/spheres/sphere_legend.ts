// The legend below the globes: regions, true reward, particles.
import type { Json } from '../chart';
import type { Beliefs } from '../document';
import { color } from '../../shared/theme';

export const kStar =
  'M0,-1L0.235,-0.324L0.951,-0.309L0.38,0.124L0.588,0.809L0,0.4L-0.588,0.809L-0.38,0.124L-0.951,-0.309L-0.235,-0.324Z';

interface Key {
  label: string;
  shape: string;
  fill: string;
  stroke: string;
  dash: number[];
}

export const kRegionDashes = [
  [1, 0],
  [4, 3],
  [1.5, 2.5],
  [7, 3],
];

export function keys(beliefs: Beliefs): Key[] {
  return [
    ...beliefs.regions.map(({ label }, i) => ({
      label,
      shape: i === 0 ? 'square' : 'stroke',
      fill: i === 0 ? color('bec') : 'transparent',
      stroke: i === 0 ? color('bec') : color('muted'),
      dash: kRegionDashes[i % 4] ?? [1, 0],
    })),
    { label: 'true reward', shape: kStar, fill: color('truth'), stroke: color('ground'), dash: [1, 0] },
    { label: 'particle', shape: 'circle', fill: color('muted'), stroke: 'transparent', dash: [1, 0] },
  ];
}

// Places of the legend's entries, broken into lines; widths are estimated, text is short.
export function placedKeys(list: Key[], width: number): { rows: Json[]; lines: number } {
  let x = 0;
  let line = 0;
  const rows = list.map((key) => {
    const size = 24 + key.label.length * 6.6;
    if (x > 0 && x + size > width) {
      x = 0;
      ++line;
    }
    const placed = { ...key, x, line };
    x += size + 10;
    return placed;
  });
  return { rows: rows as unknown as Json[], lines: line + 1 };
}
