// Plays a path step by step, and says whether somebody asks for less motion.
import { useEffect, useLayoutEffect, useState } from 'preact/hooks';

export interface Playback {
  step: number;
  last: number;
  playing: boolean;
  show: (step: number) => void;
  toggle: () => void;
}

const kLongest = 12000; // milliseconds for a whole path at normal speed
const kPace = { slowest: 750, fastest: 40 };

// Where it begins, and whether it does so by itself; for those who ask for less motion it is at its end.
export interface Beginning {
  from: number;
  isAuto: boolean;
  isAtEnd?: boolean; // already played
}

// `speed` divides the time between steps.
export function usePlayback(last: number, speed = 1, { from, isAuto, isAtEnd }: Beginning = { from: 0, isAuto: false }): Playback {
  const calm = useCalm();
  const [step, setStep] = useState(isAtEnd || (isAuto && calm) ? last : from);
  const [isStarted, setStarted] = useState(isAuto && !calm);
  const playing = isStarted && step < last;
  useEffect(() => {
    if (!playing) return;
    const pace = Math.max(kPace.fastest, Math.min(kPace.slowest, kLongest / Math.max(1, last))) / speed;
    const timer = setInterval(() => setStep((now) => Math.min(now + 1, last)), pace);
    return () => clearInterval(timer);
  }, [playing, last, speed]);
  return {
    step,
    last,
    playing,
    show: (to) => {
      setStarted(false);
      setStep(Math.max(0, Math.min(to, last)));
    },
    toggle: () => {
      if (step === last) setStep(from);
      setStarted(!playing);
    },
  };
}

// Whether the reader asks for less motion.
export function useCalm(): boolean {
  const query = window.matchMedia('(prefers-reduced-motion: reduce)');
  const [calm, setCalm] = useState(query.matches);
  useLayoutEffect(() => {
    const changed = (event: MediaQueryListEvent): void => setCalm(event.matches);
    query.addEventListener('change', changed);
    return () => query.removeEventListener('change', changed);
  }, []);
  return calm;
}
