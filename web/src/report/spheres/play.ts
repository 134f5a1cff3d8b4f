// A button that steps through the periods. Who asks for reduced motion gets no such button.
import { button } from '../../shared/dom';

const kStepMs = 900;

export function playButton(slider: HTMLInputElement, onStep: () => void): HTMLButtonElement | null {
  if (window.matchMedia('(prefers-reduced-motion: reduce)').matches) return null;
  let timer = 0;
  const stop = (): void => {
    clearInterval(timer);
    timer = 0;
    play.textContent = 'Play';
  };
  const step = (): void => {
    if (slider.valueAsNumber >= Number(slider.max)) return stop();
    slider.valueAsNumber += 1;
    onStep();
  };
  const play = button('Play', () => {
    if (timer) return stop();
    if (slider.valueAsNumber >= Number(slider.max)) {
      slider.valueAsNumber = 0;
      onStep();
    }
    play.textContent = 'Pause';
    timer = window.setInterval(step, kStepMs);
  });
  slider.addEventListener('pointerdown', stop);
  return play;
}
