// Beliefs as spheres beside each other. All are turned together, by dragging, by the arrow keys or with the sliders.
// Blue is the robot's, orange are people. The drawing has its colours in attributes, so that it can be saved.
import type { JSX } from 'preact';
import { useLayoutEffect, useMemo, useRef, useState } from 'preact/hooks';
import { asVector, dotsPath, firstTurn, kGraticule, makeGlobe, outlineOf, regionOf, turned, type Turn } from './globe';
import type { Vector } from './sphere';
import { color } from './theme';
import { useWidth } from './width';

const kKeyTurn = 10; // degrees
const kKey = 20; // px, what the signs mean
const kName = 18; // px, the name below a globe
const kLine = 14; // px, a line below it
const kLargest = 210; // px
const kLabelled = 120; // px of a globe from which on it has names of features on it
const kText = 12; // px
const kLetter = 6.4; // px

export interface Space {
  features: string[];
  truth: number[];
  regions: { label: string; outline: number[][] }[]; // the first is the policy's, the last one the prior
}

export interface Ball {
  name: string; // whose belief it is
  kind: 'own' | 'common' | 'joint' | 'other';
  points: Vector[];
  share?: number | undefined; // of it in the policy's region
  thinks?: { at: Vector; lines: string[] } | undefined; // one point in words
}

export const boundOf = ({ regions }: Space): number[][] => regions.at(-1)?.outline ?? [];

interface Marks {
  marked?: string | null; // name of a ball
  onMark?: (name: string | null) => void;
}

interface DrawingProps extends Marks {
  space: Space;
  balls: Ball[];
  turn: Turn;
  width: number;
  height?: number; // px that the drawing may take
  hasKeys?: boolean;
}

// As large as `count` globes can be in a box.
function layoutOf(count: number, width: number, height: number, below: number): { columns: number; size: number } {
  let best = { columns: 1, size: 0 };
  for (let columns = 1; columns <= count; ++columns) {
    const size = Math.floor(Math.min(width / columns - 8, height / Math.ceil(count / columns) - below, kLargest));
    if (size > best.size) best = { columns, size };
  }
  return best;
}

const kKinds: Record<Ball['kind'], string> = { own: color('person'), common: color('text'), joint: color('muted'), other: color('muted') };

const kStar = Array.from({ length: 10 }, (_, i) => {
  const [angle, r] = [(i * Math.PI) / 5 - Math.PI / 2, i % 2 === 0 ? 1 : 0.42];
  return `${i === 0 ? 'M' : 'L'}${(r * Math.cos(angle)).toFixed(3)} ${(r * Math.sin(angle)).toFixed(3)}`;
}).join('') + 'Z';
const Star = ({ x, y, size }: { x: number; y: number; size: number }): JSX.Element => (
  <path class="star" d={kStar} transform={`translate(${x} ${y}) scale(${size})`} fill={color('text')} stroke={color('ground')} stroke-width={1.4 / size} />
);

