// One room as it happens, with its controls and its log.
import type { JSX } from 'preact';
import { useState } from 'preact/hooks';
import { duration } from '../../shared/duration';
import { useNow } from '../clock';
import { type Action, roomActions } from '../controls/actions';
import { SeatDialog } from '../controls/seat_dialog';
import { LogTable } from '../log';
import type { FacilitatorView, RoomDetail, RoomRow } from '../protocol';
import { Explained } from '../tip';
import { attention, endText, groupText, kStages, roomTitle } from '../words';
import { RoomPicture } from './picture';

interface RoomProps {
  view: FacilitatorView;
  room: RoomRow;
  mayAct: boolean;
  onSelect: (room: string) => void;
  onAct: (action: Action) => void;
}

export function Room(props: RoomProps): JSX.Element {
  const { view, room } = props;
  return (
    <>
      <RoomBar {...props} />
      {view.room?.id === room.id ? <RoomView key={room.id} {...props} detail={view.room} /> : <p class="nothing">Loading the room...</p>}
    </>
  );
}

function RoomBar({ view, room, mayAct, onSelect, onAct }: RoomProps): JSX.Element {
  const now = useNow();
  const worry = attention(room);
  const { period } = room;
  return (
    <div class="room-bar">
      <h2 class="visually-hidden">{roomTitle(room)}</h2>
      {view.rooms.length > 1 && (
        <button type="button" class="link" onClick={() => onSelect('')}>
          All rooms
        </button>
      )}
      <label class="visually-hidden" for="room-choice">
        Room
      </label>
      <select id="room-choice" value={room.id} onChange={(event) => onSelect(event.currentTarget.value)}>
        {view.rooms.map((one) => (
          <option value={one.id}>{`${roomTitle(one)}: ${kStages[one.stage].toLowerCase()}`}</option>
        ))}
      </select>
      <span class={`badge ${room.stage}`}>{kStages[room.stage]}</span>
      <span class="fact">
        Strategy{' '}
        <b class="term" tabIndex={0} data-tip={view.study.strategies.find(({ name }) => name === room.strategy)?.description}>
          {room.strategy}
        </b>
        {room.next_strategy && ` (${room.next_strategy} from the next component on)`}
      </span>
      {room.composition && (
        <span class="fact">
          <Explained term="composition">Group</Explained> <b>{groupText(room.composition)}</b>
        </span>
      )}
      {period > 0 && (
        <span class="fact">
          <Explained term="interactions">Period</Explained> <b>{period}</b>
        </span>
      )}
      {room.started_ms !== undefined && room.stage !== 'ended' && (
        <span class="fact">
          Running for <b>{duration(now - room.started_ms)}</b>
        </span>
      )}
      {room.ended && <span class="fact">{endText(room.ended)}</span>}
      {worry && worry !== 'Paused' && <span class="worry">{worry}</span>}
      {mayAct && (
        <span class="room-buttons" role="group" aria-label="Controls of the room">
          {roomActions(room, view.study).map((action) => (
            <button
              type="button"
              class={action.isDangerous ? 'danger' : action.command === 'start' || action.command === 'resume' ? 'primary' : undefined}
              aria-haspopup="dialog"
              onClick={() => onAct(action)}
            >
              {action.label}
            </button>
          ))}
        </span>
      )}
    </div>
  );
}

function RoomView({ view, room, mayAct, onAct, detail }: RoomProps & { detail: RoomDetail }): JSX.Element {
  const [opened, setOpened] = useState<number | null>(null);
  const seat = room.seats.find((one) => one.seat === opened);
  return (
    <>
      <RoomPicture study={view.study} room={room} detail={detail} onOpen={({ seat: number }) => setOpened(number)} />
      <section class="room-log" aria-labelledby="room-log-title">
        <h3 id="room-log-title">Log of this room</h3>
        <LogTable log={view.log.filter((entry) => entry.room === room.id)} rooms={view.rooms} withRoom={false} />
      </section>
      {seat && (
        <SeatDialog
          study={view.study}
          room={room}
          seat={seat}
          answers={detail.answers}
          mayAct={mayAct}
          onAct={(action) => {
            setOpened(null);
            onAct(action);
          }}
          onClose={() => setOpened(null)}
        />
      )}
    </>
  );
}
