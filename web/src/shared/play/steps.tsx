// Paths in models without a map: states and actions as lists.
import type { JSX } from 'preact';
import type { Frame } from '../board/types';
import { actionLabel, named, t } from '../texts';

export function StateCard({ frame }: { frame: Frame }): JSX.Element {
  return <p class="state-card">{named(frame.state ?? '')}</p>;
}

interface Props {
  title: string;
  frames: Frame[]; // as far as it has been walked
  differs?: number | null | undefined;
}

export function StepList({ title, frames, differs }: Props): JSX.Element {
  return (
    <div class="step-list">
      <h2>{title}</h2>
      <ol>
        {frames.map(({ state, action }, i) => (
          <li class={differs === i ? 'differs' : undefined}>
            <span class="state">{named(state ?? '')}</span>
            {action && <span class="action"> {'\u2192'} {actionLabel(action)}</span>}
            {differs === i && <span class="mark">{t('feedback.here')}</span>}
          </li>
        ))}
      </ol>
    </div>
  );
}
