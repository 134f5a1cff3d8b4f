// Asks for a reason and whatever else a command needs, sends it, and says what came of it.
import type { JSX } from 'preact';
import { useId, useRef, useState } from 'preact/hooks';
import { Refused } from '../connection';
import type { Action, Field } from './actions';
import { Dialog } from './dialog';

const kShortest = 3; // letters of a reason
const kLongestText = 500;

interface ActionDialogProps {
  action: Action;
  send: (command: string, body: object) => Promise<void>;
  onClose: (done: string | null) => void;
}

export function ActionDialog({ action, send, onClose }: ActionDialogProps): JSX.Element {
  const [values, setValues] = useState(() => Object.fromEntries(action.fields.map(({ name, value }) => [name, value])));
  const [reason, setReason] = useState('');
  const [problem, setProblem] = useState<string | null>(null);
  const [isSent, setSent] = useState(false);
  const first = useRef<HTMLInputElement>(null);
  const id = useId();
  const submit = async (event: Event): Promise<void> => {
    event.preventDefault();
    if (isSent) return;
    if (reason.trim().length < kShortest) {
      const length = reason.trim().length;
      setProblem(
        length === 0
          ? 'Please give a reason, or choose one below. It is recorded in the log.'
          : `"${reason.trim()}" is too short: a reason has at least ${kShortest} letters.`,
      );
      first.current?.focus();
      return;
    }
    setSent(true);
    setProblem(null);
    try {
      await send(action.command, { reason: reason.trim(), ...action.body(values) });
      onClose(action.done);
    } catch (error) {
      setSent(false);
      setProblem(error instanceof Refused ? error.message : String(error));
    }
  };
  return (
    <Dialog title={action.title} onClose={() => onClose(null)}>
      <form onSubmit={submit} noValidate>
        <p>{action.explains}</p>
        {action.fields.map((field, i) => (
          <FieldView field={field} isFirst={i === 0} value={values[field.name] ?? ''} onInput={(value) => setValues({ ...values, [field.name]: value })} />
        ))}
        <label for={id}>{`Reason (at least ${kShortest} letters; recorded in the log)`}</label>
        <input
          id={id}
          ref={first}
          type="text"
          autocomplete="off"
          autofocus={action.fields.length === 0}
          maxLength={kLongestText}
          value={reason}
          aria-required="true"
          aria-invalid={problem !== null && reason.trim().length < kShortest}
          onInput={(event) => setReason(event.currentTarget.value)}
        />
        <div class="suggestions" role="group" aria-label="Suggested reasons">
          {action.reasons.map((text) => (
            <button type="button" class="small" onClick={() => setReason(text)}>
              {text}
            </button>
          ))}
        </div>
        <p class="problem" role="alert">
          {problem}
        </p>
        <div class="dialog-buttons">
          <button type="button" onClick={() => onClose(null)}>
            {isSent ? 'Close' : 'Cancel'}
          </button>
          <button type="submit" class={action.isDangerous ? 'danger' : 'primary'} aria-disabled={isSent}>
            {isSent ? 'Sending\u2026' : (action.verb ?? action.label)}
          </button>
        </div>
      </form>
    </Dialog>
  );
}

interface FieldViewProps {
  field: Field;
  isFirst: boolean; // has the focus when the dialog opens
  value: string;
  onInput: (value: string) => void;
}

function FieldView({ field, isFirst, value, onInput }: FieldViewProps): JSX.Element {
  const id = useId();
  return (
    <>
      <label for={id}>{field.label}</label>
      {field.kind === 'select' && (
        <select id={id} autofocus={isFirst} value={value} onChange={(event) => onInput(event.currentTarget.value)}>
          {(field.options ?? []).map((option) => (
            <option value={option.value}>{option.label}</option>
          ))}
        </select>
      )}
      {field.kind === 'number' && (
        <input
          id={id}
          autofocus={isFirst}
          type="number"
          min={field.min}
          max={field.max}
          value={value}
          onInput={(event) => onInput(event.currentTarget.value)}
        />
      )}
      {field.kind === 'text' && (
        <textarea id={id} autofocus={isFirst} rows={3} maxLength={kLongestText} value={value} onInput={(event) => onInput(event.currentTarget.value)} />
      )}
    </>
  );
}
