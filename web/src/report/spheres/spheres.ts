// The section's figure: what the members and the team believed, period by period.
import type { Beliefs, BeliefTeam, Cell, Table } from '../document';
import { el, lazyDetails } from '../../shared/dom';
import { saveButtons } from '../figure_view';
import { tableView } from '../table_view';
import { formatFixed, type Words } from '../words';
import type { FigureNumbers } from '../sections/figures';
import { select, slider } from './controls';
import { GlobeView } from './globe_view';
import { playButton } from './play';
import { turnControls } from './turn_controls';

const lastFrame = (team: BeliefTeam): number => team.mass.length - 1;

function moment(team: BeliefTeam, frame: number): string {
  if (frame === 0) return 'before teaching';
  const component = team.components[frame - 1];
  return `after period ${frame} of ${lastFrame(team)}${component === undefined ? '' : `, component ${component}`}`;
}

function massTable(team: BeliefTeam): Table {
  return {
    columns: ['period', 'component', ...team.beliefs.map(({ name }) => name)],
    rows: team.mass.map((masses, frame): Cell[] => [
      frame,
      frame === 0 ? null : (team.components[frame - 1] ?? null),
      ...masses,
    ]),
  };
}

function gist(team: BeliefTeam, frame: number): string {
  const masses = team.beliefs.map(({ name }, i) => `${name} ${formatFixed(team.mass[frame]?.[i], 2)}`);
  return `Belief spheres of ${team.title}, ${moment(team, frame)}. Share of belief in the policy\u2019s region: ${masses.join(', ')}.`;
}

export function spheresFigure(beliefs: Beliefs, numbers: FigureNumbers, study: string, words: Words): HTMLElement | null {
  const first = beliefs.teams[0];
  if (!first) return null;
  const number = numbers.next();
  const what = `figure ${number}`;
  const drawing = el('div', { class: 'drawing globes', 'aria-hidden': 'true' });
  const chart = el('div', { class: 'chart', role: 'img' }, drawing);
  const view = new GlobeView(drawing, beliefs, first);
  const about = el('p', { class: 'about' });
  const data = el('div');
  const tell = (): void => {
    chart.setAttribute('aria-label', gist(view.team, view.frame));
    about.textContent = view.team.why ? `${view.team.title}: ${view.team.why}.` : `${view.team.title}.`;
  };
  const period = slider({
    id: 'sphere-period',
    label: 'Period',
    min: 0,
    max: lastFrame(first),
    value: view.frame,
    say: (frame) => moment(view.team, frame),
    onInput: (frame) => goTo(frame),
  });
  function goTo(frame: number): void {
    view.setFrame(frame);
    tell();
  }
  const makeTables = (): void => {
    const save = saveButtons({
      file: `${study}-beliefs`,
      what,
      spec: (width) => view.spec(width),
      table: massTable(view.team),
    });
    data.replaceChildren(
      save,
      lazyDetails(`Data of ${what}`, () =>
        tableView(massTable(view.team), `Share of belief in the policy\u2019s region: ${view.team.title}`, words),
      ),
    );
  };
  const chooseTeam = (index: number): void => {
    const team = beliefs.teams[index];
    if (!team) return;
    view.show(team);
    period.input.max = String(lastFrame(team));
    period.set(view.frame);
    tell();
    makeTables();
  };
  const play = playButton(period.input, () => {
    period.set(period.input.valueAsNumber);
    goTo(period.input.valueAsNumber);
  });
  if (play) period.row.append(play);
  tell();
  makeTables();
  new ResizeObserver(() => {
    const width = Math.min(drawing.clientWidth, 980);
    if (String(width) !== drawing.dataset.drawn) view.redraw(width);
  }).observe(drawing);
  const captionId = 'beliefs-caption';
  return el(
    'figure',
    { id: 'figure-beliefs', 'aria-labelledby': captionId },
    el(
      'div',
      { class: 'controls' },
      select(
        'sphere-team',
        'Team',
        beliefs.teams.map(({ title }) => title),
        chooseTeam,
      ),
      period.row,
      turnControls(view, beliefs),
    ),
    about,
    chart,
    el(
      'figcaption',
      { id: captionId },
      el('strong', {}, `Figure ${number}. Beliefs about the reward, period by period.`),
      ' Every point of a sphere is a direction of reward weights; dots are particles of equal weight, and knowledge is the share of belief within the region (BEC) whose rewards all give the robot\u2019s policy. Of the particles outside, the ringed one is in the middle; below is what somebody who believes in it would think.',
    ),
    data,
  );
}
