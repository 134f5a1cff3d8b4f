// Pictures of things, by words of their names; what has none is drawn as a letter. Paths around (0,0), 16 units wide:
// `fill` is filled with ink, `line` is drawn over a filled shape.
export interface Icon {
  words: string[];
  fill?: string;
  line?: string;
}

const kIcons: Icon[] = [
  { words: ['parcel', 'box', 'crate', 'package', 'item'], line: 'M-7-4 0-7.5 7-4V4.5L0 8-7 4.5ZM-7-4 0-.5 7-4M0-.5V8M-3.5-5.7 3.5-2.2' },
  { words: ['charger', 'charge', 'recharge', 'battery'], fill: 'M2-8.5-5.5 1.2H-.8L-2 8.5 5.5-1.6H.8Z' },
  {
    words: ['passenger', 'person', 'somebody', 'casualty', 'patient'],
    fill: 'M0-8a3.4 3.4 0 1 1 0 6.8A3.4 3.4 0 0 1 0-8ZM-6.5 8C-6.5-2.5 6.5-2.5 6.5 8Z',
  },
  {
    words: ['skateboard', 'board'],
    fill: 'M-8.5-2.5q2 3 4.5 3h8q2.5 0 4.5-3l1.4 1.3q-2.3 3.7-5.9 3.7h-8q-3.6 0-5.9-3.7ZM-4 3.5a2 2 0 1 1 0 4 2 2 0 0 1 0-4ZM4 3.5a2 2 0 1 1 0 4 2 2 0 0 1 0-4Z',
  },
  {
    words: ['car', 'taxi', 'truck'],
    fill: 'M-8.5 4V.5L-5.5-.5-3.5-5h6L5.5-.5 8.5.5V4ZM-4.5 2.5a2.3 2.3 0 1 1 0 4.6 2.3 2.3 0 0 1 0-4.6ZM4.5 2.5a2.3 2.3 0 1 1 0 4.6 2.3 2.3 0 0 1 0-4.6Z',
  },
  { words: ['medkit', 'medicine'], fill: 'M-2.6-7.5h5.2v4.9h4.9v5.2h-4.9v4.9h-5.2v-4.9h-4.9v-5.2h4.9Z' },
  { words: ['jar'], line: 'M-4.5-7.5h9v2.5h-9ZM-5.5-5h11v10.5q0 2-2 2h-7q-2 0-2-2Z' },
  { words: ['crumb', 'cookie'], fill: 'M-3-4a3.4 3.4 0 1 1 0 6.8 3.4 3.4 0 0 1 0-6.8ZM4.5-1.5a2 2 0 1 1 0 4 2 2 0 0 1 0-4ZM2 4a1.6 1.6 0 1 1 0 3.2 1.6 1.6 0 0 1 0-3.2Z' },
  { words: ['hut', 'home', 'house'], fill: 'M-8.5 0 0-7.5 8.5 0H6V7.5H1.8V2.5H-1.8V7.5H-6V0Z' },
];

export function iconOf(name: string): Icon | undefined {
  const words = name.toLowerCase().split(/[^a-z]+/);
  return kIcons.find((icon) => icon.words.some((word) => words.includes(word)));
}

// What somebody rides or stands on rather than carries.
export const isRidden = (name: string): boolean => /board|\bcar\b|taxi|bike/i.test(name);
