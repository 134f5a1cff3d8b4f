import type { JSX } from 'preact';

// A tick, a cross or a circle: shape as well as colour.
export function Mark({ verdict }: { verdict: 'right' | 'wrong' | 'none' }): JSX.Element {
  const paths: Record<string, string> = { right: 'M6 12.5l4 4 8-9', wrong: 'M7 7l10 10M17 7L7 17', none: 'M7 12h10' };
  return (
    <svg class="mark-icon" viewBox="0 0 24 24" aria-hidden="true" focusable="false">
      <circle cx={12} cy={12} r={11} />
      <path d={paths[verdict] ?? ''} />
    </svg>
  );
}
