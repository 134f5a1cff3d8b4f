// Pictures of things, by words of their names (drawing.json); what has none is drawn as a letter. Paths around (0,0),
// 16 units wide: `fill` is filled with ink, `line` is drawn over a filled shape.
import { icons } from './drawing.json';

export interface Icon {
  words: string[];
  fill?: string;
  line?: string;
}

export function iconOf(name: string): Icon | undefined {
  const words = name.toLowerCase().split(/[^a-z]+/);
  return icons.find((icon) => icon.words.some((word) => words.includes(word)));
}

// What somebody rides or stands on rather than carries.
export const isRidden = (name: string): boolean => /board|\bcar\b|taxi|bike/i.test(name);
