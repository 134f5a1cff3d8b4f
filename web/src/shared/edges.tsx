// What pages have at their edges: a switch between themes, and the licences of the software inside them.
import type { JSX } from 'preact';
import { useLayoutEffect, useRef } from 'preact/hooks';
import { themeToggle } from './theme';

// An element that other code makes.
function Adopted({ make }: { make: () => Node | undefined }): JSX.Element {
  const place = useRef<HTMLSpanElement>(null);
  useLayoutEffect(() => place.current?.replaceChildren(make() ?? ''), []);
  return <span ref={place} />;
}

export const ThemeToggle = (): JSX.Element => <Adopted make={themeToggle} />;

// The texts are put into the page when it is bundled.
export const Licences = ({ summary = 'Licences of the software inside this page' }: { summary?: string }): JSX.Element => (
  <details class="licences">
    <summary>{summary}</summary>
    <Adopted make={() => document.querySelector<HTMLTemplateElement>('#kith-notices')?.content.cloneNode(true)} />
  </details>
);
