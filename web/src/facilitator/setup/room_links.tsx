// The links of every seat, room by room.
import type { JSX } from 'preact';
import { useState } from 'preact/hooks';
import type { RoomRow } from '../protocol';
import { kStages, roomTitle } from '../words';
import { LinkBox } from './link_box';

const kOpenUpTo = 2; // rooms whose links are shown at once

export function RoomLinks({ rooms }: { rooms: RoomRow[] }): JSX.Element | null {
  const withLinks = rooms.filter(({ stage, seats }) => stage !== 'ended' && seats.some(({ link }) => link));
  if (withLinks.length === 0) return null;
  return (
    <div class="room-links">
      <h3>Links of individual seats</h3>
      {withLinks.map((room) => (
        <Links key={room.id} room={room} opened={withLinks.length <= kOpenUpTo} />
      ))}
    </div>
  );
}

// Links are only made visible when asked for: with many rooms there are hundreds.
function Links({ room, opened }: { room: RoomRow; opened: boolean }): JSX.Element {
  const [open, setOpen] = useState(opened);
  return (
    <details open={open} onToggle={(event) => setOpen(event.currentTarget.open)}>
      <summary>
        {roomTitle(room)} ({kStages[room.stage].toLowerCase()}, {room.strategy})
      </summary>
      {open &&
        room.seats.map(({ seat, label, link }) => link && <LinkBox key={seat} label={`${label}, ${roomTitle(room)}`} link={link} />)}
    </details>
  );
}
