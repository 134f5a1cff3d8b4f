// A learning system that speaks cmi5 and refuses what breaks the rules for content. Sections are those of the
// specification "cmi5", Quartz, 1st edition.
const kCategory = 'https://w3id.org/xapi/cmi5/context/categories/';
const kSession = 'https://w3id.org/xapi/cmi5/context/extensions/sessionid';
const kMastery = 'https://w3id.org/xapi/cmi5/context/extensions/masteryscore';
const kDefined = ['initialized', 'completed', 'passed', 'failed', 'terminated'];
const kUuid = /^[0-9a-f]{8}-[0-9a-f]{4}-[1-5][0-9a-f]{3}-[89ab][0-9a-f]{3}-[0-9a-f]{12}$/;

// What each statement has to be: in breach of it, if the function says so. `a` has what the statement consists of.
const kOfStatements = [
  ['9.1', 'a statement has an id, a UUID', (a) => !kUuid.test(a.one.id)],
  ['9.2', 'the actor is that of the launch', (a) => JSON.stringify(a.one.actor) !== a.player.actor],
  ['9.3', 'initialized comes first', (a) => !a.told.includes('initialized') && a.verb !== 'initialized'],
  ['9.3', 'no verb comes twice in a session', (a) => a.isDefined && a.told.includes(a.verb)],
  ['9.3', 'passed and failed exclude each other in a session', (a) => a.isJudged && (a.told.includes('passed') || a.told.includes('failed'))],
  ['9.3', 'completed comes once in a registration', (a) => a.verb === 'completed' && a.toldEver.includes('completed')],
  ['9.3', 'passed comes once in a registration', (a) => a.verb === 'passed' && a.toldEver.includes('passed')],
  ['9.3', 'failed does not follow passed in a registration', (a) => a.verb === 'failed' && a.toldEver.includes('passed')],
  ['9.3.4', 'a pass has at least the mastery score', (a) => a.verb === 'passed' && a.result.score?.scaled < a.launch.masteryScore],
  ['9.3.5', 'a failure has less than the mastery score', (a) => a.verb === 'failed' && a.result.score?.scaled >= a.launch.masteryScore],
  ['9.3.8', 'terminated comes last', (a) => a.told.includes('terminated')],
  ['9.4', 'the object is that of the launch', (a) => a.isDefined && a.one.object.id !== a.player.activity],
  ['9.5.1', 'only passed and failed have a score', (a) => a.isDefined && !a.isJudged && a.result.score !== undefined],
  ['9.5.1', 'a score is from 0 to 1', (a) => a.result.score !== undefined && !(a.result.score.scaled >= 0 && a.result.score.scaled <= 1)],
  ['9.5.2', 'success is what the verb says', (a) => a.isDefined && a.result.success !== { passed: true, failed: false }[a.verb]],
  ['9.5.3', 'completion is what the verb says', (a) => a.isDefined && a.result.completion !== { completed: true }[a.verb]],
  ['9.5.4.1', 'an end has a duration', (a) => a.isDefined && a.verb !== 'initialized' && !/^PT\d+(\.\d+)?S$/.test(a.result.duration)],
  ['9.6.1', 'the registration is that of the launch', (a) => a.one.context?.registration !== a.player.registration],
  ['9.6.2', 'the activities of the template are kept', (a) => !JSON.stringify(a.activities.grouping ?? '').includes('https://lms.example/course')],
  ['9.6.2.1', 'what cmi5 defines is marked so, and nothing else', (a) => a.isDefined !== a.categories.includes(`${kCategory}cmi5`)],
  ['9.6.2.2', 'what is judged or completed is marked so, and nothing else', (a) => (a.isJudged || a.verb === 'completed') !== a.categories.includes(`${kCategory}moveon`)],
  ['9.6.3.1', 'the session is that of the launch', (a) => a.one.context?.extensions?.[kSession] !== a.player.session],
  ['9.6.3.2', 'what is judged by the mastery score names it', (a) => a.isJudged && a.one.context?.extensions?.[kMastery] !== a.launch.masteryScore],
  ['9.7', 'a time is in UTC', (a) => !/^\d{4}-\d\d-\d\dT.*Z$/.test(a.one.timestamp)],
  ['10', 'who only looks is neither judged nor completed', (a) => a.launch.launchMode !== 'Normal' && a.isDefined && !['initialized', 'terminated'].includes(a.verb)],
  ['11', 'preferences are read before anything is said', (a) => !a.player.hasPreferences],
];
// What requests have to be.
const kOfRequests = [
  ['8.1', 'requests go to the endpoint, as it is given'],
  ['8.2.1', 'the token is fetched by POST'],
  ['8.2.1', 'the token is fetched once'],
  ['8.2.2', 'every request has the token'],
  ['10', 'what the system says of the launch is not changed'],
];

