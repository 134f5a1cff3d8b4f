// The drawing of one team's beliefs: redraws on a change of team or width, updates on a change of
// period or rotation.
import { changeset } from 'vega';
import { type Drawing, draw } from '../chart';
import type { Beliefs, BeliefTeam } from '../document';
import { middle, toLonLat } from '../../shared/sphere';
import { Particles } from './particles';
import { type Turn, beliefRows, particleRows, sphereSpec } from './sphere_spec';
import type { Spec } from '../chart';

const kDegreesPerPixel = 0.5;

// Halfway from the prior's middle to the true reward: the prior faces the viewer, and the region that
// matters does not lie at the edge. The larger the zoom, the nearer to the true reward, or it would leave
// the window.
export function turnFor(beliefs: Beliefs, zoom: number): Turn {
  const prior = beliefs.regions.find(({ label }) => label.toLowerCase().startsWith('prior')) ?? beliefs.regions[0];
  const [x, y, z] = prior ? middle(prior.outline) : beliefs.truth;
  const [a, b, c] = beliefs.truth;
  const far = Math.max(0, 2 - zoom);
  const [lambda, phi] = toLonLat([far * x + a, far * y + b, far * z + c]);
  return { lambda: Math.round(lambda), phi: Math.round(phi), zoom };
}

export class GlobeView {
  private particles: Particles;
  private drawing: Drawing | null = null;
  private width = 0;
  private queue: Promise<void> = Promise.resolve();
  frame: number; // the last one, until somebody chooses another
  turn: Turn;

  constructor(
    private readonly box: HTMLElement,
    private readonly beliefs: Beliefs,
    public team: BeliefTeam,
  ) {
    this.particles = new Particles(team);
    this.frame = team.mass.length - 1;
    this.turn = turnFor(beliefs, 1);
  }

  spec(width: number): Spec {
    return sphereSpec(this.beliefs, this.team, this.particles, this.frame, this.turn, width);
  }

  // Changes follow each other: an update must not reach a view that is being replaced.
  private then(step: () => Promise<unknown>): void {
    this.queue = this.queue.then(async () => void (await step())).catch((error: unknown) => console.error(error));
  }

  redraw(width: number): void {
    if (width === 0) return;
    this.then(async () => {
      this.width = width;
      this.drawing?.finish();
      this.drawing = await draw(this.box, this.spec(width));
      this.box.dataset.drawn = String(width);
    });
  }

  show(team: BeliefTeam): void {
    this.team = team;
    this.particles = new Particles(team);
    this.frame = team.mass.length - 1;
    this.redraw(this.width);
  }

  setFrame(frame: number): void {
    this.frame = frame;
    this.then(async () => {
      const everything = (): boolean => true;
      await this.drawing?.view
        .change(
          'particles',
          changeset()
            .remove(everything)
            .insert(particleRows(this.particles, this.team, this.frame)),
        )
        .change('beliefs', changeset().remove(everything).insert(beliefRows(this.beliefs, this.team, this.particles, this.frame)))
        .runAsync();
    });
  }

  setTurn(turn: Turn): void {
    this.turn = turn;
    this.then(async () =>
      this.drawing?.view
        .signal('lambda', this.turn.lambda)
        .signal('phi', this.turn.phi)
        .signal('zoom', this.turn.zoom)
        .runAsync(),
    );
  }

  // Dragging turns the globes; `onTurn` lets the sliders follow.
  listenToDrags(onTurn: (turn: Turn) => void): void {
    let from: { x: number; y: number; turn: Turn } | null = null;
    this.box.addEventListener('pointerdown', (event) => {
      from = { x: event.clientX, y: event.clientY, turn: this.turn };
      this.box.setPointerCapture(event.pointerId);
    });
    this.box.addEventListener('pointermove', (event) => {
      if (!from) return;
      const lambda = from.turn.lambda - ((event.clientX - from.x) * kDegreesPerPixel) / from.turn.zoom;
      const phi = from.turn.phi + ((event.clientY - from.y) * kDegreesPerPixel) / from.turn.zoom;
      const turn = {
        lambda: ((((lambda + 180) % 360) + 360) % 360) - 180,
        phi: Math.max(-90, Math.min(90, phi)),
        zoom: from.turn.zoom,
      };
      this.setTurn(turn);
      onTurn(turn);
    });
    for (const end of ['pointerup', 'pointercancel'] as const) this.box.addEventListener(end, () => (from = null));
  }
}
