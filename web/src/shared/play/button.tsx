import type { ComponentChildren, JSX } from 'preact';

interface ButtonProps {
  onClick: () => void;
  children: ComponentChildren;
  primary?: boolean;
  pressed?: boolean; // of a button that switches something on and off
  off?: boolean; // cannot be used now; still reachable by keyboard, so that the focus is not lost
  describedBy?: string | undefined;
  class?: string;
}

export function Button({ onClick, children, primary, pressed, off, describedBy, class: name }: ButtonProps): JSX.Element {
  return (
    <button
      type="button"
      class={`${primary ? 'primary' : 'plain'} ${name ?? ''}`}
      aria-pressed={pressed}
      aria-disabled={off ? 'true' : undefined}
      aria-describedby={describedBy}
      onClick={() => {
        if (!off) onClick();
      }}
    >
      {children}
    </button>
  );
}
