// What the members and the team believed, period by period, as spheres.
import { render, type JSX } from 'preact';
import { useLayoutEffect, useMemo, useRef, useState } from 'preact/hooks';
import { unpack, type Turn } from '../../shared/globe';
import { Globes, GlobesDrawing, useTurn, type Ball } from '../../shared/globes';
import { lazyDetails } from '../../shared/dom';
import { useCalm, usePlayback } from '../../shared/playback';
import type { Beliefs, BeliefTeam, Cell, Table } from '../document';
import { saveButtons } from '../figure_view';
import { tableView } from '../table_view';
import { thinks, typicalOutside } from '../thinks';
import type { Words } from '../words';

interface Props {
  beliefs: Beliefs;
  number: number; // of the figure
  study: string;
  words: Words;
}

export function spheresSection(props: Props): HTMLElement {
  const place = document.createElement('div');
  render(<Spheres {...props} />, place);
  return place;
}

function moment({ mass, components }: BeliefTeam, frame: number): string {
  if (frame === 0) return 'before teaching';
  const component = components[frame - 1];
  return `after period ${frame} of ${mass.length - 1}${component === undefined ? '' : `, component ${component}`}`;
}

const massTable = ({ beliefs, mass, components }: BeliefTeam): Table => ({
  columns: ['period', 'component', ...beliefs.map(({ name }) => name)],
  rows: mass.map((masses, frame): Cell[] => [frame, components[frame - 1] ?? null, ...masses]),
});

const kKinds = new Set(['own', 'common', 'joint']);

// Of the particles outside the policy's region one is put into words.
function ballsOf({ truth, features, regions }: Beliefs, team: BeliefTeam, particles: Ball['points'], frame: number): Ball[] {
  const { count } = team.particles;
  return team.beliefs.map(({ name, kind }, i) => {
    const first = (frame * team.beliefs.length + i) * count;
    const points = particles.slice(first, first + count);
    const at = typicalOutside(points, regions[0]?.outline ?? []);
    const share = team.mass[frame]?.[i] ?? undefined;
    return { name, kind: (kKinds.has(kind) ? kind : 'other') as Ball['kind'], points, share, thinks: at ? { at, lines: thinks(at, truth, features) } : undefined };
  });
}

function Spheres(props: Props): JSX.Element {
  const { beliefs, number } = props;
  const [index, setIndex] = useState(0);
  const [turn, setTurn] = useTurn(beliefs);
  const team = beliefs.teams[index];
  return (
    <figure id="figure-beliefs" aria-labelledby="beliefs-caption">
      <div class="control">
        <label for="sphere-team">Team</label>
        <select id="sphere-team" onChange={(event) => setIndex(event.currentTarget.selectedIndex)}>
          {beliefs.teams.map(({ title, why }) => (
            <option>{why ? `${title}: ${why}` : title}</option>
          ))}
        </select>
      </div>
      {team && <Team key={index} {...props} team={team} turn={turn} onTurn={setTurn} />}
      <figcaption id="beliefs-caption">
        <strong>Figure {number}. Beliefs about the reward, period by period.</strong> Every point of a sphere is a direction of reward weights; dots are particles of
        equal weight, orange those of members, and numbers the share of them within the region (BEC) whose rewards all give the robot{'\u2019'}s policy. Of the
        particles outside, the ringed one is in the middle; below is what somebody who believes in it would think.
      </figcaption>
    </figure>
  );
}

interface TeamProps extends Props {
  team: BeliefTeam;
  turn: Turn;
  onTurn: (turn: Turn) => void;
}

function Team({ beliefs, number, study, words, team, turn, onTurn }: TeamProps): JSX.Element {
  const particles = useMemo(() => unpack(team.particles.data), [team]);
  const { step, last, playing, show, toggle } = usePlayback(team.mass.length - 1, 1, { from: 0, isAuto: false, isAtEnd: true });
  const balls = useMemo(() => ballsOf(beliefs, team, particles, step), [team, step]);
  const shown = { space: beliefs, balls, turn };
  const current = useRef(shown);
  current.current = shown;
  const saves = useRef<HTMLDivElement>(null);
  useLayoutEffect(() => {
    const what = `figure ${number}`;
    const spec = (width: number): string => {
      const place = document.createElement('div');
      render(<GlobesDrawing {...current.current} width={width} hasKeys />, place);
      return place.firstElementChild ? new XMLSerializer().serializeToString(place.firstElementChild) : '';
    };
    const table = massTable(team);
    saves.current?.replaceChildren(
      saveButtons({ file: `${study}-beliefs`, what, spec, table }),
      lazyDetails(`Data of ${what}`, () => tableView(table, `Share of belief in the policy\u2019s region: ${team.title}`, words)),
    );
  }, [team]);
  return (
    <>
      <div class="control">
        <label for="sphere-period">Period</label>
        <input id="sphere-period" type="range" min={0} max={last} value={step} aria-valuetext={moment(team, step)} onInput={(event) => show(event.currentTarget.valueAsNumber)} />
        <output for="sphere-period">{moment(team, step)}</output>
        {!useCalm() && (
          <button type="button" onClick={toggle}>
            {playing ? 'Pause' : 'Play'}
          </button>
        )}
      </div>
      <Globes {...shown} onTurn={onTurn} />
      <div ref={saves} />
    </>
  );
}
