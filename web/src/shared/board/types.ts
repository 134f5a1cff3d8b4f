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
  counts?: number[] | null; // what that action counts of each of MapDomain.counted
}

// Where a robot goes. A path that never ends is a way in and a cycle, once: its last frame shows frame `repeats_from`
// again, and `repeats_text` is what that means, in English ("it never delivers the parcel").
export interface Path {
  frames: Frame[];
  repeats_from?: number;
  repeats_text?: string;
}

// Whose a path is: the robot's, the reader's, or somebody else's.
export type PathKind = 'own' | 'other' | 'plain';

export interface Board extends Path {
  world: number;
  map?: string[]; // absent where the domain has none
  fences?: [Place, Place][]; // neighbouring cells with a wall between them
  world_name?: string; // what the world is called, where a picture does not tell all of it
  start: Frame;
}

// "World 3", with its name if it has one: "World 3 (visiting hours)".
export const worldText = (board: { world: number; world_name?: string }): string => `World ${board.world}${board.world_name ? ` (${board.world_name})` : ''}`;

// A world before anybody has moved. Nothing in it tells of the reward.
export interface PlayBoard {
  domain: MapDomain;
  world: number;
  map?: string[];
  fences?: [Place, Place][];
  world_name?: string;
  start: Frame;
}

// Something that steps are counted in: "crossing rubble", and behind a number "rubble".
export interface Counted {
  name: string;
  label: string;
  one: string;
  many: string;
}

// How a terrain is drawn: no two are drawn alike.
export interface Surface {
  name: string;
  tint: 'brown' | 'blue' | 'green' | 'purple' | 'grey' | 'orange' | 'red' | 'yellow' | 'dark';
  pattern: 'dots' | 'lines' | 'cross' | 'waves';
}

// What a board needs of a domain. Without a map, legend, surfaces, width and height are absent.
export interface MapDomain {
  id: string;
  legend?: LegendEntry[];
  surfaces?: Surface[];
  width?: number;
  height?: number;
  counted?: Counted[];
  job?: string; // what the robot has to do, one sentence in English
}
