// Plays a path: play or pause, one step back or forward, and how fast.
import type { JSX } from 'preact';
import { useLayoutEffect, useRef, useState } from 'preact/hooks';
import { usePlayback, type Beginning, type Playback } from '../playback';
import { isElsewhere } from './keys';
import { t } from '../texts';
import { Button } from './button';

const kSpeeds = [
  { key: 'slow', value: 0.6 },
  { key: 'normal', value: 1 },
  { key: 'fast', value: 2 },
] as const;

export interface Paced extends Playback {
  speed: number;
  setSpeed: (speed: number) => void;
}

export function usePacedPlayback(last: number, beginning?: Beginning): Paced {
  const [speed, setSpeed] = useState(1);
  return { ...usePlayback(last, speed, beginning), speed, setSpeed };
}

function Icon({ path }: { path: string }): JSX.Element {
  return (
    <svg class="icon" viewBox="0 0 24 24" aria-hidden="true" focusable="false">
      <path d={path} />
    </svg>
  );
}
const kIcons = {
  play: 'M7 4v16l13-8z',
  pause: 'M6 4h4.5v16H6zM13.5 4H18v16h-4.5z',
  again: 'M12 5V1L6.5 6 12 11V7.5a4.9 4.9 0 1 1-4.9 5H4.4A7.6 7.6 0 1 0 12 5z',
  back: 'M18 4v16L8 12zM5 4h2.6v16H5z',
  forward: 'M6 4v16l10-8zM16.4 4H19v16h-2.6z',
};

export function Player({ playback, primary }: { playback: Paced; primary: boolean }): JSX.Element {
  const { step, last, playing, show, toggle, speed, setSpeed } = playback;
  const current = useRef(playback);
  current.current = playback; // keys may come faster than effects
  useLayoutEffect(() => {
    const pressed = (event: KeyboardEvent): void => {
      if (isElsewhere(event) || event.altKey || event.ctrlKey || event.metaKey) return;
      const now = current.current;
      if (event.key === 'ArrowRight') now.show(now.step + 1);
      else if (event.key === 'ArrowLeft') now.show(now.step - 1);
      else return;
      event.preventDefault();
    };
    document.addEventListener('keydown', pressed);
    return () => document.removeEventListener('keydown', pressed);
  }, []);
  const what = playing ? 'pause' : step === last ? 'again' : 'play';
  return (
    <div class="player" role="group" aria-label={t('player.group')}>
      <div class="buttons">
        <Button primary={primary} class="play" onClick={toggle}>
          <Icon path={kIcons[what]} />
          {t(`player.${what}`)}
        </Button>
        <Button class="step-button" off={step === 0} onClick={() => show(step - 1)}>
          <Icon path={kIcons.back} />
          <span class="visually-hidden">{t('player.back')}</span>
        </Button>
        <Button class="step-button" off={step === last} onClick={() => show(step + 1)}>
          <Icon path={kIcons.forward} />
          <span class="visually-hidden">{t('player.forward')}</span>
        </Button>
      </div>
      <div class="pace">
        <p class="muted count">{t('player.step', { step, of: last })}</p>
        <label class="speed">
          <span>{t('player.speed')}</span>
          <select value={String(speed)} onChange={(event) => setSpeed(Number(event.currentTarget.value))}>
            {kSpeeds.map(({ key, value }) => (
              <option value={String(value)}>{t(`player.${key}`)}</option>
            ))}
          </select>
        </label>
      </div>
    </div>
  );
}
