// A room of the mock server: a group that is taught item delivery with the sample lesson, as the protocol says.
import { bestPath, framesOf, judge, makeWorld } from './delivery.mjs';

const legendOnly = ({ id, legend, surfaces, width, height, counted, job }) => ({ id, legend, surfaces, width, height, counted, job });
const boardOf = (domain, { world, map, start }) => ({ domain: legendOnly(domain), world, map, start });

export class Room {
  constructor(lesson, { size = 3, screening = 0, parts = 2, questions = [], redirect, askName = false, texts = {} }) {
    this.lesson = lesson;
    this.options = { size, screening, parts, questions, redirect, askName, texts };
    this.worlds = new Map();
    this.seats = Array.from({ length: size }, (_, i) => ({
      number: i + 1,
      stage: 'consent',
      present: false,
      right: 0,
      tests: 0,
      answers: [],
      draft: [],
      query: {},
    }));
    this.part = 0;
    this.round = 1;
    this.rounds = 0;
    this.notices = [];
    this.pause = null;
    this.since = Date.now();
    this.log = []; // accepted commands: {seat, type, body}
    const components = lesson.components.slice(0, parts);
    this.parts = components.map(({ demonstrations, tests, sentences }) => ({
      demonstrations: demonstrations.slice(0, 2),
      tests: tests.map((test) => this.task(test)),
      sentences,
    }));
    this.sandbox = this.task(lesson.components[0].demonstrations[0].flip);
    this.screening = this.parts[0].tests.slice(0, screening);
  }

  // Something to drive, with its table of moves and the best path.
  task(shown) {
    const { domain } = this.lesson;
    const key = `mock-${shown.world}-${shown.start.robot.join('-')}-${shown.start.items[0].cell.join('-')}`;
    const world = makeWorld(domain, shown, key);
    this.worlds.set(key, world);
    const best = bestPath(world);
    return { board: boardOf(domain, shown), key, world, best, shown };
  }

  active() {
    return this.seats.filter(({ stage }) => !['declined', 'ended', 'replaced', 'free'].includes(stage));
  }

  // Returns why a command is refused, or null.
  command(seat, type, body) {
    const person = this.seats[seat - 1];
    const handlers = {
      consent: () => person.stage === 'consent' && this.consented(person, body),
      checked: () => person.stage === 'check' && this.checked(person),
      name: () => ['check', 'lobby'].includes(person.stage) && this.named(person, body),
      screen: () => person.stage === 'screening' && this.screened(person, body),
      watched: () => person.stage === 'watch' && body.demo === person.index && this.watched(person),
      draft: () => person.stage === 'predict' && body.test === person.index && this.drafted(person, body),
      answer: () => person.stage === 'predict' && body.test === person.index && this.answered(person, body),
      continue: () => person.stage === 'feedback' && this.continued(person),
      questions: () => person.stage === 'questions' && this.asked(person, body),
      leave: () => person.stage === 'lobby' && this.left(person),
    };
    const result = Object.hasOwn(handlers, type) ? handlers[type]() : false;
    if (result === false) return 'this is not possible now';
    if (typeof result === 'string') return result;
    this.log.push({ seat, type, body });
    this.advance();
    return null;
  }

  consented(person, { accept, version }) {
    if (version !== '3') return 'this is not the current text';
    person.stage = accept ? 'check' : 'declined';
  }

  checked(person) {
    person.stage = this.screening.length > 0 ? 'screening' : 'lobby';
    person.index = 0;
    person.since = Date.now();
  }

  named(person, { name }) {
    person.name = name;
  }

  screened(person) {
    person.index += 1;
    if (person.index >= this.screening.length) {
      person.stage = 'lobby';
      person.since = Date.now();
    }
  }

  watched(person) {
    person.index += 1;
    if (person.index < this.parts[this.part].demonstrations.length) return;
    this.waits(person, 'others-watching');
  }

  drafted(person, { actions }) {
    person.draft = actions;
  }

  answered(person, { actions }) {
    const { world } = this.parts[this.part].tests[person.index];
    const judged = judge(world, 0, actions);
    if (!judged.isLegal) return 'the robot cannot do that';
    person.answers.push({ actions, ...judged });
    person.draft = [];
    person.index += 1;
    if (person.index >= this.parts[this.part].tests.length) this.waits(person, 'answers');
  }

  continued(person) {
    this.waits(person, 'feedback');
  }

  asked(person) {
    person.stage = 'debrief';
  }

  left(person) {
    person.stage = 'ended';
  }

  waits(person, what) {
    person.stage = 'wait';
    person.waitsFor = what;
    person.since = Date.now();
  }

  // What happens once everybody has done something.
  advance() {
    const people = this.active();
    const all = (what) => people.length > 0 && people.every(({ stage, waitsFor }) => stage === 'wait' && waitsFor === what);
    const begin = (stage) => people.forEach((person) => Object.assign(person, { stage, index: 0, draft: [] }));
    if (people.length === this.options.size && people.every(({ stage }) => stage === 'lobby')) begin('watch');
    else if (all('others-watching')) {
      people.forEach((person) => (person.answers = []));
      begin('predict');
    } else if (all('answers')) this.close(people, begin);
    else if (all('feedback')) this.nextPeriod(begin);
  }

