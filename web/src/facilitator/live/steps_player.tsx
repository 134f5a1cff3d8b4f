// Steps through a path: by a button, step by step, or with a slider that the arrow keys move.
import type { JSX } from 'preact';
import { useId } from 'preact/hooks';
import { useCalm, type Playback } from '../../shared/playback';

interface PlayerProps {
  playback: Playback;
  what: string;
  text: string; // of the step that has just been made
}

export function Player({ playback, what, text }: PlayerProps): JSX.Element {
  const { step, last, playing, show, toggle } = playback;
  const calm = useCalm(); // then nothing plays by itself
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
        {step > 0 && `Step ${step} of ${last}: `}
        {text}
      </p>
    </div>
  );
}
