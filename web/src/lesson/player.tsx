// Steps through a path: by a button, step by step, or with a slider that the arrow keys move.
import type { JSX } from 'preact';
import { useEffect, useId, useState } from 'preact/hooks';
import type { Frame } from './document';
import { stepText } from './words';

export interface Playback {
  step: number;
  last: number;
  playing: boolean;
  show: (step: number) => void;
  toggle: () => void;
}

const kLongest = 14000; // milliseconds for a whole path
const kPace = { slowest: 750, fastest: 160 };

export function usePlayback(last: number): Playback {
  const [step, setStep] = useState(0);
  const [playing, setPlaying] = useState(false);
  useEffect(() => {
    if (!playing) return;
    const pace = Math.max(kPace.fastest, Math.min(kPace.slowest, kLongest / Math.max(1, last)));
    const timer = setInterval(() => setStep((now) => Math.min(now + 1, last)), pace);
    return () => clearInterval(timer);
  }, [playing, last]);
  useEffect(() => {
    if (step === last) setPlaying(false);
  }, [step, last]);
  return {
    step,
    last,
    playing,
    show: (to) => {
      setPlaying(false);
      setStep(Math.max(0, Math.min(to, last)));
    },
    toggle: () => {
      if (!playing && step === last) setStep(0);
      setPlaying(!playing);
    },
  };
}

// Whether the reader asks for less motion; then there is nothing that plays by itself.
function useCalm(): boolean {
  const query = window.matchMedia('(prefers-reduced-motion: reduce)');
  const [calm, setCalm] = useState(query.matches);
  useEffect(() => {
    const changed = (event: MediaQueryListEvent): void => setCalm(event.matches);
    query.addEventListener('change', changed);
    return () => query.removeEventListener('change', changed);
  }, []);
  return calm;
}

export function Player({ frames, playback, what }: { frames: Frame[]; playback: Playback; what: string }): JSX.Element {
  const { step, last, playing, show, toggle } = playback;
  const calm = useCalm();
  const id = useId();
  return (
    <div class="player" role="group" aria-label={`Steps of ${what}`}>
      <div class="buttons">
        {!calm && (
          <button type="button" class="play" onClick={toggle}>
            {playing ? 'Pause' : step === last ? 'Again' : 'Play'}
          </button>
        )}
        <button type="button" aria-label="Previous step" disabled={step === 0} onClick={() => show(step - 1)}>
          &#x2190;
        </button>
        <button type="button" aria-label="Next step" disabled={step === last} onClick={() => show(step + 1)}>
          &#x2192;
        </button>
        <input
          type="range"
          aria-label={`Step of ${what}`}
          aria-describedby={id}
          aria-valuetext={`${step} of ${last}`}
          min={0}
          max={last}
          step={1}
          value={step}
          onInput={(event) => show(Number(event.currentTarget.value))}
        />
      </div>
      <p class="step" id={id} aria-live={playing ? 'off' : 'polite'}>
        {stepText(frames, step)}
      </p>
    </div>
  );
}
