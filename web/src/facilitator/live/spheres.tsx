// Belief spheres: one per member, and the common and joint beliefs. All are turned together, by dragging,
// by the arrow keys or with the sliders.
import type { JSX } from 'preact';
import { useLayoutEffect, useMemo, useRef, useState } from 'preact/hooks';
import type { GeoPermissibleObjects } from 'd3-geo';
import type { Vector } from '../../shared/sphere';
import type { Belief, RoomDetail, Truth } from '../protocol';
import { Explained } from '../tip';
import { upperFirst } from '../words';
import { asVector, dotsPath, firstTurn, kGraticule, makeGlobe, outlineOf, regionOf, turned, unpack } from './globe';
import type { Globe, Turn } from './globe';
import { beliefKind, memberOf, shortName } from './beliefs';
import { useWidth } from './width';

const kRadius = 100; // in the drawing
const kKeyTurn = 10; // degrees
const kCaption = 19; // px below a sphere
const kLargest = 190; // px
const kSide = 0.55 * kRadius; // labels beyond it extend towards the middle

interface Layout {
  columns: number;
  size: number;
}

// As large as `count` spheres can be in a box.
export function layoutOf(count: number, width: number, height: number): Layout {
  let best: Layout = { columns: 1, size: 0 };
  for (let columns = 1; columns <= count; ++columns) {
    const rows = Math.ceil(count / columns);
    const size = Math.floor(Math.min(width / columns - 8, height / rows - kCaption - 4, kLargest));
    if (size > best.size) best = { columns, size };
  }
  return best;
}

interface SpheresProps {
  detail: RoomDetail;
  height: number; // px that the drawing may take
  nameOf: (belief: string) => string;
  marked: number | null; // member
  onMark: (member: number | null) => void;
}

export function Spheres({ detail, height, nameOf, marked, onMark }: SpheresProps): JSX.Element {
  const { truth, beliefs } = detail;
  const [setBox, width] = useWidth();
  const home = useMemo(() => firstTurn(truth?.weights ?? [0, 0, 1], truth?.prior ?? []), [JSON.stringify(truth)]);
  const [turn, setTurn] = useState<Turn>(home);
  useLayoutEffect(() => setTurn(home), [home]);
  const drag = useRef<{ x: number; y: number; turn: Turn } | null>(null);
  const { columns, size } = layoutOf(beliefs.length, width, height);
  const latest = detail.curves[detail.curves.length - 1]?.p_bec ?? {};

  if (!truth || truth.weights.length !== 3 || beliefs.length === 0) return <NoSpheres detail={detail} nameOf={nameOf} />;
  const shapes = { bec: regionOf(truth.bec), prior: outlineOf(truth.prior), truth: asVector(truth.weights) };
  const key = (event: KeyboardEvent): void => {
    const moves: Record<string, [number, number]> = {
      ArrowLeft: [-kKeyTurn, 0],
      ArrowRight: [kKeyTurn, 0],
      ArrowUp: [0, -kKeyTurn],
      ArrowDown: [0, kKeyTurn],
    };
    const move = moves[event.key];
    if (move) setTurn(turned(turn, move[0], move[1]));
    else if (event.key === 'Home') setTurn(home);
    else return;
    event.preventDefault();
  };
  const globe = makeGlobe(turn, kRadius);
  return (
    <div class="spheres">
      <SphereKey turn={turn} onTurn={setTurn} onReset={() => setTurn(home)} />
      <div
        class="globes"
        ref={setBox}
        style={{ gridTemplateColumns: `repeat(${columns}, minmax(0, 1fr))` }}
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
          const scale = 115 / Math.max(60, size); // degrees per pixel: the surface follows the pointer
          setTurn(turned(from.turn, (event.clientX - from.x) * scale, (event.clientY - from.y) * scale));
        }}
        onPointerUp={() => (drag.current = null)}
        onPointerCancel={() => (drag.current = null)}
      >
        {width > 0 &&
          beliefs.map((belief) => (
            <BeliefGlobe
              key={belief.name}
              belief={belief}
              name={nameOf(belief.name)}
              shapes={shapes}
              truth={truth}
              globe={globe}
              size={size}
              mass={latest[belief.name]}
              isMarked={marked !== null && memberOf(belief.name) === marked}
              onMark={onMark}
              labelled={size >= 120}
            />
          ))}
      </div>
    </div>
  );
}

function SphereKey({ turn, onTurn, onReset }: { turn: Turn; onTurn: (turn: Turn) => void; onReset: () => void }) {
  return (
    <div class="sphere-key">
      <h3>Beliefs</h3>
      <span class="key bec">
        <Explained term="bec">BEC region</Explained>
      </span>
      <span class="key truth">
        <Explained term="truth">true reward</Explained>
      </span>
      <span class="key prior">
        <Explained term="prior">prior</Explained>
      </span>
      <span class="turners">
        <label>
          Turn{' '}
          <input
            type="range"
            min={-180}
            max={180}
            value={Math.round(turn.lambda)}
            onInput={(event) => onTurn({ ...turn, lambda: event.currentTarget.valueAsNumber })}
          />
        </label>
        <label>
          Tilt{' '}
          <input
            type="range"
            min={-90}
            max={90}
            value={Math.round(turn.phi)}
            onInput={(event) => onTurn({ ...turn, phi: event.currentTarget.valueAsNumber })}
          />
        </label>
        <button type="button" class="small" onClick={onReset}>
          Reset view
        </button>
      </span>
    </div>
  );
}

