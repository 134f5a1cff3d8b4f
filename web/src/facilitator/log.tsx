// What was done, by whom and why.
import type { JSX } from 'preact';
import { useState } from 'preact/hooks';
import { clockText } from './clock';
import type { FacilitatorView, LogEntry, RoomRow } from './protocol';
import { capitalised } from '../shared/texts';
import { actorText, loggedText, roomTitle } from './words';

interface LogTableProps {
  log: LogEntry[];
  rooms: RoomRow[];
  withRoom: boolean;
}

export function LogTable({ log, rooms, withRoom }: LogTableProps): JSX.Element {
  if (log.length === 0) return <p class="hint">Nothing has been logged yet.</p>;
  const titles = new Map(rooms.map((room) => [room.id, roomTitle(room)]));
  const newest = [...log].sort((a, b) => b.at_ms - a.at_ms);
  return (
    <div class="scroller" role="region" aria-label="Log" tabIndex={0}>
      <table class="log">
        <thead>
          <tr>
            <th scope="col">Time</th>
            {withRoom && <th scope="col">Room</th>}
            <th scope="col">Who</th>
            <th scope="col">What</th>
            <th scope="col">Reason</th>
          </tr>
        </thead>
        <tbody>
          {newest.map(({ at_ms, room, actor, what, reason }) => (
            <tr>
              <td class="time">{clockText(at_ms)}</td>
              {withRoom && <td>{room ? (titles.get(room) ?? room) : ''}</td>}
              <td>{capitalised(actorText(actor, rooms.find(({ id }) => id === room)))}</td>
              <td>{capitalised(loggedText(what))}</td>
              <td>{reason}</td>
            </tr>
          ))}
        </tbody>
      </table>
    </div>
  );
}

export function LogPage({ view }: { view: FacilitatorView }): JSX.Element {
  const [room, setRoom] = useState('');
  const [onlyPeople, setOnlyPeople] = useState(false);
  const shown = view.log.filter(
    (entry) => (room === '' || entry.room === room) && (!onlyPeople || entry.actor === 'facilitator'),
  );
  return (
    <section class="page" aria-labelledby="log-title">
      <h2 id="log-title">Log</h2>
      <p class="hint">The last 200 entries. The export contains all events.</p>
      <div class="filters">
        <label for="log-room">Room</label>
        <select id="log-room" value={room} onChange={(event) => setRoom(event.currentTarget.value)}>
          <option value="">all rooms</option>
          {view.rooms.map((one) => (
            <option value={one.id}>{roomTitle(one)}</option>
          ))}
        </select>
        <label class="check">
          <input type="checkbox" checked={onlyPeople} onChange={(event) => setOnlyPeople(event.currentTarget.checked)} /> Only actions of facilitators
        </label>
      </div>
      <LogTable log={shown} rooms={view.rooms} withRoom />
    </section>
  );
}
