// Names of what the page shows, and what its terms mean.
import type { Stage } from '../live/protocol';
import { capitalised } from '../shared/texts';
import type { Presence, RoomRow, RoomStage, SeatRow, StudyInfo } from './protocol';

export const kStages: Record<RoomStage, string> = {
  lobby: 'Lobby',
  running: 'Running',
  paused: 'Paused',
  questions: 'Questions',
  ended: 'Ended',
};

export const kPresence: Record<Presence, string> = {
  here: 'connected',
  away: 'away',
  left: 'left',
  empty: 'nobody yet',
};

// The stages of a person: what they do in it; where the group does, what the group does and what its limit is of.
interface StageWords {
  doing: string;
  phase?: string;
  limit?: string;
}
const kPersonStages: Record<Stage, StageWords> = {
  consent: { doing: 'reading the consent form' },
  check: { doing: 'checking the keyboard' },
  screening: { doing: 'screening tests' },
  lobby: { doing: 'waiting in the lobby', phase: 'Lobby' },
  watch: { doing: 'watching', phase: 'Demonstrations', limit: 'demonstrations of a period' },
  predict: { doing: 'answering', phase: 'Tests', limit: 'tests of a period' },
  discuss: { doing: 'comparing predictions', phase: 'Discussion', limit: 'discussion of a period' },
  wait: { doing: 'waiting for the others' },
  feedback: { doing: 'reading feedback', phase: 'Feedback', limit: 'feedback' },
  exam: { doing: 'being examined' },
  questions: { doing: 'answering questions', phase: 'Questions' },
  debrief: { doing: 'finished' },
  declined: { doing: 'declined to take part' },
  full: { doing: 'turned away, room full' },
  ended: { doing: 'ended early' },
  replaced: { doing: 'replaced' },
};
const kOtherPhases: Record<string, string> = { teacher: 'Teacher chooses' };
const kOtherLimits: Record<string, string> = {
  lobby_s: 'lobby',
  leave_after_s: 'a waiting person may leave with a code after',
  max_minutes: 'whole session',
};

const wordsOf = (stage: string): StageWords | undefined => (kPersonStages as Record<string, StageWords>)[stage];
export const personStage = (stage: string): string => wordsOf(stage)?.doing ?? stage;
export const phaseName = (phase: string): string => wordsOf(phase)?.phase ?? kOtherPhases[phase] ?? capitalised(phase);
// What the limit of a study is of, by its key: "watch_s".
export const limitName = (key: string): string => wordsOf(key.replace(/_s$/, ''))?.limit ?? kOtherLimits[key] ?? key;

// What the log says of events; others are shown as they are.
const kLogged: Record<string, string> = {
  'room-make': 'made rooms',
  'link-revoke': 'revoked a link',
  returned: 'came back',
  start: 'started the room',
  started: 'the group started',
  pause: 'paused the room',
  paused: 'paused',
  resume: 'resumed the room',
  resumed: 'resumed',
  extend: 'gave more time',
  message: 'sent a message',
  readmit: 're-admitted a person',
  simulate: 'replaced a person by a simulated learner',
  strategy: 'switched the strategy',
  end: 'ended the room',
  ended: 'the group ended',
  join: 'joined',
  joined: 'joined',
  consented: 'gave consent',
  declined: 'declined to take part',
  checked: 'finished the keyboard check',
  named: 'entered a name',
  screened: 'answered a screening test',
  examined: 'answered a board of the exam',
  lesson: 'chose a lesson',
  watched: 'watched a demonstration',
  answered: 'answered a test',
  continued: 'continued after the feedback',
  questions: 'answered the questions',
  dropped: 'dropped out',
  released: 'released from the lobby',
  grouped: 'formed a group from the waiting list',
  time: 'a time limit was reached',
  present: 'connected',
  away: 'away',
  leave: 'left',
  left: 'left',
};

export const loggedText = (what: string): string => kLogged[what] ?? what;

const kEnds: Record<string, string> = {
  complete: 'all components learned',
  skipped: 'taught all that can be shown; some components were left out',
  'max-periods': 'reached the maximum number of periods',
  'time-limit': 'reached the time limit',
  'lobby-time': 'not enough people joined in time',
  facilitator: 'ended by the facilitator',
};

export const endText = (reason: string | undefined): string => (reason ? (kEnds[reason] ?? reason.replace(/-/g, ' ')) : '');

const kPolicies: Record<string, string> = {
  'pause-then-continue': 'Pause the group; continue without the person after the grace period',
  'continue-now': 'Continue without the person immediately',
  simulate: 'Fill the seat with a simulated learner',
  'end-group': 'End the session; everyone gets a completion code',
};