interface BeliefGlobeProps {
  belief: Belief;
  name: string;
  shapes: { bec: GeoPermissibleObjects; prior: GeoPermissibleObjects; truth: Vector };
  truth: Truth;
  globe: Globe;
  size: number;
  mass: number | undefined;
  isMarked: boolean;
  labelled: boolean;
  onMark: (member: number | null) => void;
}

function BeliefGlobe({ belief, name, shapes, truth, globe, size, mass, isMarked, labelled, onMark }: BeliefGlobeProps): JSX.Element {
  const points = useMemo(() => unpack(belief.points), [belief.points]);
  const bec = globe.path(shapes.bec);
  const star = globe.place(shapes.truth);
  const kind = beliefKind(belief.name);
  const share = mass === undefined ? '' : mass.toFixed(2);
  const said = mass === undefined ? '' : `, ${Math.round(100 * mass)} % of it in the BEC region`;
  return (
    <figure
      class={`globe ${kind}${isMarked ? ' marked' : ''}`}
      onPointerEnter={() => onMark(memberOf(belief.name))}
      onPointerLeave={() => onMark(null)}
    >
      <svg width={size} height={size} viewBox="-104 -104 208 208" role="img" aria-label={`Belief: ${name}${said}`}>
        <circle class="ball" r={kRadius} />
        {labelled && <path class="graticule" d={globe.path(kGraticule)} />}
        <path class="dots behind" d={dotsPath(points, globe, false)} />
        <path class="bec-region" d={bec} />
        <path class="prior-line" d={globe.path(shapes.prior)} />
        <path class="dots" d={dotsPath(points, globe, true)} />
        <path class="bec-line" d={bec} />
        {labelled && <Axes features={truth.features ?? []} globe={globe} />}
        {star.z >= 0 && <path class="star" d={kStar} transform={`translate(${star.x} ${star.y})`} />}
      </svg>
      <figcaption>
        <span class="whose">{upperFirst(labelled ? name : shortName(name))}</span> <b>{share}</b>
      </figcaption>
    </figure>
  );
}

const kStar = Array.from({ length: 10 }, (_, i) => {
  const [angle, r] = [(i * Math.PI) / 5 - Math.PI / 2, i % 2 === 0 ? 12 : 5];
  return `${i === 0 ? 'M' : 'L'}${(r * Math.cos(angle)).toFixed(1)} ${(r * Math.sin(angle)).toFixed(1)}`;
}).join('') + 'Z';

// Where a feature's weight is all there is, positive or negative.
function Axes({ features, globe }: { features: string[]; globe: Globe }): JSX.Element {
  const ends = features.slice(0, 3).flatMap((name, i) =>
    [1, -1].map((sign) => {
      const v: Vector = [i === 0 ? sign : 0, i === 1 ? sign : 0, i === 2 ? sign : 0];
      return { label: `${name} ${sign > 0 ? '+' : '\u2212'}`, ...globe.place(v) };
    }),
  );
  return (
    <g class="axes">
      {ends
        .filter(({ z }) => z > 0.05 * kRadius)
        .map(({ label, x, y }) => (
          <g transform={`translate(${x.toFixed(1)} ${y.toFixed(1)})`}>
            <circle r={2} />
            <text y={-6} text-anchor={x > kSide ? 'end' : x < -kSide ? 'start' : 'middle'}>
              {label}
            </text>
          </g>
        ))}
    </g>
  );
}

// With another number of features there is no sphere to draw.
function NoSpheres({ detail, nameOf }: { detail: RoomDetail; nameOf: (belief: string) => string }): JSX.Element {
  const latest = Object.entries(detail.curves[detail.curves.length - 1]?.p_bec ?? {});
  const features = detail.truth?.weights.length ?? 0;
  return (
    <div class="spheres">
      <div class="sphere-key">
        <h3>Beliefs</h3>
      </div>
      <p class="hint">
        {features > 0 && features !== 3
          ? `Spheres can be drawn for three features; this domain has ${features}. The bars are the share of each belief in the BEC region.`
          : 'There are no beliefs to draw yet.'}
      </p>
      <ul class="bars">
        {latest.map(([name, share]) => (
          <li>
            <span>{upperFirst(nameOf(name))}</span>
            <meter min={0} max={1} value={share} aria-label={`p(BEC), ${nameOf(name)}`} />
            <b>{share.toFixed(2)}</b>
          </li>
        ))}
      </ul>
    </div>
  );
}
