// Small pieces that all screens are made of.
import type { ComponentChildren, JSX } from 'preact';
import { useLayoutEffect, useRef, useState } from 'preact/hooks';
import { duration } from '../../shared/duration';
import { serverNow, useTick } from '../clock';
import { Button } from '../../shared/play/button';
import { t } from '../../shared/texts';
export { Button } from '../../shared/play/button';
import { setHeading } from './title';

// The heading of a screen. It gets the focus when the screen appears, so that a screen reader starts there.
export function Heading({ children, quiet }: { children: ComponentChildren; quiet?: boolean }): JSX.Element {
  const heading = useRef<HTMLHeadingElement>(null);
  useLayoutEffect(() => {
    setHeading(heading.current?.textContent ?? '');
    if (!quiet) heading.current?.focus({ preventScroll: true });
    window.scrollTo(0, 0);
  }, []);
  return (
    <h1 tabIndex={-1} ref={heading}>
      {children}
    </h1>
  );
}

// How long something has lasted, on the server's clock. Not read out by itself.
export function Since({ ms }: { ms: number }): JSX.Element {
  useTick();
  return <p class="muted time">{t('common.since', { time: duration(serverNow() - ms) })}</p>;
}

// The time that is left until a limit.
export function TimeLeft({ until }: { until: number | undefined }): JSX.Element | null {
  useTick();
  if (until === undefined) return null;
  const left = until - serverNow();
  return <p class={left < 30_000 ? 'time limit soon' : 'time limit'}>{t('common.time_left', { time: duration(left) })}</p>;
}

export function NextStep({ children }: { children: ComponentChildren }): JSX.Element {
  return (
    <div class="next-step">
      <h2>{t('common.next_step')}</h2>
      {children}
    </div>
  );
}

// Texts of a study: paragraphs, and what their authors mark as in Markdown, headings, items of lists and bold words.
export function Paragraphs({ texts }: { texts: string[] }): JSX.Element {
  const parts: JSX.Element[] = [];
  let items: string[] = [];
  const endList = (): void => {
    if (items.length > 0) parts.push(<ul>{items.map((item) => <li>{marked(item)}</li>)}</ul>);
    items = [];
  };
  for (const text of texts) {
    const heading = /^#{1,6}\s+(.*)$/s.exec(text)?.[1];
    const item = /^[*-]\s+(.*)$/s.exec(text)?.[1];
    if (item !== undefined) {
      items.push(item);
      continue;
    }
    endList();
    parts.push(heading === undefined ? <p>{marked(text)}</p> : <h2>{marked(heading)}</h2>);
  }
  endList();
  return <>{parts}</>;
}

const marked = (text: string): ComponentChildren => text.split(/\*\*(.+?)\*\*/s).map((part, i) => (i % 2 === 1 ? <strong>{part}</strong> : part));

// Where the clipboard may not be used (pages without TLS), the text is selected for the reader to copy.
async function copy(text: string, shown: HTMLElement | null): Promise<boolean> {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    const selection = window.getSelection();
    if (!shown || !selection) return false;
    selection.selectAllChildren(shown);
    return document.execCommand('copy');
  }
}

export function CompletionCode({ code }: { code: string }): JSX.Element {
  const [state, setState] = useState<'fresh' | 'copied' | 'failed'>('fresh');
  const shown = useRef<HTMLElement>(null);
  const copyIt = (): void => {
    copy(code, shown.current).then(
      (done) => setState(done ? 'copied' : 'failed'),
      () => setState('failed'),
    );
  };
  return (
    <div class="code-box">
      <h2 id="code-title">{t('common.code')}</h2>
      <p>
        <code class="code" ref={shown}>
          {code}
        </code>
      </p>
      <Button primary onClick={copyIt}>
        {t('common.copy')}
      </Button>
      <p role="status" class="copied">
        {state === 'copied' && `\u2713 ${t('common.copied')}`}
        {state === 'failed' && t('common.copy_failed')}
      </p>
    </div>
  );
}

// A link to elsewhere, once everything is saved. Only to pages: never to a script.
export function GoOn({ address, isSaved }: { address: string | undefined; isSaved: boolean }): JSX.Element {
  const isPage = address !== undefined && /^https?:\/\//i.test(address);
  if (!isPage) return <p class="muted">{t('common.close')}</p>;
  if (!isSaved) return <p role="status">{t('common.go_on_wait')}</p>;
  return (
    <p>
      <a class="button primary" href={address} rel="noreferrer noopener">
        {t('common.go_on')}
      </a>
    </p>
  );
}
