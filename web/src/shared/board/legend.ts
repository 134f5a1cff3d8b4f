// What the symbols of maps mean, and how each kind of thing is drawn.
import type { LegendEntry, MapDomain, Part, Place, Surface } from './types';

const kBoth = ' and ';

export class Legend {
  private readonly entries = new Map<string, LegendEntry>();
  readonly surfaces: Surface[];
  private readonly letters = new Map<string, string>();

  constructor(domain: MapDomain) {
    for (const entry of domain.legend ?? []) this.entries.set(entry.symbol, entry);
    this.surfaces = domain.surfaces ?? [];
    const parts = (domain.legend ?? []).flatMap((entry) => entry.parts ?? [entry]);
    const things = parts.filter(({ kind }) => ['station', 'item', 'goal'].includes(kind)).map(({ name }) => name);
    for (const name of new Set(things)) this.letters.set(name, this.freeLetter(name));
  }

  // The shortest beginning of a name that no other thing has.
  private freeLetter(name: string): string {
    const taken = new Set(this.letters.values());
    for (let n = 1; n <= Math.min(2, name.length); ++n) {
      const letter = name.slice(0, n).charAt(0).toUpperCase() + name.slice(1, n);
      if (!taken.has(letter)) return letter;
    }
    return name.charAt(0).toUpperCase() + String(taken.size);
  }

  parts(symbol: string): Part[] {
    const entry = this.entries.get(symbol);
    return entry ? (entry.parts ?? [entry]) : [];
  }

  surface(name: string): Surface | undefined {
    return this.surfaces.find((surface) => surface.name === name);
  }

  // How the ground of a cell is drawn: "lane and wet" is both, one over the other.
  layers(name: string): Surface[] {
    const parts = this.isMixed(name) ? name.split(kBoth) : [name];
    return parts.flatMap((part) => this.surface(part) ?? []);
  }

  // Whether a terrain is nothing but two others on one cell.
  isMixed(name: string): boolean {
    const parts = name.split(kBoth);
    return parts.length > 1 && parts.every((part) => this.surface(part) !== undefined);
  }

  letter(name: string): string {
    return this.letters.get(name) ?? name.charAt(0).toUpperCase();
  }

  // What a thing that is somewhere on the map is: an item, or a destination that lies elsewhere in every board.
  placed(name: string): Part {
    return this.things().find((part) => part.kind === 'destination' && part.name === name) ?? { kind: 'item', name };
  }

  // A goal without a name of its own needs no letter.
  hasPlainName(name: string): boolean {
    return name === 'goal';
  }

  stationAt(map: string[], [column, row]: Place): string {
    const symbol = map[row - 1]?.charAt(column - 1) ?? '';
    return this.parts(symbol).find(({ kind }) => kind === 'station')?.name ?? 'station';
  }

  // Everything that can be on a map, once, in the order of the file; things that lie on one cell each by itself.
  things(): Part[] {
    const seen = new Map<string, Part>();
    for (const entry of this.entries.values()) {
      for (const part of entry.parts ?? [entry]) {
        if (part.kind === 'start') continue;
        const parts = part.kind === 'terrain' && this.isMixed(part.name) ? part.name.split(kBoth).map((name) => ({ ...part, name })) : [part];
        for (const one of parts) seen.set(`${one.kind} ${one.name}`, one);
      }
    }
    return [...seen.values()];
  }
}
