// Inputs with their labels and a text of the present value.
import { el } from '../../shared/dom';

export interface Slider {
  row: HTMLElement;
  input: HTMLInputElement;
  set(value: number): void;
}

export interface SliderOptions {
  id: string;
  label: string;
  min: number;
  max: number;
  step?: number;
  value: number;
  say(value: number): string;
  onInput(value: number): void;
}

export function slider(options: SliderOptions): Slider {
  const { id, label, min, max, value, say, onInput } = options;
  const input = el('input', { type: 'range', id, min, max, step: options.step ?? 1, value });
  const output = el('output', { for: id });
  const tell = (): void => {
    output.textContent = say(input.valueAsNumber);
    input.setAttribute('aria-valuetext', say(input.valueAsNumber));
  };
  input.addEventListener('input', () => {
    tell();
    onInput(input.valueAsNumber);
  });
  tell();
  return {
    row: el('div', { class: 'control' }, el('label', { for: id }, label), input, output),
    input,
    set(next) {
      input.valueAsNumber = next; // the input rounds to its step
      tell();
    },
  };
}

export function select(id: string, label: string, names: string[], onChange: (index: number) => void): HTMLElement {
  const input = el('select', { id }, ...names.map((name, i) => el('option', { value: i }, name)));
  input.addEventListener('change', () => onChange(input.selectedIndex));
  return el('div', { class: 'control' }, el('label', { for: id }, label), input);
}
