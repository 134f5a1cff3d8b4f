// All rooms, one row each: who is there, how far they are, and how long they will take.
import type { JSX } from 'preact';
import { useState } from 'preact/hooks';
import { duration } from '../shared/duration';
import { minutesText, useNow } from './clock';
import { PresenceMark, whereabouts } from './live/group_table';
import type { FacilitatorView, RoomRow, RoomStage, SeatRow } from './protocol';
import { Explained } from './tip';
import { counted } from '../shared/texts';
import { attention, endText, groupText, kStages, roomTitle, seatTitle } from './words';

type Filter = 'all' | 'attention' | RoomStage;

const kFilters: { filter: Filter; label: string }[] = [
  { filter: 'all', label: 'All' },
  { filter: 'attention', label: 'Need attention' },
  ...(Object.entries(kStages) as [RoomStage, string][]).map(([filter, label]) => ({ filter, label })),
];

const passes = (room: RoomRow, filter: Filter): boolean =>
  filter === 'all' || (filter === 'attention' ? attention(room) !== null : room.stage === filter);

function matches(room: RoomRow, text: string): boolean {
  const wanted = text.trim().toLowerCase();
  const words = [room.id, room.code ?? '', room.strategy, ...room.seats.flatMap(({ label, name }) => [label, name ?? ''])];
  return wanted === '' || words.some((word) => word.toLowerCase().includes(wanted));
}

interface RoomsProps {
  view: FacilitatorView;
  onOpen: (room: string) => void;
}

export function Rooms({ view, onOpen }: RoomsProps): JSX.Element {
  const [filter, setFilter] = useState<Filter>('all');
  const [text, setText] = useState('');
  const now = useNow();
  // Those that need somebody come first.
  const shown = view.rooms
    .filter((room) => passes(room, filter) && matches(room, text))
    .sort((a, b) => Number(attention(b) !== null) - Number(attention(a) !== null));
  const people = view.rooms.flatMap(({ seats }) => seats).filter(({ kind }) => kind === 'person');
  const here = people.filter(({ presence }) => presence === 'here').length;
  return (
    <section class="page" aria-labelledby="rooms-title">
      <h2 id="rooms-title">Rooms</h2>
      <p class="hint">{`${counted(view.rooms.length, 'room')}; ${here} of ${counted(people.length, 'person', 'people')} connected.`}</p>
      <div class="filters">
        <div role="group" aria-label="Show rooms" class="chips">
          {kFilters.map(({ filter: one, label }) => (
            <button type="button" aria-pressed={filter === one} onClick={() => setFilter(one)}>
              {label} <span class="count">{view.rooms.filter((room) => passes(room, one)).length}</span>
            </button>
          ))}
        </div>
        <label for="rooms-find">Find</label>
        <input id="rooms-find" type="search" value={text} placeholder="code, strategy, name" onInput={(event) => setText(event.currentTarget.value)} />
      </div>
      {shown.length === 0 ? (
        <p class="nothing">{view.rooms.length === 0 ? 'There are no rooms yet. Create one under Set-up.' : 'No room matches.'}</p>
      ) : (
        <div class="scroller" role="region" aria-label="Rooms" tabIndex={0}>
          <table class="rooms">
            <thead>
              <tr>
                <th scope="col">Room</th>
                <th scope="col">Stage</th>
                <th scope="col">Strategy</th>
                <th scope="col">Seats</th>
                <th scope="col" class="number">
                  <Explained term="interactions">Period</Explained>
                </th>
                <th scope="col" class="number">
                  <Explained term="component">Component</Explained>
                </th>
                <th scope="col" class="number">
                  Running for
                </th>
                <th scope="col" class="number">
                  <Explained term="forecast">Time left</Explained>
                </th>
                <th scope="col">Attention</th>
              </tr>
            </thead>
            <tbody>
              {shown.map((room) => (
                <Row key={room.id} room={room} now={now} onOpen={onOpen} />
              ))}
            </tbody>
          </table>
        </div>
      )}
    </section>
  );
}

interface RowProps {
  room: RoomRow;
  now: number;
  onOpen: (room: string) => void;
}

function Row({ room, now, onOpen }: RowProps): JSX.Element {
  const { forecast } = room;
  return (
    <tr>
      <th scope="row">
        <button type="button" class="link" onClick={() => onOpen(room.id)}>
          {roomTitle(room)}
        </button>
      </th>
      <td>
        <span class={`badge ${room.stage}`}>{kStages[room.stage]}</span>
        {room.stage === 'ended' && <span class="hint"> {endText(room.ended)}</span>}
      </td>
      <td>
        {room.strategy}
        {room.composition && <span class="hint"> {groupText(room.composition)}</span>}
      </td>
      <td>
        <ul class="seat-marks">
          {room.seats.map((seat) => (
            <li data-tip={tipOf(seat, now)}>
              <PresenceMark seat={seat} />
            </li>
          ))}
        </ul>
      </td>
      <td class="number" data-head="Period">
        {room.period || null}
      </td>
      <td class="number" data-head="Component">
        {room.stage === 'lobby' ? null : room.component}
      </td>
      <td class="number" data-head="Running for">
        {room.started_ms === undefined || room.stage === 'ended' ? null : duration(now - room.started_ms)}
      </td>
      <td class="number" data-head="Time left">
        {forecast && room.stage !== 'ended' ? minutesText(forecast.minutes_low, forecast.minutes_high) : null}
      </td>
      <td class="worry-cell">{attention(room)}</td>
    </tr>
  );
}

function tipOf(seat: SeatRow, now: number): string {
  const latency = seat.latency_ms === undefined ? '' : `, ${Math.round(seat.latency_ms)} ms`;
  return `${seatTitle(seat)}: ${whereabouts(seat, now)}${latency}`;
}