export function GlobesDrawing({ space, balls, turn, width, height = Infinity, hasKeys, marked, onMark }: DrawingProps): JSX.Element {
  const below = kName + kLine * Math.max(0, ...balls.map(({ thinks }) => thinks?.lines.length ?? 0)) + 1;
  const keys = hasKeys ? keyPlaces(space, width) : [];
  const top = hasKeys ? kKey * ((keys.at(-1)?.line ?? 0) + 1) : 0;
  const few = Number.isFinite(height) ? height : Math.ceil(balls.length / Math.max(2, Math.floor(width / 150))) * (kLargest + below);
  const { columns, size } = layoutOf(balls.length, width, few, below);
  const cell = width / columns;
  const radius = size / 2 - 2;
  const rows = Math.ceil(balls.length / columns);
  const shapes = useMemo(
    () => space.regions.map(({ outline }, i) => ({ line: outlineOf(outline), region: i === 0 ? regionOf(outline) : null })),
    [space],
  );
  const globe = makeGlobe(turn, radius);
  const [high, said] = [top + rows * (size + below), balls.map(({ name, share }) => (share === undefined ? name : `${name} ${share.toFixed(2)}`))];
  return (
    <svg
      xmlns="http://www.w3.org/2000/svg"
      width={width}
      height={high}
      viewBox={`0 0 ${width} ${high}`}
      role="img"
      aria-label={`Belief spheres. Share of belief in the policy\u2019s region: ${said.join(', ')}.`}
      font-family='"Helvetica Neue", Helvetica, Arial, "Liberation Sans", sans-serif'
      font-size={`${kText}px`}
    >
      <clipPath id="globe">
        <circle r={radius} />
      </clipPath>
      {keys.map(({ name, x, line }, i) => (
        <g transform={`translate(${x} ${8 + kKey * line})`}>
          <Sign i={i} count={space.regions.length} />
          <text x={18} y={4} fill={color('muted')}>
            {name}
          </text>
        </g>
      ))}
      {balls.map((ball, i) => {
        const { name, kind, points, share, thinks } = ball;
        const star = globe.place(asVector(space.truth));
        const at = thinks && globe.place(thinks.at);
        const isMarked = marked === name;
        const short = size < kLabelled ? name.replace(/^.* (?=\S+$)/, '') : name;
        return (
          <g
            class={`globe ${kind}${isMarked ? ' marked' : ''}`}
            transform={`translate(${((i % columns) + 0.5) * cell} ${top + Math.floor(i / columns) * (size + below) + size / 2})`}
            onPointerEnter={() => onMark?.(name)}
            onPointerLeave={() => onMark?.(null)}
          >
            <circle class="ball" r={radius} fill={color('panel')} stroke={color(isMarked ? 'focus' : 'line')} stroke-width={isMarked ? 3 : 1.5} />
            <g clip-path={turn.zoom > 1 ? 'url(#globe)' : undefined} fill="none" stroke-linecap="round">
              {size >= kLabelled && <path d={globe.path(kGraticule)} stroke={color('grid')} />}
              <path class="dots behind" d={dotsPath(points, globe, false)} stroke={kKinds[kind]} stroke-width={0.045 * radius} stroke-opacity={0.12} />
              {shapes.map(({ line, region }, k) =>
                region ? (
                  <path class="bec-region" d={globe.path(region)} fill={color('robot')} fill-opacity={0.28} />
                ) : (
                  <path d={globe.path(line)} stroke={color('muted')} stroke-width={1.4} stroke-dasharray={kDashes[k % kDashes.length]} />
                ),
              )}
              <path class="dots" d={dotsPath(points, globe, true)} stroke={kKinds[kind]} stroke-width={0.045 * radius} stroke-opacity={0.45} />
              {shapes[0] && <path d={globe.path(shapes[0].line)} stroke={color('robot')} stroke-width={2} />}
              {at && at.z >= 0 && <circle class="typical" cx={at.x} cy={at.y} r={6} stroke={color('text')} stroke-width={1.6} />}
            </g>
            {size >= kLabelled && <Axes features={space.features} place={globe.place} radius={radius} />}
            {star.z >= 0 && Math.hypot(star.x, star.y) <= radius && <Star x={star.x} y={star.y} size={Math.max(6, 0.1 * radius)} />}
            <text class="whose" y={size / 2 + kLine} text-anchor="middle" fill={color(isMarked ? 'text' : 'muted')}>
              {short.charAt(0).toUpperCase() + short.slice(1)}{' '}
              <tspan font-weight={600} fill={color('text')}>
                {share?.toFixed(2)}
              </tspan>
            </text>
            {thinks?.lines.map((line, k) => (
              <text y={size / 2 + kLine * (k + 2)} text-anchor="middle" fill={color('muted')}>
                {line}
              </text>
            ))}
          </g>
        );
      })}
    </svg>
  );
}

const kDashes = ['', '4 3', '1.5 2.5', '7 3'];

const keyNames = ({ regions }: Space): string[] => [...regions.map(({ label }) => label), 'true reward'];

// The sign of the i-th name, around (7, 0).
function Sign({ i, count }: { i: number; count: number }): JSX.Element {
  if (i === count) return <Star x={7} y={0} size={7} />;
  if (i > 0) return <path d="M0 0h14" stroke={color('muted')} stroke-width={1.6} stroke-dasharray={kDashes[i % kDashes.length]} />;
  return <rect x={1} y={-6} width={12} height={12} rx={3} fill={color('robot')} fill-opacity={0.28} stroke={color('robot')} stroke-width={1.6} />;
}

// Names beside each other, in as many lines as they need.
function keyPlaces(space: Space, width: number): { name: string; x: number; line: number }[] {
  let [x, line] = [0, 0];
  return keyNames(space).map((name) => {
    const own = 26 + kLetter * name.length;
    if (x > 0 && x + own > width) [x, line] = [0, line + 1];
    x += own;
    return { name, x: x - own, line };
  });
}

