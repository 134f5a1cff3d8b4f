// Belief spheres: one per member, and the common and joint beliefs.
import type { JSX } from 'preact';
import { useMemo } from 'preact/hooks';
import { unpack } from '../../shared/globe';
import { Globes, useTurn, type Space } from '../../shared/globes';
import type { RoomDetail } from '../protocol';
import { capitalised } from '../../shared/texts';
import { beliefKind, memberOf } from './beliefs';

interface SpheresProps {
  detail: RoomDetail;
  height: number; // px that the drawing may take
  nameOf: (belief: string) => string;
  marked: number | null; // member
  onMark: (member: number | null) => void;
}

export function Spheres({ detail, height, nameOf, marked, onMark }: SpheresProps): JSX.Element {
  const { truth, beliefs } = detail;
  const space: Space = useMemo(
    () => ({
      features: truth?.features ?? [],
      truth: truth?.weights ?? [0, 0, 1],
      regions: [
        { label: 'BEC region', outline: truth?.bec ?? [] },
        { label: 'prior', outline: truth?.prior ?? [] },
      ],
    }),
    [JSON.stringify(truth)],
  );
  const [turn, setTurn] = useTurn(space);
  const points = useMemo(() => beliefs.map((belief) => unpack(belief.points)), [beliefs]);
  const latest = detail.curves[detail.curves.length - 1]?.p_bec ?? {};
  if (!truth || truth.weights.length !== 3 || beliefs.length === 0) return <NoSpheres detail={detail} nameOf={nameOf} />;
  const balls = beliefs.map(({ name }, i) => ({ name: nameOf(name), kind: beliefKind(name), points: points[i] ?? [], share: latest[name] }));
  const memberBy = (ball: string | null): number | null => memberOf(beliefs.find(({ name }) => nameOf(name) === ball)?.name ?? '');
  const markedBall = balls.find(({ name }) => marked !== null && memberBy(name) === marked);
  return (
    <div class="spheres">
      <Globes space={space} balls={balls} turn={turn} onTurn={setTurn} height={height} marked={markedBall?.name ?? null} onMark={(name) => onMark(memberBy(name))} />
    </div>
  );
}

// With another number of features there is no sphere to draw.
function NoSpheres({ detail, nameOf }: { detail: RoomDetail; nameOf: (belief: string) => string }): JSX.Element {
  const latest = Object.entries(detail.curves[detail.curves.length - 1]?.p_bec ?? {});
  const features = detail.truth?.weights.length ?? 0;
  return (
    <div class="spheres">
      <h3>Beliefs</h3>
      <p class="hint">
        {features > 0 && features !== 3
          ? `Spheres can be drawn for three features; this domain has ${features}. The bars are the share of each belief in the BEC region.`
          : 'There are no beliefs to draw yet.'}
      </p>
      <ul class="bars">
        {latest.map(([name, share]) => (
          <li>
            <span>{capitalised(nameOf(name))}</span>
            <meter min={0} max={1} value={share} aria-label={`p(BEC), ${nameOf(name)}`} />
            <b>{share.toFixed(2)}</b>
          </li>
        ))}
      </ul>
    </div>
  );
}
