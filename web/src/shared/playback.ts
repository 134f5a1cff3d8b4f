// Plays a path step by step, and says whether somebody asks for less motion.
import { useEffect, useLayoutEffect, useState } from 'preact/hooks';

export interface Playback {
  step: number;
  last: number;
  playing: boolean;
  show: (step: number) => void;
  toggle: () => void;
}

const kLongest = 14000; // milliseconds for a whole path
const kPace = { slowest: 750, fastest: 160 };

// `speed` divides the time between steps.
export function usePlayback(last: number, speed = 1): Playback {
  const [step, setStep] = useState(0);
  const [isStarted, setStarted] = useState(false);
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
      if (step === last) setStep(0);
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
