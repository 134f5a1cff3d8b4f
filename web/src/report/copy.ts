// A button that copies a text. The old way of copying serves browsers that do not count file:// as secure.
import { announce, button } from '../shared/dom';

function copyByCommand(text: string): boolean {
  const area = document.createElement('textarea');
  area.value = text;
  area.setAttribute('aria-hidden', 'true');
  document.body.append(area);
  area.select();
  const done = document.execCommand('copy');
  area.remove();
  return done;
}

async function copyText(text: string): Promise<boolean> {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    return copyByCommand(text);
  }
}

export function copyButton(what: string, text: string): HTMLButtonElement {
  const label = `Copy ${what}`;
  const element = button(
    label,
    () => {
      void copyText(text).then((done) => {
        element.textContent = done ? 'Copied' : 'Copying failed';
        announce(done ? `Copied ${what}` : `Copying ${what} failed`);
        setTimeout(() => (element.textContent = label), 1600);
      });
    },
    { class: 'copy' },
  );
  return element;
}
