// Explanations on hover and focus: anything with data-tip has one. There is one box for all of them in a document or
// shadow tree, which stays inside the window; Escape hides it.
import type { ComponentChildren, JSX } from 'preact';
import { useLayoutEffect, useRef, useState } from 'preact/hooks';
import { kTerms, type Term } from './words';

const kId = 'tip';
const kGap = 8; // px between what is explained and the box, and to the window's edge

export function Explained({ term, children }: { term: Term; children: ComponentChildren }): JSX.Element {
  return (
    <span class="term" tabIndex={0} data-tip={kTerms[term]}>
      {children}
    </span>
  );
}

export function Tips(): JSX.Element {
  const [on, setOn] = useState<Element | null>(null);
  const box = useRef<HTMLDivElement>(null);
  useLayoutEffect(() => {
    const tree = box.current?.getRootNode() ?? document;
    const find = (event: Event): Element | null =>
      event.target instanceof Element ? event.target.closest('[data-tip]') : null;
    const show = (event: Event): void => setOn(find(event));
    const hide = (): void => setOn(null);
    const key = (event: Event): void => {
      if ((event as KeyboardEvent).key === 'Escape') hide();
    };
    tree.addEventListener('pointerover', show);
    tree.addEventListener('focusin', show);
    tree.addEventListener('focusout', hide);
    tree.addEventListener('scroll', hide, true);
    tree.addEventListener('keydown', key);
    return () => {
      tree.removeEventListener('pointerover', show);
      tree.removeEventListener('focusin', show);
      tree.removeEventListener('focusout', hide);
      tree.removeEventListener('scroll', hide, true);
      tree.removeEventListener('keydown', key);
    };
  }, []);
  useLayoutEffect(() => {
    if (!on || !box.current) return;
    on.setAttribute('aria-describedby', kId);
    place(box.current, on.getBoundingClientRect());
    return () => on.removeAttribute('aria-describedby');
  });
  return (
    <div id={kId} role="tooltip" class="tip" ref={box} hidden={!on}>
      {on?.getAttribute('data-tip')}
    </div>
  );
}

function place(box: HTMLElement, at: DOMRect): void {
  const { width, height } = box.getBoundingClientRect();
  const left = Math.max(kGap, Math.min(at.left + at.width / 2 - width / 2, window.innerWidth - width - kGap));
  const below = at.bottom + kGap;
  const top = below + height < window.innerHeight ? below : Math.max(kGap, at.top - height - kGap);
  box.style.left = `${left}px`;
  box.style.top = `${top}px`;
}
