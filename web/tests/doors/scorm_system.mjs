// A learning system that speaks SCORM 1.2 or 2004 and refuses what breaks the rules for content. Sections are those of
// the run-time environments.
const kVersions = {
  1.2: {
    object: 'API',
    prefix: 'LMS',
    finish: 'LMSFinish',
    codes: { twice: '101', closed: '301', value: '405', name: '201' },
    values: { 'cmi.core.student_id': 'learner-7', 'cmi.core.lesson_status': 'not attempted', 'cmi.core.lesson_mode': 'normal', 'cmi.core.score.raw': '', 'cmi.suspend_data': '' },
    types: {
      'cmi.core.lesson_status': /^(passed|completed|failed|incomplete|browsed)$/,
      'cmi.core.score.raw': /^(100|\d{1,2})(\.\d{1,2})?$/,
      'cmi.core.score.min': /^\d{1,3}$/,
      'cmi.core.score.max': /^\d{1,3}$/,
      'cmi.core.session_time': /^\d{2,4}:[0-5]\d:[0-5]\d(\.\d{1,2})?$/,
      'cmi.core.exit': /^(time-out|suspend|logout|)$/,
      'cmi.suspend_data': /^[\s\S]{0,4096}$/,
    },
  },
  2004: {
    object: 'API_1484_11',
    prefix: '',
    finish: 'Terminate',
    codes: { twice: '103', closed: '132', value: '406', name: '401' },
    values: { 'cmi.learner_id': 'learner-7', 'cmi.completion_status': 'unknown', 'cmi.success_status': 'unknown', 'cmi.mode': 'normal', 'cmi.score.raw': '', 'cmi.suspend_data': '' },
    types: {
      'cmi.completion_status': /^(completed|incomplete|not attempted|unknown)$/,
      'cmi.success_status': /^(passed|failed|unknown)$/,
      'cmi.score.raw': /^\d{1,3}(\.\d+)?$/,
      'cmi.score.min': /^\d{1,3}$/,
      'cmi.score.max': /^\d{1,3}$/,
      'cmi.score.scaled': /^(1|0(\.\d+)?)$/,
      'cmi.session_time': /^PT\d+(\.\d{1,2})?S$/,
      'cmi.exit': /^(time-out|suspend|logout|normal|)$/,
      'cmi.suspend_data': /^[\s\S]{0,64000}$/,
    },
  },
};

/** Section (1.2; 2004) and rule of everything that is refused. */
export const kScormRules = [
  ['3.3.2.1; 3.1.3.1', 'it is initialized once'],
  ['3.3.2.1; 3.1.3', 'nothing is asked or told before it is initialized or after it is finished'],
  ['3.3.2.1; 3.1.3', 'an empty text is the only parameter of the functions without one'],
  ['3.4; 4.2', 'only what the model has is asked for or set'],
  ['3.4; 4.2', 'values are what the model allows'],
];

export class ScormSystem {
  refused = [];
  calls = 0;
  kept = new Map(); // what was committed

  /** @param spelling how it says yes and no. */
  constructor(version = '1.2', spelling = ['true', 'false']) {
    Object.assign(this, { version, yes: spelling[0], no: spelling[1], ...kVersions[version] });
    this.kept = new Map(Object.entries(this.values));
  }

  /** A new visit: the object that the content finds. */
  visit() {
    const { prefix, codes } = this;
    const set = new Map(this.kept);
    let [state, error] = ['new', '0'];
    const refuse = (rule, code) => (this.refused.push(rule), (error = code), this.no);
    const open = (body, nothing) => (...words) => {
      this.calls += 1;
      if (state !== 'open') return refuse('nothing is asked or told before it is initialized or after it is finished', codes.closed);
      if (nothing && words[0] !== '') return refuse('an empty text is the only parameter of the functions without one', '201');
      error = '0';
      return body(...words);
    };
    const keep = () => ((this.kept = new Map(set)), this.yes);
    return {
      [`${prefix}Initialize`]: (word) => {
        this.calls += 1;
        if (word !== '') return refuse('an empty text is the only parameter of the functions without one', '201');
        if (state !== 'new') return refuse('it is initialized once', codes.twice);
        state = 'open';
        error = '0';
        return this.yes;
      },
      [this.finish]: open(() => ((state = 'finished'), keep()), true),
      [`${prefix}Commit`]: open(keep, true),
      [`${prefix}GetValue`]: open((name) => (set.has(name) ? set.get(name) : (refuse('only what the model has is asked for or set', codes.name), ''))),
      [`${prefix}SetValue`]: open((name, value) => {
        if (!(name in this.types)) return refuse('only what the model has is asked for or set', codes.name);
        if (typeof value !== 'string' || !this.types[name].test(value)) return refuse('values are what the model allows', codes.value);
        set.set(name, value);
        return this.yes;
      }),
      [`${prefix}GetLastError`]: () => error,
      [`${prefix}GetErrorString`]: (code) => `error ${code}`,
      [`${prefix}GetDiagnostic`]: () => '',
    };
  }

  get status() {
    return this.version === '1.2' ? this.kept.get('cmi.core.lesson_status') : this.kept.get(this.kept.get('cmi.success_status') === 'passed' ? 'cmi.success_status' : 'cmi.completion_status');
  }

  get score() {
    return this.kept.get(this.version === '1.2' ? 'cmi.core.score.raw' : 'cmi.score.raw');
  }
}