/** Section and rule of everything that is refused. */
export const kCmi5Rules = [...kOfStatements, ...kOfRequests].map(([section, rule]) => [section, rule]);

export class Cmi5Player {
  registration = '7b0b6c1e-2f1a-4f0e-9d3a-0e4f6f1f3c11';
  activity = 'urn:example:au';
  actor = JSON.stringify({ objectType: 'Agent', account: { homePage: 'https://lms.example', name: '7' } });
  states = new Map();
  toldEver = [];
  statements = [];
  refused = [];
  requests = 0;

  constructor({ launchMode = 'Normal', masteryScore, returnURL } = {}) {
    Object.assign(this, { launchMode, masteryScore, returnURL });
  }

  /** The address of a new visit. */
  launch(page = 'https://lms.example/lesson.html', base = 'https://lms.example') {
    this.session = `session-${(this.sessions = (this.sessions ?? 0) + 1)}`;
    Object.assign(this, { hasToken: false, hasPreferences: false, told: [] });
    const contextTemplate = { contextActivities: { grouping: [{ id: 'https://lms.example/course' }] }, extensions: { [kSession]: this.session } };
    const { launchMode, masteryScore, returnURL } = this;
    this.launched = { contextTemplate, launchMode, moveOn: 'CompletedOrPassed', ...(masteryScore === undefined ? {} : { masteryScore }), ...(returnURL ? { returnURL } : {}) };
    const { actor, registration, activity } = this;
    return `${page}?${new URLSearchParams({ endpoint: `${base}/lrs`, fetch: `${base}/fetch?${this.session}`, actor, registration, activityId: activity })}`;
  }

  /** Status and text of the answer. */
  answer(address, { method = 'GET', headers = {}, body } = {}) {
    this.requests += 1;
    const { pathname, searchParams } = new URL(address);
    const refuse = (rule) => (this.refused.push(rule), [400, rule]);
    if (pathname === '/fetch') {
      if (method !== 'POST') return refuse('the token is fetched by POST');
      if (this.hasToken) return (refuse('the token is fetched once'), [200, JSON.stringify({ 'error-code': '1', 'error-text': 'handed out before' })]);
      this.hasToken = true;
      return [200, JSON.stringify({ 'auth-token': 'a-token' })];
    }
    if (!pathname.startsWith('/lrs/')) return refuse('requests go to the endpoint, as it is given');
    if (new Headers(headers).get('authorization') !== 'Basic a-token') return refuse('every request has the token');
    if (pathname === '/lrs/agents/profile' && searchParams.get('profileId') === 'cmi5LearnerPreferences') {
      this.hasPreferences = searchParams.get('agent') === this.actor;
      return [404, ''];
    }
    if (pathname === '/lrs/activities/state') return this.state(method, searchParams.get('stateId'), body, refuse);
    if (pathname === '/lrs/statements') return this.take(JSON.parse(body), refuse);
    return refuse('requests go to the endpoint, as it is given');
  }

  state(method, name, body, refuse) {
    if (method === 'GET') {
      const text = name === 'LMS.LaunchData' ? JSON.stringify(this.launched) : this.states.get(name);
      return text === undefined ? [404, ''] : [200, text];
    }
    if (name === 'LMS.LaunchData') return refuse('what the system says of the launch is not changed');
    this.states.set(name, body);
    return [204, ''];
  }

  take(all, refuse) {
    for (const one of all) {
      if (this.statements.some(({ id }) => id === one.id)) continue; // sent again
      const verb = one.verb.id.split('/').pop();
      const isDefined = kDefined.includes(verb);
      const isJudged = verb === 'passed' || verb === 'failed';
      const activities = one.context?.contextActivities ?? {};
      const categories = (activities.category ?? []).map(({ id }) => id);
      const about = { player: this, launch: this.launched, told: this.told, toldEver: this.toldEver, one, verb, isDefined, isJudged, activities, categories, result: one.result ?? {} };
      const broken = kOfStatements.find(([, , isBroken]) => isBroken(about));
      if (broken) return refuse(broken[1]);
      this.statements.push(one);
      this.told.push(verb);
      if (isDefined) this.toldEver.push(verb);
    }
    return [200, JSON.stringify(all.map(({ id }) => id))];
  }

  get verbs() {
    return this.statements.map(({ verb }) => verb.id.split('/').pop());
  }
}
