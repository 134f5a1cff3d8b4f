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
  label: string; // of the button that opens the dialog: "Message"
  verb?: string; // of the button that sends the command, if it is another one: "Send"
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
  noShow: 'A participant did not show up',
  slow: 'Someone needs more time',
  mistake: 'Started by mistake',
};

const none = (): object => ({});

export function roomActions(room: RoomRow, study: StudyInfo): Action[] {
  const title = roomTitle(room);
  const is = (...stages: RoomRow['stage'][]): boolean => stages.includes(room.stage);
  const isGroup = !room.waiting_list; // the list takes messages and its end only
  const all: (Action & { when: boolean })[] = [
    {
      when: isGroup && is('lobby'),
      command: 'start',
      label: 'Start',
      title: `Start ${lower(title)}`,
      explains: 'The group starts with the people who are in the lobby now. Nobody can join afterwards.',
      fields: [],
      reasons: ['Everyone is here', kReasons.noShow],
      body: none,
      done: `${title} has started.`,
    },
    {
      when: is('running', 'questions'),
      command: 'pause',
      label: 'Pause',
      title: `Pause ${lower(title)}`,
      explains: 'Everyone sees that the group is paused. No input is lost, and time limits stop.',
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
      explains: 'The group continues where it stopped.',
      fields: [],
      reasons: ['The problem is solved', 'Everyone is back'],
      body: none,
      done: `${title} continues.`,
    },
    {
      when: is('running', 'paused'),
      command: 'extend',
      label: 'Extend',
      title: `Give ${lower(title)} more time`,
      explains: 'Extends the time limits that apply now.',
      fields: [{ name: 'seconds', label: 'Seconds', kind: 'number', value: '60', min: 5, max: 3600 }],
      reasons: [kReasons.slow, kReasons.technical],
      body: ({ seconds }) => ({ seconds: Number(seconds) }),
      done: `${title} has more time.`,
    },
    {
      when: !is('ended'),
      command: 'message',
      label: 'Message',
      verb: 'Send',
      title: `Write to ${lower(title)}`,
      explains: 'Everyone in the room sees the text at the top of their page. Do not reveal how the robot decides.',
      fields: [{ name: 'text', label: 'Message', kind: 'text', value: '' }],
      reasons: [kReasons.question, 'Announcement'],
      body: ({ text }) => ({ text }),
      done: 'The message has been sent.',
    },
    {
      when: isGroup && is('lobby', 'running', 'paused'),
      command: 'strategy',
      label: 'Strategy',
      verb: 'Switch',
      title: `Switch the strategy of ${lower(title)}`,
      explains: 'The teacher uses the new strategy from the next component on. The tables record the switch; exclude this group from analyses by strategy.',
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
      reasons: ['The group is not making progress', 'The wrong strategy was set'],
      body: ({ name }) => ({ name }),
      done: `${title} switches its strategy at the next component.`,
    },
    {
      when: !is('ended'),
      command: 'end',
      label: 'End',
      title: `End ${lower(title)}`,
      explains: 'The session ends for everyone in the room, and each person gets a completion code. This cannot be undone.',
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
  const mayChange = isPerson && !isOver && !room.waiting_list;
  const token = /#t=([A-Za-z0-9_-]+)/.exec(seat.link ?? '')?.[1];
  const isOut = seat.dropped === true || seat.presence === 'left' || seat.stage === 'replaced' || seat.stage === 'ended';
  const all: (Action & { when: boolean })[] = [
    {
      when: isPerson && !isOver && seat.presence !== 'empty',
      command: 'message',
      label: 'Message',
      verb: 'Send',
      title: `Write to ${who}`,
      explains: 'Only this person sees the text. Do not reveal how the robot decides.',
      fields: [{ name: 'text', label: 'Message', kind: 'text', value: '' }],
      reasons: [kReasons.question],
      body: ({ text }) => ({ text, seat: seat.seat }),
      done: 'The message has been sent.',
    },
    {
      when: mayChange && isOut,
      command: 'readmit',
      label: 'Re-admit',
      title: `Let ${who} back in`,
      explains: 'The person can open the same link again and rejoins in the next period.',
      fields: [],
      reasons: ['The person is back', kReasons.technical],
      body: () => ({ seat: seat.seat }),
      done: `${who} can come back.`,
    },
    {
      when: mayChange && !isOut && token === undefined,
      command: 'readmit',
      label: 'New link',
      title: `Make a new link for ${who}`,
      explains: 'Links are not stored, so those made before a restart of the server are not shown here. They still work; this makes another one.',
      fields: [],
      reasons: ['The link was lost'],
      body: () => ({ seat: seat.seat }),
      done: `${who} has a new link.`,
    },
    {
      when: mayChange,
      command: 'simulate',
      label: 'Replace by a simulated learner',
      title: `Replace ${who} by a simulated learner`,
      explains: 'A simulated learner takes this seat from now on. If the person is still there, they get a completion code. The tables mark the seat as simulated.',
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
      explains: 'Anyone using this link is disconnected and cannot use it again. This cannot be undone.',
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
