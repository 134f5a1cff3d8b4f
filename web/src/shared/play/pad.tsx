// Buttons for the robot's actions: arrows where they lie on a board, all others with their names.
import type { JSX } from 'preact';
import { actionLabel, capitalised, t } from '../texts';
import type { Action } from './world';
import { Button } from './button';

interface Props {
  actions: Action[];
  canDo: (action: number) => boolean;
  onAction: (action: number) => void;
  off: boolean;
}

const isArrow = ({ shift }: Action): boolean => shift !== null && Math.abs(shift[0]) <= 1 && Math.abs(shift[1]) <= 1;

export function Pad({ actions, canDo, onAction, off }: Props): JSX.Element {
  const arrows = actions.filter(isArrow);
  const others = actions.filter((action) => !isArrow(action));
  return (
    <div class="pad-row">
      {arrows.length > 0 && (
        <div class="pad" role="group" aria-label={t('predict.pad')}>
          {arrows.map((action) => (
            <Button
              class={`arrow x${(action.shift?.[0] ?? 0) + 2} y${(action.shift?.[1] ?? 0) + 2} ${canDo(action.index) ? '' : 'faint'}`}
              off={off}
              onClick={() => onAction(action.index)}
            >
              <Arrow shift={action.shift ?? [0, 0]} />
              <span class="visually-hidden">{capitalised(actionLabel(action.name))}</span>
            </Button>
          ))}
        </div>
      )}
      {others.length > 0 && (
        <div class="other-actions" role="group" aria-label={t('predict.actions')}>
          {others.map((action) => (
            <Button class={canDo(action.index) ? '' : 'faint'} off={off} onClick={() => onAction(action.index)}>
              {capitalised(actionLabel(action.name))}
            </Button>
          ))}
        </div>
      )}
    </div>
  );
}

function Arrow({ shift }: { shift: [number, number] }): JSX.Element {
  const angle = (Math.atan2(shift[1], shift[0]) * 180) / Math.PI;
  return (
    <svg class="icon" viewBox="-12 -12 24 24" aria-hidden="true" focusable="false">
      <path d="M-8 -2.2H1.5V-8L9.5 0 1.5 8V2.2H-8Z" transform={`rotate(${angle})`} />
    </svg>
  );
}
