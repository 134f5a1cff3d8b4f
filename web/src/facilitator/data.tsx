// Whether the data are safe, how to get them out, and what is stored.
import type { JSX } from 'preact';
import { useContext, useState } from 'preact/hooks';
import { duration } from '../shared/duration';
import { clockText, useNow } from './clock';
import { isObject, type FacilitatorView, type Integrity, type StudyInfo } from './protocol';
import { ApiContext } from './setup/link_box';
import { Explained } from './tip';
import { kStages, roomTitle } from './words';

const kLowSpace = { banner: 200, refuse: 50 }; // MB

// What is wrong with the data, in the order of importance.
export function problemsOf({ unsaved, last_commit_ms, free_mb, problems }: Integrity, now: number): string[] {
  const found = [...problems];
  if (free_mb < kLowSpace.refuse) {
    found.push(`Only ${Math.round(free_mb)} MB of disk space are left. No new session can start; answers are still stored. Free some space now.`);
  } else if (free_mb < kLowSpace.banner) {
    found.push(`Only ${Math.round(free_mb)} MB of disk space are left. Below ${kLowSpace.refuse} MB no new session can start.`);
  }
  if (unsaved > 0 && now - last_commit_ms > 5000) {
    found.push(`${unsaved} events have been waiting to be written for ${duration(now - last_commit_ms)}. Check the disk.`);
  }
  return found;
}

export function Data({ view }: { view: FacilitatorView }): JSX.Element {
  return (
    <div class="page data">
      <Counters integrity={view.integrity} isFacilitator={view.role === 'facilitator'} />
      {view.role === 'facilitator' && <Export view={view} />}
      <Stored stores={view.study.stores} />
    </div>
  );
}

function Counters({ integrity, isFacilitator }: { integrity: Integrity; isFacilitator: boolean }): JSX.Element {
  const now = useNow();
  const problems = problemsOf(integrity, now);
  const { events, stored, unsaved, free_mb, last_commit_ms } = integrity;
  return (
    <section aria-labelledby="integrity-title">
      <h2 id="integrity-title">Integrity</h2>
      {problems.length === 0 ? (
        <p class="good">
          <svg width="16" height="16" viewBox="-8 -8 16 16" aria-hidden="true">
            <path d="M-5 .5-1.5 4 5.5 -4" />
          </svg>
          Everything that was acknowledged is on disk.
        </p>
      ) : (
        <ul class="problems">
          {problems.map((text) => (
            <li>{text}</li>
          ))}
        </ul>
      )}
      <dl class="counters">
        <Counter term="Events" value={events.toLocaleString('en')} />
        <Counter term="Stored" value={stored.toLocaleString('en')} />
        <Counter term={<Explained term="unsaved">Unsaved</Explained>} value={String(unsaved)} />
        <Counter term="Free space" value={free_mb >= 10_000 ? `${(free_mb / 1000).toFixed(0)} GB` : `${Math.round(free_mb)} MB`} />
        <Counter term="Last write" value={last_commit_ms > 0 ? clockText(last_commit_ms) : 'none yet'} />
      </dl>
      {isFacilitator && <CheckNow />}
    </section>
  );
}

function Counter({ term, value }: { term: JSX.Element | string; value: string }): JSX.Element {
  return (
    <div>
      <dt>{term}</dt>
      <dd>{value}</dd>
    </div>
  );
}

// Counters as they are now: views are sent only when something changes.
function CheckNow(): JSX.Element {
  const api = useContext(ApiContext);
  const [said, setSaid] = useState('');
  const check = async (): Promise<void> => {
    setSaid('Checking\u2026');
    try {
      const found = await api?.integrity();
      const problems = isObject(found) && Array.isArray(found.problems) ? found.problems.map(String) : [];
      setSaid(problems.length === 0 ? 'Checked: no problem found.' : `Checked: ${problems.join('; ')}`);
    } catch (error) {
      setSaid(`The check failed: ${error instanceof Error ? error.message : String(error)}.`);
    }
  };
  return (
    <p class="with-status">
      <button type="button" onClick={check}>
        Check now
      </button>{' '}
      <span role="status">{said}</span>
    </p>
  );
}

function Export({ view }: { view: FacilitatorView }): JSX.Element {
  const api = useContext(ApiContext);
  const [room, setRoom] = useState('');
  const [said, setSaid] = useState('');
  const save = async (): Promise<void> => {
    setSaid('Exporting\u2026');
    try {
      const name = await api?.export(room === '' ? null : room);
      setSaid(`Saved as ${name}.`);
    } catch (error) {
      setSaid(`The export failed: ${error instanceof Error ? error.message : String(error)}.`);
    }
  };
  return (
    <section aria-labelledby="export-title">
      <h2 id="export-title">Export</h2>
      <p>
        Tables of sessions, participants, periods, tests with paths and times, key presses, beliefs and events, with a
        codebook and checksums. Names and free text are left out. You can export at any time; running sessions are exported
        as they are now.
      </p>
      <div class="filters">
        <label for="export-room">Rooms</label>
        <select id="export-room" value={room} onChange={(event) => setRoom(event.currentTarget.value)}>
          <option value="">all rooms</option>
          {view.rooms.map((one) => (
            <option value={one.id}>{`${roomTitle(one)} (${kStages[one.stage].toLowerCase()})`}</option>
          ))}
        </select>
        <button type="button" class="primary" onClick={save}>
          Export
        </button>
        <span role="status">{said}</span>
      </div>
      <p class="hint">In a terminal, <code>kith session export</code> writes the same tables, with names if you ask for them.</p>
    </section>
  );
}

const storedOf = ({ names, text, questions, query, screening, discussion }: StudyInfo['stores']): [string, string][] => [
  ['Consent', 'which version was accepted, and when; of those who decline, only their number'],
  ['Answers', 'the path, the keys with their times, the time taken, right or wrong, regret'],
  ['Lessons', 'what was shown and why, and a checksum of the beliefs, so that a session can be recomputed and compared'],
  ['Presence', 'when someone was connected, away or back'],
  ...(screening ? [['Screening', 'the answers before the group begins'] satisfies [string, string]] : []),
  ...(discussion ? [['Discussions', 'what each person chose after seeing the answers of the group'] satisfies [string, string]] : []),
  ...(questions ? [['Questions', `the answers at the end${text ? ', some in people\u2019s own words' : ''}`] satisfies [string, string]] : []),
  ...(query.length > 0 ? [['Recruitment parameters', `of the join link: ${query.join(', ')}`] satisfies [string, string]] : []),
  ...(names ? [['Names', 'what people enter'] satisfies [string, string]] : []),
  ['Controls', 'everything that a facilitator does on this page, with the reason'],
  ['Not stored', ['network addresses', 'browser names', ...(names ? [] : ['names']), ...(query.length > 0 ? [] : ['parameters of the join link']), 'links (only a hash of each)'].join(', ')],
  ['Erasing', 'kith session redact erases names and people\u2019s own words'],
];

function Stored({ stores }: { stores: StudyInfo['stores'] }): JSX.Element {
  return (
    <section aria-labelledby="stored-title">
      <h2 id="stored-title">What is stored</h2>
      <dl class="facts">
        {storedOf(stores).map(([what, text]) => (
          <>
            <dt>{what}</dt>
            <dd>{text}</dd>
          </>
        ))}
      </dl>
    </section>
  );
}
