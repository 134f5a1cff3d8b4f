// What the teacher knows of a room: who needs help, people and answers on the left, the lesson and the progress on the
// right. Beliefs, and what else could have been shown, are for researchers.
import type { JSX } from 'preact';
import { useState } from 'preact/hooks';
import type { RoomDetail, RoomRow, SeatRow, StudyInfo } from '../protocol';
import { memberOfSeat, seatOf } from './beliefs';
import { Curves } from './curves';
import { GroupTable } from './group_table';
import { LessonPanel } from './lesson_now';
import { Now } from './now';
import { Progress } from './progress';
import { Spheres } from './spheres';
import { useWindowHeight } from '../../shared/width';

// Pixels, as in live.css. What the table leaves of the window is for spheres and charts, so that everything is
// visible without scrolling.
const kTableRow = 22;
const kAround = 230; // bars, heads and gaps
const kSpheres = { share: 0.68, least: 150, most: 330 };
const kChart = { least: 80, most: 190 };

function heightsFor(window_px: number, seats: number): { spheres: number; chart: number } {
  const rest = window_px - kAround - seats * kTableRow;
  const chart = Math.max(kChart.least, Math.min(kChart.most, (1 - kSpheres.share) * rest));
  return { chart, spheres: Math.max(kSpheres.least, Math.min(kSpheres.most, rest - chart)) };
}

interface Props {
  study: StudyInfo;
  room: RoomRow;
  detail: RoomDetail;
  onOpen?: (seat: SeatRow) => void; // if it happens now: who is looked at more closely
}

let wasDeep = false; // also for the room that is opened next

export function RoomPicture({ study, room, detail, onOpen }: Props): JSX.Element {
  const [marked, setMarked] = useState<number | null>(null);
  const [isDeep, setDeep] = useState(wasDeep || !onOpen);
  const heights = heightsFor(useWindowHeight(), room.seats.length);
  const period = detail.session.phase === 'teacher' ? room.period - 1 : room.period; // of the lesson
  const nameOf = (belief: string): string => seatOf(room.seats, belief)?.label ?? belief;
  const memberOf = (number: string): number => {
    const found = room.seats.find((one) => String(one.seat) === number);
    return found ? memberOfSeat(found) : Number(number);
  };
  return (
    <div class="live">
      <div class="live-main">
        {onOpen && <Now room={room} detail={detail} study={study} />}
        <GroupTable study={study} room={room} detail={detail} marked={marked} onMark={setMarked} onOpen={onOpen} />
        <details
          class="deep"
          open={isDeep}
          onToggle={(event) => {
            wasDeep = event.currentTarget.open && onOpen !== undefined;
            setDeep(event.currentTarget.open);
          }}
        >
          <summary>For researchers</summary>
          {isDeep && <Spheres detail={detail} height={heights.spheres} nameOf={nameOf} marked={marked} onMark={setMarked} />}
          {isDeep && detail.curves.length > 0 && <Curves detail={detail} height={heights.chart} marked={marked} nameOf={nameOf} memberOfSeat={memberOf} />}
        </details>
      </div>
      <div class="live-side">
        <Progress room={room} detail={detail} />
        <LessonPanel key={period} lesson={detail.lesson} period={period} isDeep={isDeep} />
      </div>
    </div>
  );
}
