// A large map on a narrow screen: a window that follows the robot and can be moved, and all of the map in small.
import type { ComponentChildren, JSX } from 'preact';
import { useLayoutEffect, useRef, useState } from 'preact/hooks';
import { useCalm } from '../playback';
import { centre, kMargin, kUnit, type Point } from './geometry';
import type { MapDomain, Place } from './types';

const kReadable = 28; // pixels: smaller cells are enlarged
const kEnlarged = 28; // pixels of an enlarged cell
const kScale = kEnlarged / kUnit;
const kDragged = 5; // pixels after which a press is a drag and no click
const kShifts: Record<string, [number, number]> = {
  ArrowUp: [0, -1],
  ArrowDown: [0, 1],
  ArrowLeft: [-1, 0],
  ArrowRight: [1, 0],
};

export interface WindowTexts {
  part: ComponentChildren; // that there is more to see, and how
  label: string; // of the window
  whole: string; // what the button does
  enlarge: string;
}

// The part of the map that is seen, in units of the drawing.
export interface Seen extends Point {
  width: number;
  height: number;
}

interface Props {
  domain: MapDomain;
  centred: Place[]; // the first one stays in the window, the second one as well if both fit
  beginsWhole: boolean;
  texts: WindowTexts;
  isHeightLimited: boolean; // the style limits the height of the board also if all of it is shown
  hasArrows: boolean; // the arrow keys do something else here, and move the window only together with Shift
  overview: (seen: Seen) => JSX.Element;
  children: ComponentChildren;
}

export function BoardWindow(props: Props): JSX.Element {
  const { domain, centred, texts, isHeightLimited, hasArrows, overview, children } = props;
  const pan = useRef<HTMLDivElement>(null);
  const isSmall = useSmallCells(pan, domain, isHeightLimited);
  const [wantsWhole, setWantsWhole] = useState(props.beginsWhole);
  const isEnlarged = isSmall && !wantsWhole;
  const [seen, setSeen] = useState<Seen | null>(null);
  useFollowing(pan, centred, isEnlarged);
  useShiftKeys(pan, isEnlarged && hasArrows);
  const dragging = useDragging(pan, isEnlarged);
  const look = (): void => {
    const box = pan.current;
    if (box) setSeen(seenIn(box));
  };
  useLayoutEffect(look, [isEnlarged, String(centred)]);
  const move = (to: Point): void => {
    if (pan.current) centreOn(pan.current, to, 'auto');
  };
  const width = (domain.width ?? 0) * kUnit + 2 * kMargin;
  const size = { '--enlarged': `${width * kScale}px` };
  const focusable = isEnlarged ? { tabIndex: 0, role: 'group' as const, 'aria-label': texts.label } : {};
  return (
    <>
      <div class={isEnlarged ? 'pan enlarged' : 'pan'} ref={pan} style={size} onScroll={look} {...focusable} {...dragging}>
        {children}
      </div>
      {isSmall && (
        <div class="pan-bar">
          {isEnlarged && seen && <Overview onMove={move}>{overview(seen)}</Overview>}
          <div>
            {isEnlarged && <p>{texts.part}</p>}
            <button type="button" onClick={() => setWantsWhole(!wantsWhole)}>
              {wantsWhole ? texts.enlarge : texts.whole}
            </button>
          </div>
        </div>
      )}
    </>
  );
}

// Whether the cells are too small to see what is on them if all of the map is shown.
function useSmallCells(pan: { current: HTMLElement | null }, { width = 1, height = 1 }: MapDomain, isHeightLimited: boolean): boolean {
  const [isSmall, setSmall] = useState(false);
  useLayoutEffect(() => {
    const box = pan.current;
    if (!box) return;
    const measure = (): void => {
      const limit = isHeightLimited ? parseFloat(getComputedStyle(box).maxHeight) : NaN;
      setSmall(Math.min(box.clientWidth / width, Number.isNaN(limit) ? Infinity : limit / height) < kReadable);
    };
    measure();
    const observer = new ResizeObserver(measure);
    observer.observe(box);
    return () => observer.disconnect();
  }, [width, height, isHeightLimited]);
  return isSmall;
}

const seenIn = (box: HTMLElement): Seen => ({
  x: box.scrollLeft / kScale - kMargin,
  y: box.scrollTop / kScale - kMargin,
  width: box.clientWidth / kScale,
  height: box.clientHeight / kScale,
});

function centreOn(box: HTMLElement, { x, y }: Point, behavior: ScrollBehavior): void {
  box.scrollTo({
    left: (x + kMargin) * kScale - box.clientWidth / 2,
    top: (y + kMargin) * kScale - box.clientHeight / 2,
    behavior,
  });
}

const kRoom = 6 * kUnit; // beside two places, for what is written there

