// Unpacks the particles of a team: int16, little endian, in the order frame, belief, particle, xyz.
import type { BeliefTeam } from '../document';
import type { Vector } from '../../shared/sphere';

export class Particles {
  private readonly bytes: DataView;
  private readonly count: number;
  private readonly beliefs: number;
  readonly frames: number;

  constructor(team: BeliefTeam) {
    const { bits, count, data } = team.particles;
    if (bits !== 16) throw new Error(`particles of ${bits} bits are unknown to this page`);
    const text = atob(data);
    this.bytes = new DataView(Uint8Array.from(text, (letter) => letter.charCodeAt(0)).buffer);
    this.count = count;
    this.beliefs = team.beliefs.length;
    this.frames = Math.floor(this.bytes.byteLength / (this.beliefs * count * 6));
    if (this.frames < team.mass.length) throw new Error('the document has fewer particles than it says');
  }

  at(frame: number, belief: number): Vector[] {
    const first = (frame * this.beliefs + belief) * this.count * 6;
    const read = (place: number): number => this.bytes.getInt16(place, true) / 32767;
    return Array.from({ length: this.count }, (_, i) => {
      const place = first + 6 * i;
      return [read(place), read(place + 2), read(place + 4)];
    });
  }
}
