// What happens on a board, sentence by sentence: the last one is visible, a screen reader hears them all.
import type { JSX } from 'preact';
import { useCallback, useState } from 'preact/hooks';

export interface Log {
  entries: { number: number; text: string }[];
  say: (text: string) => void;
}

const kKept = 20;

export function useLog(first: string): Log {
  const [entries, setEntries] = useState([{ number: 0, text: first }]);
  const say = useCallback((text: string) => {
    setEntries((before) => {
      const last = before[before.length - 1];
      return [...before, { number: (last?.number ?? 0) + 1, text }].slice(-kKept);
    });
  }, []);
  return { entries, say };
}

export function LogView({ log }: { log: Log }): JSX.Element {
  return (
    <div class="log" role="log" aria-live="polite">
      {log.entries.map(({ number, text }) => (
        <p key={number}>{text}</p>
      ))}
    </div>
  );
}
