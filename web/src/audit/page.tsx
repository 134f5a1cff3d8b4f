// Who needs what first, a person after the other; the components, of many people first; and how to read it.
import type { JSX } from 'preact';
import { useMemo } from 'preact/hooks';
import { Patterns } from '../shared/board/glyphs';
import { Legend } from '../shared/board/legend';
import { counted } from '../shared/texts';
import { Licences, ThemeToggle } from '../shared/edges';
import type { Audit, Judged, Person } from './document';
import { percent, PersonView } from './person';

const kUrgent = ['misconception', 'cannot-tell', 'not-taught', 'understands'] as const;
const kOpen = 10; // so many of those who need something are opened

// How soon something has to be done about it.
const urgency = ({ understanding, level }: Judged): number => kUrgent.indexOf(understanding) + level.mean / 2;
const firstNeed = ({ components }: Person): Judged | undefined => [...components].sort((a, b) => urgency(a) - urgency(b))[0];

export function Page({ audit }: { audit: Audit }): JSX.Element {
  const { people, name, program } = audit;
  const legend = useMemo(() => new Legend(audit.domain), [audit]);
  const order = people
    .map((person) => ({ person, first: firstNeed(person) }))
    .sort((a, b) => (a.first ? urgency(a.first) : 4) - (b.first ? urgency(b.first) : 4));
  return (
    <>
      <Patterns surfaces={legend.surfaces} />
      <header class="masthead">
        <p class="kicker">
          {name}: {counted(people.length, 'person', 'people')}, judged by their answers
        </p>
        <ThemeToggle />
      </header>
      <h1>Who understands what</h1>
      <main id="main" tabIndex={-1}>
        {people.length > kOpen && <Components audit={audit} />}
        <section id="people">
          <h2>Who needs what first</h2>
          <ol>
            {order.map(({ person, first }, i) => (
              <PersonView audit={audit} legend={legend} person={person} first={first} isOpen={i < kOpen && first?.understanding === 'misconception'} />
            ))}
          </ol>
        </section>
        {people.length <= kOpen && <Components audit={audit} />}
        <Method audit={audit} />
        <section id="notices">
          <h2>About this page</h2>
          <p>Made by {program}. It needs no network.</p>
          <Licences />
        </section>
      </main>
    </>
  );
}

function Table({ name, heads, rows }: { name: string; heads: string[]; rows: (string | number)[][] }): JSX.Element {
  return (
    <div class="scroll" tabIndex={0} role="region" aria-label={name}>
      <table>
        <thead>
          <tr>
            {heads.map((head) => (
              <th scope="col">{head}</th>
            ))}
          </tr>
        </thead>
        <tbody>
          {rows.map((row) => (
            <tr>
              {row.map((cell, i) => (i === 0 ? <th scope="row">{cell}</th> : <td class={typeof cell === 'number' ? 'number' : ''}>{cell}</td>))}
            </tr>
          ))}
        </tbody>
      </table>
    </div>
  );
}

function Components({ audit: { components, misconceptions, says, groups } }: { audit: Audit }): JSX.Element {
  return (
    <section id="components">
      <h2>By component</h2>
      <Table
        name="By component"
        heads={['Component', 'Understand', 'Misconception', 'Cannot tell', 'Not taught']}
        rows={components.map((one) => [one.name, one.understand, one.misconception, one.cannot_tell, one.not_taught])}
      />
      {misconceptions.length === 0 ? (
        <p>Nobody shows a misconception.</p>
      ) : (
        <Table
          name="Misconceptions"
          heads={['Think that', 'In fact', 'People']}
          rows={misconceptions.map(({ thinks, fact, people }) => [thinks[0] ?? '', fact, people])}
        />
      )}
      <p>{says}</p>
      {groups.length > 1 && (
        <details>
          <summary>Group by group</summary>
          <Table name="Group by group" heads={['Group', 'Answers']} rows={groups.map(({ group, says: text }) => [group, text])} />
        </details>
      )}
    </section>
  );
}

function Method({ audit: { enough, sure, coverage, forgetting } }: { audit: Audit }): JSX.Element {
  return (
    <section id="method">
      <h2>How to read this</h2>
      <p>
        A person understands a component if, asked at any time, they would predict the robot rightly on all of it at least {percent(enough)} of the time. The page
        says so only if that is at least {percent(sure)} certain. A misconception is named if the person would more likely than not go by it in the next test. The dot
        is how often all of a component is expected to be right, the bar its {percent(coverage)} interval, the line what is enough.
      </p>
      <p>
        The answers are compared with what the model of how people learn expects. p is the probability of a number of right answers at least as far from that: where
        it is small, trust the answers more than the model. Somebody whose answers the model does not explain is judged by the number of right answers alone.
      </p>
      <p>Only lessons and answers were used. The times until the next test assume that people forget at a rate of {forgetting} radians per period (--forgetting).</p>
    </section>
  );
}
