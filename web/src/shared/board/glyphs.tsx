// Drawings of what is on a cell. All are drawn around (0,0), the middle of the cell.
import type { JSX } from 'preact';
import { kUnit, type Point } from './geometry';
import type { Legend } from './legend';
import type { Part, Surface } from './types';

const kHalf = kUnit / 2;

const idOf = ({ tint, pattern }: Surface): string => `surface-${tint}-${pattern}`;

// Textures of terrains, once per page.
export function Patterns({ surfaces }: { surfaces: Surface[] }): JSX.Element {
  const mark = (pattern: string): JSX.Element => {
    if (pattern === 'dots') {
      return (
        <g>
          <circle cx={3} cy={3} r={1.4} />
          <circle cx={8} cy={8} r={1.4} />
        </g>
      );
    }
    if (pattern === 'lines') return <path d="M-2 12 12 -2M-2 2 2 -2M8 12 12 8" />;
    if (pattern === 'cross') return <path d="M2 5h6M5 2v6" />;
    return <path d="M0 3q2.5 -3 5 0t5 0M0 8q2.5 -3 5 0t5 0" />;
  };
  return (
    <svg class="patterns" width="0" height="0" aria-hidden="true" focusable="false">
      <defs>
        {surfaces.map((surface) => {
          const { tint, pattern } = surface;
          const isFilled = pattern === 'dots';
          return (
            <pattern id={idOf(surface)} width={10} height={10} patternUnits="userSpaceOnUse">
              <rect width={10} height={10} fill={`var(--tint-${tint})`} />
              <g stroke={`var(--mark-${tint})`} fill={isFilled ? `var(--mark-${tint})` : 'none'} stroke-width={isFilled ? 0 : 1}>
                {mark(pattern)}
              </g>
            </pattern>
          );
        })}
      </defs>
    </svg>
  );
}

export function Surfacing({ surface }: { surface: Surface }): JSX.Element {
  return <rect x={-kHalf} y={-kHalf} width={kUnit} height={kUnit} fill={`url(#${idOf(surface)})`} />;
}

export function Wall(): JSX.Element {
  return <rect class="wall" x={-kHalf} y={-kHalf} width={kUnit} height={kUnit} />;
}

function Letter({ text, size = 13, y = 0 }: { text: string; size?: number; y?: number }): JSX.Element {
  return (
    <text class="letter" y={y} text-anchor="middle" dominant-baseline="central" font-size={text.length > 1 ? size - 3 : size}>
      {text}
    </text>
  );
}

export function Station({ letter }: { letter: string }): JSX.Element {
  return (
    <g class="station">
      <rect x={-12} y={-12} width={24} height={24} rx={4} />
      <Letter text={letter} />
    </g>
  );
}

export function Thing({ letter, small }: { letter: string; small?: boolean | undefined }): JSX.Element {
  return (
    <g class="thing" transform={small ? 'scale(.72)' : undefined}>
      <circle r={10.5} />
      <Letter text={letter} />
    </g>
  );
}

export function Destination({ letter }: { letter: string }): JSX.Element {
  return (
    <g class="destination">
      <circle r={14.5} />
      <circle r={10.5} />
      <Letter text={letter} size={12} />
    </g>
  );
}

export function Goal({ letter }: { letter: string }): JSX.Element {
  return (
    <g class="goal">
      <path class="pole" d="M-9 14V-14" />
      <path class="flag" d="M-9 -14H13L8 -6.5 13 1H-9Z" />
      <g transform="translate(-.5 -6.5)">
        <Letter text={letter} size={11} />
      </g>
    </g>
  );
}

export function Robot(): JSX.Element {
  return (
    <g class="robot">
      <path class="antenna" d="M0 -10V-15" />
      <circle class="tip" cy={-15.5} r={2.4} />
      <rect x={-11} y={-10} width={22} height={21} rx={6} />
      <circle class="eye" cx={-4.6} cy={-2} r={2.6} />
      <circle class="eye" cx={4.6} cy={-2} r={2.6} />
      <path class="mouth" d="M-4 5.5h8" />
    </g>
  );
}

export function PartGlyph({ part, legend }: { part: Part; legend: Legend }): JSX.Element | null {
  const { kind, name } = part;
  if (kind === 'wall') return <Wall />;
  if (kind === 'terrain') {
    const surface = legend.surface(name);
    return surface ? <Surfacing surface={surface} /> : null;
  }
  if (kind === 'station') return <Station letter={legend.letter(name)} />;
  if (kind === 'item') return <Thing letter={legend.letter(name)} />;
  if (kind === 'destination') return <Destination letter={legend.letter(name.replace(/^destination of /, ''))} />;
  if (kind === 'goal') return <Goal letter={legend.hasPlainName(name) ? '' : legend.letter(name)} />;
  return null;
}

export function At({ at, children, ...rest }: { at: Point; children: preact.ComponentChildren; class?: string }): JSX.Element {
  return (
    <g transform={`translate(${at.x} ${at.y})`} {...rest}>
      {children}
    </g>
  );
}
