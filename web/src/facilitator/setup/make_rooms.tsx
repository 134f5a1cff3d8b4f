// The form that makes rooms: strategy, seats and how many.
import type { JSX } from 'preact';
import { useState } from 'preact/hooks';
import { Refused } from '../connection';
import type { StudyInfo } from '../protocol';
import { counted } from '../../shared/texts';

const kMostSeats = 30;
const kMostRooms = 200;
const kPerson = 'person';

interface MakeRoomsProps {
  study: StudyInfo;
  send: (command: string, body: object) => Promise<void>;
}

export function MakeRooms({ study, send }: MakeRoomsProps): JSX.Element {
  const [strategy, setStrategy] = useState('');
  const [seats, setSeats] = useState<string[]>(() => Array<string>(study.size ?? 3).fill(kPerson));
  const [count, setCount] = useState(1);
  const [reason, setReason] = useState('');
  const [said, setSaid] = useState<{ text: string; isProblem: boolean }>({ text: '', isProblem: false });
  const [isSent, setSent] = useState(false);
  const people = seats.filter((seat) => seat === kPerson).length;

  const submit = async (event: Event): Promise<void> => {
    event.preventDefault();
    if (isSent) return;
    setSent(true);
    setSaid({ text: '', isProblem: false });
    try {
      await send('room-make', { ...(strategy === '' ? {} : { strategy }), seats, count, reason: reason.trim() || 'Set-up' });
      setSaid({ text: `${counted(count, 'room')} made. ${count === 1 ? 'Its links are' : 'Their links are'} below.`, isProblem: false });
    } catch (error) {
      setSaid({ text: error instanceof Refused ? error.message : String(error), isProblem: true });
    }
    setSent(false);
  };
  const resize = (size: number): void =>
    setSeats(Array.from({ length: Math.max(1, Math.min(kMostSeats, size || 1)) }, (_, i) => seats[i] ?? kPerson));

  return (
    <form class="make" onSubmit={submit}>
      <div class="row">
        <div>
          <label for="make-strategy">Strategy</label>
          <select id="make-strategy" value={strategy} onChange={(event) => setStrategy(event.currentTarget.value)}>
            <option value="">in turn, by design</option>
            {study.strategies.map(({ name }) => (
              <option value={name}>{name}</option>
            ))}
          </select>
        </div>
        <div>
          <label for="make-size">Seats</label>
          <input id="make-size" type="number" min={1} max={kMostSeats} value={seats.length} onInput={(event) => resize(event.currentTarget.valueAsNumber)} />
        </div>
        <div>
          <label for="make-count">Rooms</label>
          <input
            id="make-count"
            type="number"
            min={1}
            max={kMostRooms}
            value={count}
            onInput={(event) => setCount(Math.max(1, Math.min(kMostRooms, event.currentTarget.valueAsNumber || 1)))}
          />
        </div>
        <div class="grow">
          <label for="make-reason">Note for the log (optional)</label>
          <input id="make-reason" type="text" maxLength={200} autocomplete="off" value={reason} onInput={(event) => setReason(event.currentTarget.value)} />
        </div>
      </div>
      <p class="hint">{strategy === ''
          ? 'Rooms are assigned the study\u2019s combinations of strategy and composition in turn, starting with those that have the fewest rooms.'
          : study.strategies.find(({ name }) => name === strategy)?.description}</p>
      <fieldset>
        <legend>Seats of a room</legend>
        <div class="seat-choices">
          {seats.map((seat, i) => (
            <label>
              {`Seat ${i + 1}`}
              <select value={seat} onChange={(event) => setSeats(seats.map((one, k) => (k === i ? event.currentTarget.value : one)))}>
                <option value={kPerson}>person</option>
                {study.types.map(({ letter, label }) => (
                  <option value={letter}>{`simulated: ${label}`}</option>
                ))}
              </select>
            </label>
          ))}
        </div>
        <p class="hint">
          {people === seats.length
            ? 'All seats are for people.'
            : `${people} of ${seats.length} seats are for people. The consent form says that the others are simulated.`}
        </p>
      </fieldset>
      <button type="submit" class="primary" aria-disabled={isSent}>
        {isSent ? 'Making rooms\u2026' : `Make ${counted(count, 'room')}`}
      </button>
      <p class={said.isProblem ? 'problem' : 'done'} role="status">
        {said.text}
      </p>
    </form>
  );
}
