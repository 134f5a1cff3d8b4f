// From a number to a team: a dot of a figure, or the list, opens what that team was shown and how it answered.
import { render } from 'preact';
import { scriptIn } from '../../file/packed';
import { announce, button, el } from '../../shared/dom';
import { Legend } from '../../shared/board/legend';
import type { Study } from '../study';
import { TeamView, titleOf } from '../team/team_view';
import type { Section } from './section';

type TeachAgain = (place: HTMLElement, props: object) => void;

// What teaches a team again is packed into the page, and unpacked when somebody asks for it.
async function teachAgain(): Promise<TeachAgain> {
  const known = window as { kithTeachAgain?: TeachAgain };
  if (!known.kithTeachAgain) {
    const script = el('script', { src: scriptIn('kith-page') });
    await new Promise((resolve) => {
      script.addEventListener('load', resolve);
      document.head.append(script);
    });
  }
  return known.kithTeachAgain ?? ((): void => undefined);
}

export const kOpenTeam = 'kith-open-team'; // an event of the document; its detail is the team's number

export function teamSection(study: Study): Section | null {
  const lessons = study.report.lessons;
  const teams = [...(lessons?.teams ?? [])].sort((a, b) => a.team - b.team);
  const first = lessons?.teams[0];
  if (!lessons || !first) return null;
  const legend = new Legend(lessons.domain);
  const { again } = study.report;
  const againPlace = el('div');
  const place = el('div', { class: 'team' });
  const select = el(
    'select',
    { id: 'team-choice' },
    ...teams.map((team) => el('option', { value: team.team }, titleOf(team, study.words))),
  );
  const show = (number: number): void => {
    const team = teams.find((one) => one.team === number);
    if (!team) return;
    select.value = String(number);
    render(<TeamView lessons={lessons} legend={legend} team={team} words={study.words} />, place);
    againPlace.replaceChildren();
    if (!again?.teams[String(number)]) return;
    const taught = el('div');
    const begin = button('Teach this team again', () => {
      begin.remove();
      void teachAgain().then((teach) => teach(taught, { again, lessons, team: number }));
    });
    againPlace.replaceChildren(begin, taught);
  };
  const step = (by: number): void => {
    const at = teams.findIndex(({ team }) => team === Number(select.value)) + by;
    const next = teams[(at + teams.length) % teams.length];
    if (next) show(next.team);
  };
  select.addEventListener('change', () => show(Number(select.value)));
  document.addEventListener(kOpenTeam, (event) => {
    const number = Number((event as CustomEvent<number>).detail);
    if (!teams.some(({ team }) => team === number)) return announce(`The lessons of team ${number} are not in this page`);
    show(number);
    document.getElementById('team')?.scrollIntoView();
    select.focus({ preventScroll: true });
  });
  show(first.team);
  return {
    id: 'team',
    title: 'One team',
    content: [
      el(
        'div',
        { class: 'controls' },
        el(
          'div',
          { class: 'control' },
          el('label', { for: 'team-choice' }, 'Team'),
          select,
          button('Previous', () => step(-1), { 'aria-label': 'Previous team' }),
          button('Next', () => step(1), { 'aria-label': 'Next team' }),
        ),
      ),
      againPlace,
      place,
    ],
  };
}
