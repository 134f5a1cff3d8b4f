// What a facilitator can do with a room or a seat, what each needs to know, and when it is possible.
import type { CommandName, RoomRow, SeatRow, StudyInfo } from '../protocol';
import { roomTitle, seatTitle } from '../words';

export interface Field {
  name: string;
  label: string;
  kind: 'number' | 'text' | 'select';
  value: string;
  options?: { value: string; label: string }[];
  min?: number;
  max?: number;
}

// One command, ready to be asked about.
export interface Action {
  command: CommandName;
  label: string; // of the button: "Pause"
  title: string; // of the dialog: "Pause room A7"
  explains: string; // what happens to the participants
  fields: Field[];
  reasons: string[]; // suggestions
  isDangerous?: boolean;
  body: (values: Record<string, string>) => object; // besides room and reason
  done: string; // "Room A7 is paused."
}

const kReasons = {
  technical: 'Technical problem',
  question: 'A participant has a question',
  noShow: 'A person did not come',
  slow: 'Somebody needs more time',
  mistake: 'Started by mistake',
};

const none = (): object => ({});

export function roomActions(room: RoomRow, study: StudyInfo): Action[] {
  const title = roomTitle(room);
  const is = (...stages: RoomRow['stage'][]): boolean => stages.includes(room.stage);
  const all: (Action & { when: boolean })[] = [
    {
      when: is('lobby'),
      command: 'start',
      label: 'Start',
      title: `Start ${lower(title)}`,
      explains: 'The group begins with the people who are in the lobby now. Nobody can join after the start.',
      fields: [],
      reasons: ['Everybody is here', kReasons.noShow],
      body: none,
      done: `${title} has started.`,
    },
    {
      when: is('running', 'questions'),
      command: 'pause',
      label: 'Pause',
      title: `Pause ${lower(title)}`,
      explains: 'Everybody sees that the group is paused. Nothing that was entered is lost, and time limits stop.',
      fields: [],
      reasons: [kReasons.technical, kReasons.question],
      body: none,
      done: `${title} is paused.`,
    },
    {
      when: is('paused'),
      command: 'resume',
      label: 'Resume',
      title: `Resume ${lower(title)}`,
      explains: 'The group continues where it was.',
      fields: [],
      reasons: ['The problem is solved', 'Everybody is back'],
      body: none,
      done: `${title} continues.`,
    },
    {
      when: is('running', 'paused'),
      command: 'extend',
      label: 'Extend',
      title: `Give ${lower(title)} more time`,
      explains: 'Adds to the time limits that are running now.',
      fields: [{ name: 'seconds', label: 'Seconds', kind: 'number', value: '60', min: 5, max: 3600 }],
      reasons: [kReasons.slow, kReasons.technical],
      body: ({ seconds }) => ({ seconds: Number(seconds) }),
      done: `${title} has more time.`,
    },
    {
      when: !is('ended'),
      command: 'message',
      label: 'Message',
      title: `Write to ${lower(title)}`,
      explains: 'Everybody in the room sees the text at the top of their page. Do not tell them how the robot decides.',
      fields: [{ name: 'text', label: 'Message', kind: 'text', value: '' }],
      reasons: [kReasons.question, 'Announcement'],
      body: ({ text }) => ({ text }),
      done: 'The message has been sent.',
    },
    {
      when: is('lobby', 'running', 'paused'),
      command: 'strategy',
      label: 'Strategy',
      title: `Switch the strategy of ${lower(title)}`,
      explains: 'The teacher uses the new strategy from the next component on. Tables contain the switch; an analysis by strategy should leave this group out.',
      fields: [
        {
          name: 'name',
          label: 'Strategy',
          kind: 'select',
          value: study.strategies.find(({ name }) => name !== room.strategy)?.name ?? room.strategy,
          options: study.strategies
            .filter(({ name }) => name !== room.strategy)
            .map(({ name, description }) => ({ value: name, label: `${name}: ${description}` })),
        },
      ],
      reasons: ['The group does not make progress', 'Wrong strategy was set'],
      body: ({ name }) => ({ name }),
      done: `${title} switches its strategy at the next component.`,
    },
    {
      when: !is('ended'),
      command: 'end',
      label: 'End',
      title: `End ${lower(title)}`,
      explains: 'The session ends for everybody in the room; each gets a completion code. This cannot be undone.',
      fields: [],
      reasons: [kReasons.technical, 'Out of time', kReasons.mistake],
      isDangerous: true,
      body: none,
      done: `${title} has ended.`,
    },
  ];
  return all.filter(({ when }) => when);
}

export function seatActions(room: RoomRow, seat: SeatRow, study: StudyInfo): Action[] {
  const who = seatTitle(seat);
  const isPerson = seat.kind === 'person';
  const isOver = room.stage === 'ended';
  const token = /#t=([A-Za-z0-9_-]+)/.exec(seat.link ?? '')?.[1];
  const all: (Action & { when: boolean })[] = [
    {
      when: isPerson && !isOver && seat.presence !== 'empty',
      command: 'message',
      label: 'Message',
      title: `Write to ${who}`,
      explains: 'Only this person sees the text. Do not tell them how the robot decides.',
      fields: [{ name: 'text', label: 'Message', kind: 'text', value: '' }],
      reasons: [kReasons.question],
      body: ({ text }) => ({ text, seat: seat.seat }),
      done: 'The message has been sent.',
    },
    {
      when: isPerson && !isOver && (seat.dropped === true || seat.presence === 'left' || seat.stage === 'replaced' || seat.stage === 'ended'),
      command: 'readmit',
      label: 'Re-admit',
      title: `Let ${who} back in`,
      explains: 'The person can open the same link again and takes part from the next period on.',
      fields: [],
      reasons: ['The person is back', kReasons.technical],
      body: () => ({ seat: seat.seat }),
      done: `${who} can come back.`,
    },
    {
      when: isPerson && !isOver,
      command: 'simulate',
      label: 'Replace by a simulated learner',
      title: `Replace ${who} by a simulated learner`,
      explains: 'A program takes this seat from now on. The person, if still there, gets a completion code. Tables mark the seat as simulated.',
      fields: [
        {
          name: 'type',
          label: 'Learner type',
          kind: 'select',
          value: seat.type ?? study.types[0]?.letter ?? '',
          options: study.types.map(({ letter, label }) => ({ value: letter, label: `${letter}: ${label}` })),
        },
      ],
      reasons: [kReasons.noShow, 'The person left'],
      isDangerous: true,
      body: ({ type }) => ({ seat: seat.seat, type }),
      done: `${who} is replaced by a simulated learner.`,
    },
    {
      when: token !== undefined,
      command: 'link-revoke',
      label: 'Revoke link',
      title: `Revoke the link of ${who}`,
      explains: 'Whoever uses this link is disconnected and cannot come back with it. This cannot be undone.',
      fields: [],
      reasons: ['The link was sent to the wrong person', 'The link was passed on'],
      isDangerous: true,
      body: () => ({ token }),
      done: 'The link is revoked.',
    },
  ];
  return all.filter(({ when }) => when);
}

export const lower = (text: string): string => text.charAt(0).toLowerCase() + text.slice(1);
