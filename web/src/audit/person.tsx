// A person: what to do first, a word and a bar for every component, and what it rests on.
import type { JSX } from 'preact';
import { useState } from 'preact/hooks';
import type { Legend } from '../shared/board/legend';
import type { Board } from '../shared/board/types';
import { WorldName } from '../shared/play/board_pane';
import { SmallBoard } from '../shared/play/small_board';
import { counted, sentence } from '../shared/texts';
import type { Audit, Judged, Person } from './document';

export const percent = (share: number): string => `${Math.round(100 * share)}\u00a0%`;

interface Props {
  audit: Audit;
  legend: Legend;
  person: Person;
  first: Judged | undefined; // what to see to first
  isOpen: boolean;
}

export function PersonView({ audit, legend, person, first, isOpen }: Props): JSX.Element {
  const [open, setOpen] = useState(isOpen);
  const { title, group, caution, knows, believes_older: older, kind, kinds = {}, components } = person;
  const likely = Object.entries(kinds).filter(([, probability]) => probability >= 0.1);
  const name = ({ component }: Judged): string => audit.components[component - 1]?.name ?? '';
  return (
    <li class="person">
      <h3>
        {title} <small>{group}</small>
      </h3>
      {first && <p class="first">{needText(first, name(first))}</p>}
      {caution && <p>{caution}</p>}
      <ul class="parts">
        {components.map((judged) => (
          <li>
            <Level level={judged.level} enough={audit.enough} isKnown={judged.understanding !== 'not-taught'} />
            <Verdict judged={judged} />
            <span>{sentence(name(judged)).replace(/\.$/, '')}</span>
          </li>
        ))}
      </ul>
      <details open={open} onToggle={(event) => setOpen(event.currentTarget.open)}>
        <summary>Answers and boards</summary>
        {open && (
          <>
            {knows !== null && <p>Knows {percent(knows)} of what was taught.</p>}
            {older !== undefined && <p>Still believes in the robot as it was before the update with probability {percent(older)}.</p>}
            {kind && (
              <p>
                Kind of learner: {kind} ({likely.map(([one, probability]) => `${one} ${percent(probability)}`).join(', ')}).
              </p>
            )}
            {components.filter(({ understanding }) => understanding !== 'not-taught').map((judged) => (
              <Evidence judged={judged} name={name(judged)} audit={audit} legend={legend} />
            ))}
          </>
        )}
      </details>
    </li>
  );
}

function needText({ understanding, misconception, advice }: Judged, name: string): string {
  if (understanding === 'not-taught') return `Teach ${name}.`;
  if (understanding === 'understands' || !misconception) return understanding === 'cannot-tell' ? `Test ${name}.` : sentence(advice ?? '');
  if (understanding === 'cannot-tell') return `Test ${name}. Might think that ${misconception.thinks}.`;
  return `Show that ${misconception.fact}. Probably thinks that ${misconception.thinks}.`;
}

const Verdict = ({ judged: { understanding, verdict } }: { judged: Judged }): JSX.Element => (
  <span class={`verdict ${understanding}`}>
    {understanding === 'understands' && '\u2713 '}
    {verdict}
  </span>
);

// How often all of it is expected to be right: a dot in its interval, on a line from 0 to 100 % with what is enough.
function Level({ level: { mean, low, high }, enough, isKnown }: Pick<Judged, 'level'> & { enough: number; isKnown: boolean }): JSX.Element {
  if (!isKnown) return <span class="level" />;
  const label = `${percent(mean)}, between ${percent(low)} and ${percent(high)}; ${percent(enough)} is enough`;
  return (
    <span class="level" role="img" aria-label={label} title={label}>
      <i class="interval" style={{ left: `${100 * low}%`, width: `${100 * (high - low)}%` }} />
      <i class="enough" style={{ left: `${100 * enough}%` }} />
      <i class="dot" style={{ left: `${100 * mean}%` }} />
    </span>
  );
}

function Evidence({ judged, name, audit, legend }: { judged: Judged; name: string; audit: Audit; legend: Legend }): JSX.Element {
  const { understanding, doubt, correct, tests, periods, misconception, test, advice } = judged;
  const isSure = understanding === 'misconception';
  return (
    <div class="evidence">
      <h4>{sentence(name).replace(/\.$/, '')}</h4>
      <p>
        {correct} of {counted(tests, 'answer')} right in {counted(periods, 'lesson')}. {sentence(doubt ?? '')}
      </p>
      {misconception && (
        <>
          <p>
            {isSure ? 'Probably' : 'Might'} think{isSure && 's'} that {misconception.thinks}; in fact, {misconception.fact}.
          </p>
          {misconception.answers.length > 0 && (
            <ul>
              {misconception.answers.map(({ period, test: number, text }) => (
                <li>
                  Period {period}, test {number}: {text}
                </li>
              ))}
            </ul>
          )}
        </>
      )}
      {advice && <p>Next: {advice}.</p>}
      <div class="boards">
        {isSure && misconception?.show && (
          <Shown audit={audit} legend={legend} board={misconception.show} title={misconception.reason ? `Show: ${misconception.reason}` : 'Show this'} />
        )}
        {test && <Shown audit={audit} legend={legend} board={{ ...test, frames: [test.start] }} title={`${isSure ? 'Then ask' : 'Ask'} what the robot does from here`} />}
      </div>
    </div>
  );
}

function Shown({ audit, legend, board, title }: { audit: Audit; legend: Legend; board: Board; title: string }): JSX.Element {
  const shown = { ...board, domain: audit.domain };
  return (
    <figure>
      <SmallBoard board={shown} legend={legend} path={board} />
      <WorldName board={shown} />
      <figcaption>
        {sentence(title)} {board.start.state}
      </figcaption>
    </figure>
  );
}