export const policyText = (policy: string): string => kPolicies[policy] ?? policy;

// Terms that the page explains on hover and focus.
export const kTerms = {
  p_bec:
    'p(BEC): the share of a belief that lies in the BEC region, that is, the probability that the learner would reproduce the robot\u2019s whole policy.',
  gain: 'Information gain: how much the demonstration shrinks the region of reward weights that are still possible under the belief being taught (ratio of the areas before and after; larger is better).',
  component: 'Knowledge component: a part of the reward that is taught and tested separately, for example one feature against the cost of a step.',
  forecast: 'Forecast: if the study has imagined sessions (record.forecast), from those that had got as far, at the pace of this session so far, with the central 80\u00a0%. Otherwise it assumes that each open component takes as many periods as the earlier ones did on average; the range is then based on the shortest and the longest period so far.',
  composition: 'Composition: the type of learner that the teacher assumes for each member, one letter per member. Set-up lists the types.',
  grace: 'Grace period: how long a person may be away before the dropout policy applies.',
  simulated: 'A simulated learner: a program that learns and answers like a learner of the given type. The consent form informs participants about it.',
  interactions: 'Period: one round of demonstrations, tests and feedback.',
  runners_up: 'Runners-up: the demonstrations with the next largest gains. They were not shown. A gain of 2\u00d7 means that half of the rewards that were still possible would be ruled out.',
  knows: 'Knows: how often this person is expected to predict all of a component rightly, as a mean over the components taught so far. As in kith audit: from all answers in finished periods.',
  thinks: 'Likely thinks: the misconception about what was taught so far that is most probable by this person\u2019s answers. Nothing is named below 10\u00a0%.',
  learner_kind: 'Kind of learner: how this person seems to learn and answer, by their answers so far. A kind is named from a probability of 80\u00a0% on.',
  unsaved: 'Unsaved: events that have been accepted but not yet written to disk. The browser gets an acknowledgement only after the write.',
};
export type Term = keyof typeof kTerms;

export const typeLabel = (study: StudyInfo, letter: string | undefined): string => {
  if (!letter) return '';
  return study.types.find((type) => type.letter === letter)?.label ?? letter;
};

export const estimateText = (estimate: number | undefined): string => estimate?.toFixed(2) ?? '';


// How it ended for somebody.
const kStatuses: Record<string, string> = {
  finished: 'finished',
  left: 'left',
  dropped: 'dropped out',
  replaced: 'replaced',
  withdrawn: 'withdrawn',
  ended: 'room ended early',
  declined: 'declined to take part',
  full: 'turned away, room full',
};
export const statusOf = ({ status, dropped, stage }: SeatRow): string => status ?? (dropped ? 'dropped' : stage === 'debrief' ? 'finished' : stage);
export const statusText = (seat: SeatRow): string => kStatuses[statusOf(seat)] ?? kPresence.left;
// Whether nothing more is expected of them.
export const isOver = (seat: SeatRow): boolean => statusOf(seat) in kStatuses;

// "NNP"; "2 N, 10 P" of more people than one takes in.
export function groupText(composition: string): string {
  const kMostLetters = 6;
  if (composition.length <= kMostLetters) return composition;
  return [...new Set(composition)].map((letter) => `${composition.split(letter).length - 1} ${letter}`).join(', ');
}

// What of a room needs a person's attention, or nothing.
export function attention(room: RoomRow): string | null {
  if (room.stage === 'ended') return null;
  const away = room.seats.filter((seat) => seat.presence === 'away' && !isOver(seat));
  if (away.length > 0) return `${away.map(({ label }) => label).join(', ')} away`;
  if (room.stage === 'paused') return 'Paused';
  const helpless = room.seats.filter(({ needs_help }) => needs_help !== undefined);
  return helpless.length > 0 ? `${helpless.map(({ label }) => label).join(', ')} may need help` : null;
}

export const seatTitle = (seat: SeatRow): string => (seat.name ? `${seat.label} (${seat.name})` : seat.label);

// Who did something, in a log: "Learner A" for seat:1.
export function actorText(actor: string, room: RoomRow | undefined): string {
  const number = /^seat:(\d+)$/.exec(actor)?.[1];
  const seat = room?.seats.find((one) => String(one.seat) === number);
  return seat?.label ?? actor.replace(/^seat:/, 'seat ');
}

export const roomTitle = (room: RoomRow): string => `Room ${room.code ?? room.id}`;
