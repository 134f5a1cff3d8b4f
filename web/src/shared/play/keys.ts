import type { Action } from './world';

// Whether a key is not for the board: it belongs to a field that somebody is filling in, or the session is paused.
export function isElsewhere(event: KeyboardEvent): boolean {
  const target = event.target;
  if (document.querySelector('main[inert]')) return true;
  return target instanceof HTMLElement && target.matches('input, textarea, select, summary, [contenteditable]');
}

// Whether a key presses the button or link that has the focus.
export function isPressing(event: KeyboardEvent): boolean {
  const target = event.target;
  return (event.key === 'Enter' || event.key === ' ') && target instanceof HTMLElement && target.matches('button, a, summary');
}

const kArrows: Record<string, [number, number]> = { ArrowUp: [0, -1], ArrowDown: [0, 1], ArrowLeft: [-1, 0], ArrowRight: [1, 0] };

export const isArrow = (key: string): boolean => key in kArrows;

// The action that goes where an arrow key points, if there is one.
export const actionOfArrow = (actions: Action[], key: string): number | undefined =>
  actions.find(({ shift }) => shift && String(shift) === String(kArrows[key]))?.index;

// Enter goes on, wherever the focus is: it presses the one primary button below a board.
export function enterGoesOn(): () => void {
  const pressed = (event: KeyboardEvent): void => {
    if (event.key !== 'Enter' || event.repeat || event.defaultPrevented || isElsewhere(event) || isPressing(event)) return;
    const next = document.querySelector<HTMLElement>('main :is(.submit, .player) .primary:not([aria-disabled])');
    if (!next) return;
    event.preventDefault();
    next.click();
  };
  document.addEventListener('keydown', pressed);
  return () => document.removeEventListener('keydown', pressed);
}
