// What boards are drawn from, as kith writes them.

// Column and row from the top left, from 1.
export type Place = [number, number];

export interface Part {
  kind: 'wall' | 'terrain' | 'station' | 'destination' | 'goal' | 'start' | 'item';
  name: string;
}

export interface LegendEntry extends Part {
  symbol: string;
  parts?: Part[]; // all that the symbol puts on a cell; `kind` and `name` are the first
}

export interface Item {
  name: string;
  cell: Place;
  carried: boolean;
}

// A state. On a map: where the robot and the things are. Without one: a name.
export interface Frame {
  robot?: Place;
  items?: Item[];
  stations?: Place[];
  state?: string;
  action?: string | null; // that follows; null in the last frame
}

export interface Board {
  world: number;
  map?: string[]; // absent where the domain has none
  world_name?: string; // where nothing is drawn, what the world is called
  start: Frame;
  frames: Frame[];
}

// What a board needs of a domain. Without a map, legend, width and height are absent.
export interface MapDomain {
  id: string;
  legend?: LegendEntry[];
  width?: number;
  height?: number;
}
