// Building elements without markup in strings: all text of the document stays text.

type Attributes = Record<string, string | number | boolean | undefined>;
export type Child = Node | string | null | undefined | false;

export function el<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  attributes: Attributes = {},
  ...children: Child[]
): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === true) element.setAttribute(name, '');
    else if (value !== undefined && value !== false) element.setAttribute(name, String(value));
  }
  element.append(
    ...children.filter((child): child is Node | string => child !== null && child !== undefined && child !== false),
  );
  return element;
}

export function button(label: string, onClick: () => void, attributes: Attributes = {}): HTMLButtonElement {
  const element = el('button', { type: 'button', ...attributes }, label);
  element.addEventListener('click', onClick);
  return element;
}

// A closed box whose content is made when it is first opened: a table of thousands of rows costs
// nothing until somebody wants it.
export function lazyDetails(summary: string, make: () => Node): HTMLDetailsElement {
  const details = el('details', {}, el('summary', {}, summary));
  details.addEventListener('toggle', () => {
    if (details.open && details.childElementCount === 1) details.append(make());
  });
  return details;
}

let status: HTMLElement | null = null;

// Says something to screen readers without moving the focus.
export function announce(message: string): void {
  if (!status) {
    status = el('div', { role: 'status', class: 'visually-hidden' });
    document.body.append(status);
  }
  status.textContent = message;
}