// Where a feature's weight is all there is, positive or negative.
function Axes({ features, place, radius }: { features: string[]; place: (v: Vector) => { x: number; y: number; z: number }; radius: number }): JSX.Element {
  const ends = features.slice(0, 3).flatMap((name, i) =>
    [1, -1].map((sign) => {
      const v: Vector = [i === 0 ? sign : 0, i === 1 ? sign : 0, i === 2 ? sign : 0];
      return { label: `${name} ${sign > 0 ? '+' : '\u2212'}`, ...place(v) };
    }),
  );
  const side = 0.75 * radius; // labels beyond it extend towards the middle
  return (
    <g class="axes">
      {ends
        .filter(({ x, y, z }) => z > 0.05 * radius && Math.hypot(x, y) < radius)
        .map(({ label, x, y }) => (
          <g transform={`translate(${x.toFixed(1)} ${y.toFixed(1)})`} fill={color('muted')}>
            <circle r={2} />
            <text y={-6} text-anchor={x > side ? 'end' : x < -side ? 'start' : 'middle'} paint-order="stroke" stroke={color('panel')} stroke-width={3.5}>
              {label}
            </text>
          </g>
        ))}
    </g>
  );
}

interface GlobesProps extends Omit<DrawingProps, 'width'> {
  onTurn: (turn: Turn) => void;
}

export function Globes({ onTurn, ...drawing }: GlobesProps): JSX.Element {
  const { turn, space } = drawing;
  const [setBox, width] = useWidth();
  const drag = useRef<{ x: number; y: number; turn: Turn } | null>(null);
  const face = (zoom: number): void => onTurn(firstTurn(space.truth, boundOf(space), zoom));
  const key = (event: KeyboardEvent): void => {
    const moves: Record<string, [number, number]> = { ArrowLeft: [-kKeyTurn, 0], ArrowRight: [kKeyTurn, 0], ArrowUp: [0, -kKeyTurn], ArrowDown: [0, kKeyTurn] };
    const move = moves[event.key];
    if (move) onTurn(turned(turn, move[0], move[1]));
    else if (event.key === 'Home') face(1);
    else return;
    event.preventDefault();
  };
  const slider = (label: string, value: number, [min, max, step]: [number, number, number], change: (value: number) => void): JSX.Element => (
    <label>
      {label} <input type="range" min={min} max={max} step={step} value={Math.round(value / step) * step} onInput={(event) => change(event.currentTarget.valueAsNumber)} />
    </label>
  );
  return (
    <>
      <span class="keys">
        {keyNames(space).map((name, i) => (
          <span>
            <svg viewBox="-1 -8 16 16" width="16" height="16" aria-hidden="true">
              <Sign i={i} count={space.regions.length} />
            </svg>{' '}
            {name}
          </span>
        ))}
      </span>
      <span class="turners">
        {slider('Turn', turn.lambda, [-180, 180, 1], (lambda) => onTurn({ ...turn, lambda }))}
        {slider('Tilt', turn.phi, [-90, 90, 1], (phi) => onTurn({ ...turn, phi }))}
        {slider('Zoom', turn.zoom, [1, 6, 0.5], face)}
        <button type="button" onClick={() => face(1)}>
          Reset view
        </button>
      </span>
      <div
        class="globes"
        ref={setBox}
        role="group"
        aria-label="Belief spheres. Arrow keys turn them, Home resets the view."
        tabIndex={0}
        onKeyDown={key}
        onPointerDown={(event) => {
          drag.current = { x: event.clientX, y: event.clientY, turn };
          event.currentTarget.setPointerCapture(event.pointerId);
        }}
        onPointerMove={(event) => {
          const from = drag.current;
          if (!from) return;
          const scale = 0.7 / turn.zoom; // degrees per pixel: the surface follows the pointer
          onTurn(turned(from.turn, (event.clientX - from.x) * scale, (event.clientY - from.y) * scale));
        }}
        onPointerUp={() => (drag.current = null)}
        onPointerCancel={() => (drag.current = null)}
      >
        {width > 0 && <GlobesDrawing {...drawing} width={width} />}
      </div>
    </>
  );
}

// As the space is first seen; again when it is another one.
export function useTurn(space: Space): [Turn, (turn: Turn) => void] {
  const home = useMemo(() => firstTurn(space.truth, boundOf(space)), [JSON.stringify([space.truth, space.regions])]);
  const [turn, setTurn] = useState<Turn>(home);
  useLayoutEffect(() => setTurn(home), [home]);
  return [turn, setTurn];
}
