// Drawings of what is on a cell. All are drawn around (0,0), the middle of the cell.
import type { JSX } from 'preact';
import { useLayoutEffect } from 'preact/hooks';
import { textures } from './drawing.json';
import { kUnit, type Point } from './geometry';
import { iconOf } from './icons';
import type { Legend } from './legend';
import type { Part, Surface } from './types';

const kHalf = kUnit / 2;

// Over another terrain only the marks of a texture are drawn.
export const fillOf = ({ tint, pattern }: Surface, isOver = false): string => `url(#surface-${tint}-${pattern}${isOver ? '-over' : ''})`;

// Textures of terrains, once per page, and a third pair of colours where those of paths are tiles'.
export function Patterns({ surfaces }: { surfaces: Surface[] }): JSX.Element {
  const isThird = surfaces.some(({ tint }) => tint === 'blue' || tint === 'orange');
  useLayoutEffect(() => {
    document.documentElement.classList.toggle('third-pair', isThird);
  }, [isThird]);
  const marksOf = (pattern: string): { d: string; isFilled: boolean } => {
    const texture = textures.find(({ name }) => name === pattern);
    const marks = (texture?.at ?? []).map(([x, y]) => `M${x} ${y}${texture?.path}`);
    return { d: marks.join('') + (texture?.corners ?? ''), isFilled: texture?.filled ?? false };
  };
  return (
    <svg class="patterns" width="0" height="0" aria-hidden="true" focusable="false">
      <defs>
        {surfaces.flatMap(({ tint, pattern }) =>
          [false, true].map((isOver) => {
            const { d, isFilled } = marksOf(pattern);
            return (
              <pattern id={`surface-${tint}-${pattern}${isOver ? '-over' : ''}`} width={10} height={10} patternUnits="userSpaceOnUse">
                {!isOver && <rect width={10} height={10} fill={`var(--tint-${tint})`} />}
                <path d={d} stroke={isFilled ? 'none' : `var(--mark-${tint})`} fill={isFilled ? `var(--mark-${tint})` : 'none'} />
              </pattern>
            );
          }),
        )}
      </defs>
    </svg>
  );
}

// A cell of ground: one texture, or two over each other where two kinds of ground meet.
export function Surfacing({ layers }: { layers: Surface[] }): JSX.Element {
  return (
    <g>
      {layers.map((surface, i) => (
        <rect x={-kHalf} y={-kHalf} width={kUnit} height={kUnit} fill={fillOf(surface, i > 0)} />
      ))}
    </g>
  );
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

// A picture of a thing or, if there is none, its letter.
function Sign({ name, letter, size = 13 }: { name: string; letter: string; size?: number }): JSX.Element {
  const icon = iconOf(name);
  if (!icon) return <Letter text={letter} size={size} />;
  return <path class={icon.fill ? 'icon-fill' : 'icon-line'} d={icon.fill ?? icon.line ?? ''} transform={`scale(${size / 16})`} />;
}

export function Station({ name, letter }: { name: string; letter: string }): JSX.Element {
  return (
    <g class="station">
      <rect x={-12} y={-12} width={24} height={24} rx={4} />
      <Sign name={name} letter={letter} size={17} />
    </g>
  );
}

export function Thing({ name, letter, small }: { name: string; letter: string; small?: boolean | undefined }): JSX.Element {
  return (
    <g class="thing" transform={small ? 'scale(.68)' : undefined}>
      <rect x={-11} y={-11} width={22} height={22} rx={5} />
      <Sign name={name} letter={letter} size={16} />
    </g>
  );
}

// Where a thing belongs: its empty outline, filled once the thing is there.
export function Destination({ name, letter, isFilled }: { name: string; letter: string; isFilled?: boolean }): JSX.Element {
  return (
    <g class={isFilled ? 'destination filled' : 'destination'}>
      <rect x={-15} y={-15} width={30} height={30} rx={6} />
      <g class="wanted">
        <Sign name={name} letter={letter} size={18} />
      </g>
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

// With something on its head there is no antenna.
export function Robot({ isLoaded }: { isLoaded?: boolean }): JSX.Element {
  return (
    <g class="robot">
      {!isLoaded && <path class="antenna" d="M0 -10V-15" />}
      {!isLoaded && <circle class="tip" cy={-15.5} r={2.4} />}
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
    const layers = legend.layers(name);
    return layers.length > 0 ? <Surfacing layers={layers} /> : null;
  }
  if (kind === 'station') return <Station name={name} letter={legend.letter(name)} />;
  if (kind === 'item') return <Thing name={name} letter={legend.letter(name)} />;
  if (kind === 'destination') {
    const thing = name.replace(/^destination of /, '');
    return <Destination name={thing} letter={legend.letter(thing)} />;
  }
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
