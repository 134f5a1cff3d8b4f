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
