// What happens on a board, sentence by sentence: the last one is visible, a screen reader hears them all.
import type { JSX } from 'preact';
import { useCallback, useLayoutEffect, useRef, useState } from 'preact/hooks';
import type { Legend } from '../board/legend';
import { played } from '../board/repeats';
import type { Path, PlayBoard } from '../board/types';
import { playedText } from './words';

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

// A log of a path that is played: a sentence when the robot has taken a step.
export function usePathLog(board: PlayBoard, legend: Legend, path: Path, step: number): Log {
  const log = useLog(playedText(board, legend, path, Math.min(step, played(path).length - 1)));
  const shown = useRef(step);
  useLayoutEffect(() => {
    if (step === shown.current) return;
    shown.current = step;
    if (step < played(path).length) log.say(playedText(board, legend, path, step));
  }, [step]);
  return log;
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
