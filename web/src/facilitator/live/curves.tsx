// Two small charts over periods: p(BEC) of each belief, and the share of right answers so far.
import type { ComponentChildren, JSX } from 'preact';
import type { RoomDetail } from '../protocol';
import { Explained } from '../tip';
import { beliefKind, memberOf } from './beliefs';
import { useWidth } from '../../shared/width';

const kBetween = 14; // px between the charts
const kNarrow = 560; // px below which the charts are under each other
const kBox = { left: 30, right: 10, top: 8, bottom: 20 };

interface Series {
  name: string;
  kind: string;
  member: number | null;
  points: { period: number; share: number }[];
}

type Scale = (period: number, share: number) => { x: number; y: number };

function seriesOf(rows: { period: number; shares: Record<string, number> }[], kindOf: (name: string) => string): Series[] {
  const names = [...new Set(rows.flatMap(({ shares }) => Object.keys(shares)))];
  return names.map((name) => ({
    name,
    kind: kindOf(name),
    member: memberOf(name),
    points: rows.flatMap(({ period, shares }) => {
      const share = shares[name];
      return share === undefined ? [] : [{ period, share }];
    }),
  }));
}

interface CurvesProps {
  detail: RoomDetail;
  height: number; // px of a chart
  marked: number | null;
  nameOf: (belief: string) => string;
  memberOfSeat: (seat: string) => number;
}

export function Curves({ detail, height, marked, nameOf, memberOfSeat }: CurvesProps): JSX.Element {
  const periods = detail.curves.map(({ period }) => period);
  const beliefs = seriesOf(
    detail.curves.map(({ period, p_bec }) => ({ period, shares: p_bec })),
    beliefKind,
  );
  const seats = seriesOf(
    detail.curves.map(({ period, right }) => ({
      period,
      shares: Object.fromEntries(Object.entries(right).map(([seat, share]) => [`member ${memberOfSeat(seat)}`, share])),
    })),
    () => 'own',
  );
  const mean: Series = {
    name: 'mean',
    kind: 'mean',
    member: null,
    points: detail.curves.flatMap(({ period, right }) => {
      const shares = Object.values(right);
      return shares.length === 0 ? [] : [{ period, share: shares.reduce((a, b) => a + b, 0) / shares.length }];
    }),
  };
  const [setBox, width] = useWidth();
  const look = { width: (width - kBetween) / (width > kNarrow ? 2 : 1), height, periods, marked, nameOf };
  return (
    <div class={width > kNarrow ? 'curves' : 'curves narrow'} ref={setBox}>
      <Chart title={<Explained term="p_bec">p(BEC)</Explained>} what="p(BEC)" series={beliefs} {...look}>
        <Key kind="own" text="member" />
        {beliefs.some(({ kind }) => kind === 'common') && <Key kind="common" text="common" />}
        {beliefs.some(({ kind }) => kind === 'joint') && <Key kind="joint" text="joint" />}
      </Chart>
      <Chart title="Share of right answers so far" what="Share of right answers so far" series={[...seats, mean]} {...look}>
        <Key kind="own" text="member" />
        <Key kind="mean" text="mean" />
      </Chart>
    </div>
  );
}

function Key({ kind, text }: { kind: string; text: string }): JSX.Element {
  return (
    <span class="line-key">
      <svg width="20" height="8" aria-hidden="true">
        <g class={`curve ${kind}`}>
          <path class="line" d="M1 4H19" />
        </g>
      </svg>
      {text}
    </span>
  );
}

interface ChartProps {
  title: ComponentChildren;
  what: string;
  series: Series[];
  width: number;
  height: number;
  periods: number[];
  marked: number | null;
  nameOf: (belief: string) => string;
  children: ComponentChildren;
}

function Chart({ title, what, series, width, height, periods, marked, nameOf, children }: ChartProps): JSX.Element {
  const { left, right, top, bottom } = kBox;
  const [first, last] = [Math.min(...periods, 0), Math.max(...periods, 5)];
  const at: Scale = (period, share) => ({
    x: left + ((period - first) / (last - first)) * (width - left - right),
    y: top + (1 - share) * (height - top - bottom),
  });
  const every = Math.ceil((last - first) / 10);
  const ticks = Array.from({ length: last - first + 1 }, (_, i) => first + i).filter((period) => (period - first) % every === 0);
  const ends = series
    .flatMap((one) => {
      const end = one.points[one.points.length - 1];
      return end ? [`${nameOf(one.name)} ${end.share.toFixed(2)}`] : [];
    })
    .join(', ');
  return (
    <figure class="chart">
      <figcaption>
        <h3>{title}</h3>
        {children}
      </figcaption>
      <svg width={Math.max(0, width)} height={height} role="img" aria-label={`${what} over periods. Last: ${ends || 'nothing yet'}.`}>
        {[0, 0.5, 1].map((share) => (
          <g>
            <path class="rule" d={`M${left} ${at(first, share).y}H${width - right}`} />
            <text class="tick" x={left - 5} y={at(first, share).y} text-anchor="end" dominant-baseline="central">
              {share}
            </text>
          </g>
        ))}
        {ticks.map((period) => (
          <text class="tick" x={at(period, 0).x} y={height - 6} text-anchor="middle">
            {period}
          </text>
        ))}
        {series.filter(({ points }) => points.length > 0).sort((a, b) => order(a, marked) - order(b, marked)).map((one) => (
          <Curve series={one} at={at} name={nameOf(one.name)} isMarked={marked !== null && one.member === marked} />
        ))}
      </svg>
    </figure>
  );
}

const order = (series: Series, marked: number | null): number =>
  series.member !== null && series.member === marked ? 3 : series.kind === 'own' ? 0 : 1;

function Curve({ series, at, name, isMarked }: { series: Series; at: Scale; name: string; isMarked: boolean }): JSX.Element {
  const placed = series.points.map(({ period, share }) => ({ ...at(period, share), period, share }));
  const line = placed.map(({ x, y }) => `${x.toFixed(1)} ${y.toFixed(1)}`).join('L');
  return (
    <g class={`curve ${series.kind}${isMarked ? ' marked' : ''}`}>
      <path class="line" d={`M${line}`} />
      {placed.map(({ x, y, period, share }) => (
        <circle cx={x} cy={y} r={2.4} data-tip={`${name}, period ${period}: ${share.toFixed(2)}`} />
      ))}
    </g>
  );
}
