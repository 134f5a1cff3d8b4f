// Sliders that turn all globes and zoom into them, for the keyboard; they follow dragging.
import type { Beliefs } from '../document';
import { button, el } from '../../shared/dom';
import { slider } from './controls';
import { type GlobeView, turnFor } from './globe_view';
import type { Turn } from './sphere_spec';

export function turnControls(view: GlobeView, beliefs: Beliefs): HTMLElement {
  const turn = slider({
    id: 'sphere-turn',
    label: 'Turn',
    min: -180,
    max: 180,
    value: view.turn.lambda,
    say: (v) => `${v}\u00b0`,
    onInput: (lambda) => view.setTurn({ ...view.turn, lambda }),
  });
  const tilt = slider({
    id: 'sphere-tilt',
    label: 'Tilt',
    min: -90,
    max: 90,
    value: view.turn.phi,
    say: (v) => `${v}\u00b0`,
    onInput: (phi) => view.setTurn({ ...view.turn, phi }),
  });
  const zoom = slider({
    id: 'sphere-zoom',
    label: 'Zoom',
    min: 1,
    max: 6,
    step: 0.5,
    value: 1,
    say: (v) => `${v}\u00d7`,
    onInput: (value) => face(value),
  });
  const showTurn = ({ lambda, phi }: Turn): void => {
    turn.set(lambda);
    tilt.set(phi);
  };
  function face(value: number): void {
    view.setTurn(turnFor(beliefs, value));
    showTurn(view.turn);
  }
  const reset = button('Reset view', () => {
    zoom.set(1);
    face(1);
  });
  view.listenToDrags(showTurn);
  return el('div', { class: 'pair' }, turn.row, tilt.row, zoom.row, reset);
}