  close(people, begin) {
    const { tests } = this.parts[this.part];
    for (const person of people) {
      person.tests += tests.length;
      person.right += tests.filter((test, i) => this.isRight(test, person.answers[i])).length;
    }
    this.rounds += 1;
    this.learned = people.every((person) => tests.every((test, i) => this.isRight(test, person.answers[i])));
    begin('feedback');
  }

  nextPeriod(begin) {
    const isOver = this.learned || this.round >= 2;
    if (isOver) {
      this.part += 1;
      this.round = 1;
    } else this.round += 1;
    if (this.part < this.parts.length) begin('watch');
    else begin(this.options.questions.length > 0 ? 'questions' : 'debrief');
  }

  isRight(test, answer) {
    return answer !== undefined && answer.isFinished && Math.abs(answer.cost - test.best.cost) < 1e-9;
  }

  view(seat) {
    const person = this.seats[seat - 1];
    const { texts, size } = this.options;
    return {
      v: 1,
      stage: person.stage,
      lang: 'en',
      dir: 'ltr',
      study: {
        title: texts.title ?? 'Learn how a robot works',
        story: texts.story ?? ['A robot delivers parcels in a building. It always takes the way that suits it best.'],
        goal: texts.goal ?? 'Find out what the robot likes and what it avoids.',
      },
      me: { seat, label: `Learner ${'ABCDEFGH'[seat - 1]}` },
      group: { size, active: this.active().length },
      notices: this.notices,
      ...(this.pause ? { pause: this.pause } : {}),
      ...this.stageView(person),
      server_ms: Date.now() + (this.options.skew ?? 0),
    };
  }

  stageView(person) {
    const part = this.parts[Math.min(this.part, this.parts.length - 1)];
    const done = (this.part + (this.round - 1) / 2) / this.parts.length;
    const progress = { progress: { part: this.part + 1, parts: this.parts.length, round: this.round, most: 12, done } };
    const drive = ({ board, key }, index, of, draft) => ({ index, of, board, world: key, start: 0, draft });
    const waiting = (what) => this.active().filter(({ stage, waitsFor }) => !(stage === 'wait' && waitsFor === what)).length;
    switch (person.stage) {
      case 'consent':
        return { consent: { version: '3', paragraphs: this.options.texts.consent ?? ['This is a study about robots.', 'You may stop at any time.'] } };
      case 'check':
        return { check: { ...drive(this.sandbox, 0, 1, []), ask_name: this.options.askName } };
      case 'screening':
        return { predict: drive(this.screening[person.index], person.index, this.screening.length, []) };
      case 'lobby':
        return { lobby: this.lobby(person) };
      case 'watch': {
        const { demonstrations } = part;
        const shown = demonstrations[person.index];
        const board = boardOf(this.lesson.domain, shown);
        return { ...progress, watch: { index: person.index, of: demonstrations.length, board, frames: shown.frames } };
      }
      case 'predict':
        return { ...progress, predict: drive(part.tests[person.index], person.index, part.tests.length, person.draft) };
      case 'wait':
        return { ...progress, wait: { for: person.waitsFor, missing: waiting(person.waitsFor), since_ms: person.since } };
      case 'feedback':
        return { ...progress, feedback: this.feedback(person, part) };
      case 'questions':
        return { questions: { items: this.options.questions } };
      case 'debrief':
        return { debrief: this.debrief(person) };
      case 'ended':
        return { end: { reason: 'left', text: 'You have left the session', code: 'MOCK-LEFT' } };
      default:
        return { end: { reason: person.stage, text: '' } };
    }
  }

  lobby({ since }) {
    const present = this.seats.filter(({ stage, present: here }) => stage === 'lobby' && here).length;
    const leave_after_ms = since + 300_000;
    const { size } = this.options;
    return { present, size, since_ms: since, leave_after_ms };
  }

  feedback(person, part) {
    const tests = part.tests.map((test, i) => {
      const answer = person.answers[i];
      const right = this.isRight(test, answer);
      const mine = answer ? framesOf(test.world, answer.states, answer.actions) : null;
      const robot = test.shown.frames;
      const differs = !mine ? -1 : robot.findIndex(({ action }, k) => mine[k]?.action !== action);
      return {
        board: test.board,
        right,
        mine,
        robot,
        differs_at: differs < 0 ? null : differs,
        unfinished: answer !== undefined && !answer.isFinished,
        why: test.shown.covers.map(({ text }) => text),
        ...(right || !answer?.isFinished ? {} : { cost: `Your path costs ${(answer.cost - test.best.cost).toFixed(1)} steps more at (3,1)` }),
      };
    });
    return { tests, all_right: tests.every(({ right }) => right), learned: this.learned, others_unsure: false };
  }

  debrief({ right, tests, number }) {
    const { redirect } = this.options;
    const summary = [...new Set(this.parts.flatMap(({ sentences }) => sentences.map(({ text }) => text)))];
    return { summary, not_reached: ['a step costs more than nothing'], code: `MOCK-${number}X7Q`, rounds: this.rounds, right, tests, ...(redirect ? { redirect } : {}) };
  }
}
