// Before a session: the study, rooms to make, links to hand out, and a rehearsal.
import type { JSX } from 'preact';
import type { FacilitatorView, StudyInfo } from '../protocol';
import { Explained } from '../tip';
import { limitName, policyText } from '../words';
import { LinkBox } from './link_box';
import { MakeRooms } from './make_rooms';
import { RoomLinks } from './room_links';

interface SetupProps {
  view: FacilitatorView;
  mayAct: boolean;
  send: (command: string, body: object) => Promise<void>;
}

export function Setup({ view, mayAct, send }: SetupProps): JSX.Element {
  const { study, links } = view;
  return (
    <div class="page setup">
      <StudyFacts study={study} />
      {mayAct && (
        <section aria-labelledby="make-title">
          <h2 id="make-title">Make rooms</h2>
          <MakeRooms study={study} send={send} />
        </section>
      )}
      {links && (
        <section aria-labelledby="links-title">
          <h2 id="links-title">Links</h2>
          <p class="hint">
            Everyone who opens the join link gets the next free seat. To assign people to seats, give each of them the link of
            their seat, listed below. Anyone with the facilitator link can use all controls on this page.
          </p>
          <div class="links">
            <div>
              {links.join && <LinkBox label="Join link" link={links.join} withCode />}
              {links.code && (
                <p>
                  Code for the start page: <b class="code">{links.code}</b>
                </p>
              )}
            </div>
            <div>
              {links.observer && <LinkBox label="Observer link (no names, no controls)" link={links.observer} />}
              {links.facilitator && <LinkBox label="Facilitator link (keep it to yourself)" link={links.facilitator} />}
              {(!links.observer || !links.facilitator) && (
                <p class="hint">Only hashes of links are stored. kith serve prints new links after a restart.</p>
              )}
            </div>
          </div>
          <RoomLinks rooms={view.rooms} />
        </section>
      )}
      <Rehearsal study={study} />
    </div>
  );
}

function StudyFacts({ study }: { study: StudyInfo }): JSX.Element {
  const limits = Object.entries(study.time).filter(([, value]) => value > 0);
  return (
    <section aria-labelledby="study-title">
      <h2 id="study-title">{study.title}</h2>
      <dl class="facts">
        <dt>Study</dt>
        <dd>{study.id}</dd>
        <dt>Domain</dt>
        <dd>{study.domain}</dd>
        <dt>Strategies</dt>
        <dd>
          <ul class="plain">
            {study.strategies.map(({ name, description }) => (
              <li>
                <b>{name}</b>
                {description && `: ${description}`}
              </li>
            ))}
          </ul>
        </dd>
        {study.compositions && study.compositions.length > 0 && <dt>Compositions</dt>}
        {study.compositions && study.compositions.length > 0 && <dd>{study.compositions.join(', ')}</dd>}
        <dt>Learner types</dt>
        <dd>{study.types.map(({ letter, label }) => `${letter}: ${label}`).join(', ')}</dd>
        <dt>If someone is away</dt>
        <dd>
          {policyText(study.dropout)} (<Explained term="grace">grace period</Explained> {secondsText(study.grace_s)})
        </dd>
        <dt>Time limits</dt>
        <dd>{limits.length === 0 ? 'none' : limits.map(([name, value]) => limitText(name, value)).join(', ')}</dd>
      </dl>
    </section>
  );
}

const secondsText = (seconds: number): string => (seconds % 60 === 0 ? `${seconds / 60} min` : `${seconds} s`);

const limitText = (name: string, value: number): string =>
  `${limitName(name)} ${name === 'max_minutes' ? `${value} min` : secondsText(value)}`;

function Rehearsal({ study }: { study: StudyInfo }): JSX.Element {
  return (
    <section aria-labelledby="rehearsal-title">
      <h2 id="rehearsal-title">Rehearsal</h2>
      <p>
        Before the first participants arrive, run the whole study with simulated participants. They connect as browsers do,
        so this tests the server, the network settings and your study file. Run this in a terminal, with the name of your file:
      </p>
      <pre tabIndex={0}>{`kith serve ${study.id === 'demo' ? '--demo' : `${study.id}.toml`} --rehearse 3`}</pre>
      <p>
        This creates three groups of simulated participants and prints a summary: periods, times, and whether anything was
        lost. Their results go into a separate folder. To watch a group of{' '}
        <Explained term="simulated">simulated learners</Explained> on this page, create a room above and set all its seats to
        simulated.
      </p>
    </section>
  );
}