function aimOf(box: HTMLElement, first: Place, second: Place): Point {
  const [a, b] = [centre(first), centre(second)];
  const { width, height } = seenIn(box);
  const isNear = Math.abs(a.x - b.x) < width - kRoom && Math.abs(a.y - b.y) < height - kRoom / 2;
  return isNear ? { x: (a.x + b.x) / 2, y: (a.y + b.y) / 2 } : a;
}

// Keeps what it follows in the middle half of the window: first and after a change of its size at once, then smoothly.
function useFollowing(pan: { current: HTMLElement | null }, places: Place[], isEnlarged: boolean): void {
  const calm = useCalm();
  const wasEnlarged = useRef(false);
  const current = useRef(places);
  current.current = places;
  const follow = (behavior: ScrollBehavior, always = false): void => {
    const [first, second = first] = current.current;
    if (pan.current && first && second) keepInside(pan.current, aimOf(pan.current, first, second), behavior, always);
  };
  useLayoutEffect(() => {
    const isFirst = !wasEnlarged.current;
    wasEnlarged.current = isEnlarged;
    if (isEnlarged) follow(calm || isFirst ? 'auto' : 'smooth', isFirst);
  }, [String(places), isEnlarged]);
  useLayoutEffect(() => {
    if (!pan.current || !isEnlarged) return;
    const observer = new ResizeObserver(() => follow('auto'));
    observer.observe(pan.current);
    return () => observer.disconnect();
  }, [isEnlarged]);
}

function keepInside(box: HTMLElement, at: Point, behavior: ScrollBehavior, always: boolean): void {
  const { x, y, width, height } = seenIn(box);
  const isInside = Math.abs(at.x - x - width / 2) < width / 4 && Math.abs(at.y - y - height / 2) < height / 4;
  if (always || !isInside) centreOn(box, at, behavior);
}

// Before anything else gets the keys.
function useShiftKeys(pan: { current: HTMLElement | null }, isOn: boolean): void {
  useLayoutEffect(() => {
    if (!isOn) return;
    const pressed = (event: KeyboardEvent): void => {
      const shift = kShifts[event.key];
      const isAlone = document.querySelectorAll('.pan.enlarged').length === 1; // else the one that has the focus
      if (!isAlone && !pan.current?.contains(event.target as Node)) return;
      if (!shift || !event.shiftKey || (event.target instanceof HTMLElement && event.target.matches('input, textarea, select'))) return;
      event.preventDefault();
      event.stopImmediatePropagation();
      pan.current?.scrollBy({ left: 3 * kEnlarged * shift[0], top: 3 * kEnlarged * shift[1], behavior: 'auto' });
    };
    window.addEventListener('keydown', pressed, { capture: true });
    return () => window.removeEventListener('keydown', pressed, { capture: true });
  }, [isOn]);
}

type PointerHandler = (event: JSX.TargetedPointerEvent<HTMLElement>) => void;

// With the mouse; fingers scroll by themselves. A drag is no click on what is under it.
function useDragging(pan: { current: HTMLElement | null }, isOn: boolean): JSX.HTMLAttributes<HTMLDivElement> {
  const from = useRef<{ x: number; y: number; left: number; top: number } | null>(null);
  const wasDragged = useRef(false);
  if (!isOn) return {};
  const begin: PointerHandler = ({ pointerType, button, clientX: x, clientY: y }) => {
    wasDragged.current = false;
    const box = pan.current;
    if (box && pointerType === 'mouse' && button === 0) from.current = { x, y, left: box.scrollLeft, top: box.scrollTop };
  };
  const go: PointerHandler = (event) => {
    const box = pan.current;
    if (!from.current || !box) return;
    const [dx, dy] = [event.clientX - from.current.x, event.clientY - from.current.y];
    if (!wasDragged.current && Math.hypot(dx, dy) < kDragged) return;
    if (!wasDragged.current) box.setPointerCapture(event.pointerId);
    wasDragged.current = true;
    box.scrollTo({ left: from.current.left - dx, top: from.current.top - dy, behavior: 'auto' });
  };
  const end = (): void => void (from.current = null);
  return {
    onPointerDown: begin,
    onPointerMove: go,
    onPointerUp: end,
    onPointerCancel: end,
    onClickCapture: (event) => {
      if (wasDragged.current) event.stopPropagation();
      wasDragged.current = false;
    },
  };
}

// A press on the small map moves the window there. The window can also be moved without it, hence hidden.
function Overview({ onMove, children }: { onMove: (to: Point) => void; children: ComponentChildren }): JSX.Element {
  const move: PointerHandler = (event) => {
    if (event.buttons === 0) return;
    const svg = event.currentTarget.querySelector('svg');
    const matrix = svg?.getScreenCTM();
    if (!matrix) return;
    event.preventDefault();
    onMove(new DOMPoint(event.clientX, event.clientY).matrixTransform(matrix.inverse()));
  };
  return (
    <div
      class="overview"
      aria-hidden="true"
      onPointerDown={(event) => {
        event.currentTarget.setPointerCapture(event.pointerId);
        move(event);
      }}
      onPointerMove={move}
    >
      {children}
    </div>
  );
}
