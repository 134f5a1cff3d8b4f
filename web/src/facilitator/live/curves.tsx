// Two small charts over periods: p(BEC) of each belief, and the share of right answers so far.
import type { JSX } from 'preact';
import { Lines, type Line } from '../../shared/lines';
import { useWidth } from '../../shared/width';
import type { RoomDetail } from '../protocol';
import { Explained } from '../tip';
import { beliefKind, memberOf, shortName } from './beliefs';

const kBetween = 14; // px between the charts
const kNarrow = 560; // px below which the charts are under each other

interface CurvesProps {
  detail: RoomDetail;
  height: number; // px of a chart
  marked: number | null;
  nameOf: (belief: string) => string;
  memberOfSeat: (seat: string) => number;
}

export function Curves({ detail: { curves }, height, marked, nameOf, memberOfSeat }: CurvesProps): JSX.Element {
  const linesOf = (rows: { period: number; shares: Record<string, number> }[]): Line[] =>
    [...new Set(rows.flatMap(({ shares }) => Object.keys(shares)))].map((belief) => ({
      name: nameOf(belief),
      label: shortName(nameOf(belief)),
      kind: belief === 'mean' ? 'mean' : beliefKind(belief),
      isMarked: marked !== null && memberOf(belief) === marked,
      points: rows.flatMap(({ period, shares: { [belief]: share } }) => (share === undefined ? [] : [{ period, share }])),
    }));
  const right = curves.map(({ period, right: own }) => {
    const shares = Object.values(own);
    const members = Object.entries(own).map(([seat, share]) => [`member ${memberOfSeat(seat)}`, share]);
    const mean = shares.length === 0 ? {} : { mean: shares.reduce((a, b) => a + b, 0) / shares.length };
    return { period, shares: { ...Object.fromEntries(members), ...mean } as Record<string, number> };
  });
  const [setBox, width] = useWidth();
  const look = { width: Math.max(0, (width - kBetween) / (width > kNarrow ? 2 : 1)), height, last: 5 };
  return (
    <div class={width > kNarrow ? 'curves' : 'curves narrow'} ref={setBox}>
      <figure class="chart">
        <h3>
          <Explained term="p_bec">p(BEC)</Explained>
        </h3>
        <Lines what="p(BEC) over periods" lines={linesOf(curves.map(({ period, p_bec }) => ({ period, shares: p_bec })))} {...look} />
      </figure>
      <figure class="chart">
        <h3>Share of right answers so far</h3>
        <Lines what="Share of right answers over periods" lines={linesOf(right)} {...look} />
      </figure>
    </div>
  );
}
