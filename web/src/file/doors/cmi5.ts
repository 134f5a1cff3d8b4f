// A learning system that speaks cmi5: it opens this page with the address of a store for xAPI statements.
import { keep, recall } from '../../live/storage';
import { uuid } from '../../shared/uuid';
import { isLearned, scoreOf, VisitIsOver, type Door, type Opening, type Prediction, type Progress } from './door';

const kVersion = '1.0.3';
const kCategory = 'https://w3id.org/xapi/cmi5/context/categories/';
const kSession = 'https://w3id.org/xapi/cmi5/context/extensions/sessionid';
const kMasteryScore = 'https://w3id.org/xapi/cmi5/context/extensions/masteryscore';
const kOwn = 'https://w3id.org/xapi/kith/'; // extensions that say what nothing registered says
const kVerbs = {
  initialized: 'http://adlnet.gov/expapi/verbs/initialized',
  answered: 'http://adlnet.gov/expapi/verbs/answered',
  progressed: 'http://adlnet.gov/expapi/verbs/progressed',
  passed: 'http://adlnet.gov/expapi/verbs/passed',
  failed: 'http://adlnet.gov/expapi/verbs/failed',
  completed: 'http://adlnet.gov/expapi/verbs/completed',
  terminated: 'http://adlnet.gov/expapi/verbs/terminated',
} as const;
type Verb = keyof typeof kVerbs;

interface LaunchData {
  contextTemplate: { contextActivities?: Record<string, unknown>; extensions?: Record<string, unknown> } & Record<string, unknown>;
  masteryScore?: number;
  launchMode: 'Normal' | 'Browse' | 'Review';
  returnURL?: string;
}

// What has been told before, over all visits.
interface Told {
  log: string;
  predictions: number; // of the lesson as it was begun last
  components: string[];
  hasPassed: boolean;
  hasCompleted: boolean;
}
const kNothing = { log: '', predictions: 0, components: [] };

const duration = (ms: number): string => `PT${(ms / 1000).toFixed(2)}S`;

class Store {
  private constructor(
    private readonly endpoint: string,
    private readonly token: string,
    readonly actor: Record<string, unknown>,
    readonly registration: string,
    readonly activity: string,
  ) {}

  // The system hands the token out once: it is kept for a reload.
  static async open(query: URLSearchParams): Promise<Store> {
    const get = (name: string): string => query.get(name) ?? '';
    const place = `visit.token.${get('registration')}.${get('fetch')}`;
    let token = recall<string>(place);
    if (!token) {
      const reply = await fetch(get('fetch'), { method: 'POST' });
      const answer = (await reply.json()) as { 'auth-token'?: string; 'error-text'?: string };
      token = answer['auth-token'] ?? '';
      if (!token) throw new Error(answer['error-text'] ?? `status ${reply.status}`);
      keep(place, token);
    }
    const endpoint = get('endpoint').replace(/\/*$/, '/');
    return new Store(endpoint, token, JSON.parse(get('actor')) as Record<string, unknown>, get('registration'), get('activityId'));
  }

  private async request(path: string, init: RequestInit & { headers?: Record<string, string> }): Promise<Response> {
    const headers = { Authorization: `Basic ${this.token}`, 'X-Experience-API-Version': kVersion, ...init.headers };
    const reply = await fetch(this.endpoint + path, { ...init, headers });
    if (!reply.ok && reply.status !== 404) throw new Error(`status ${reply.status}`);
    return reply;
  }

  private statePath(name: string): string {
    const query = new URLSearchParams({ activityId: this.activity, agent: JSON.stringify(this.actor), stateId: name, registration: this.registration });
    return `activities/state?${query.toString()}`;
  }

  // What the system asks of every lesson before it says anything; a lesson has one language and no sound.
  async readPreferences(): Promise<void> {
    const query = new URLSearchParams({ agent: JSON.stringify(this.actor), profileId: 'cmi5LearnerPreferences' });
    await this.request(`agents/profile?${query.toString()}`, { method: 'GET' });
  }

  async state(name: string): Promise<string> {
    const reply = await this.request(this.statePath(name), { method: 'GET' });
    return reply.status === 404 ? '' : reply.text();
  }

  async setState(name: string, text: string): Promise<void> {
    await this.request(this.statePath(name), { method: 'PUT', body: text, headers: { 'Content-Type': 'application/json' } });
  }

  async tell(statements: object[], isLast = false): Promise<void> {
    if (statements.length > 0) await this.request('statements', { method: 'POST', body: JSON.stringify(statements), headers: { 'Content-Type': 'application/json' }, keepalive: isLast });
  }
}

class Statements {
  constructor(
    private readonly store: Store,
    private readonly launch: LaunchData,
  ) {}

  of(verb: Verb, more: { result?: object; object?: { id: string; definition: object }; isDefined?: boolean; extensions?: object }): object {
    const { contextTemplate, masteryScore } = this.launch;
    const { object, result, isDefined, extensions } = more;
    const category = [{ id: `${kCategory}cmi5` }, ...(verb === 'passed' || verb === 'failed' || verb === 'completed' ? [{ id: `${kCategory}moveon` }] : [])];
    const activities = { ...contextTemplate.contextActivities };
    if (isDefined) activities['category'] = [...((activities['category'] as object[] | undefined) ?? []), ...category];
    if (object) activities['parent'] = [{ id: this.store.activity }];
    const scored = verb === 'passed' || verb === 'failed';
    return {
      id: uuid(),
      timestamp: new Date().toISOString(),
      actor: this.store.actor,
      verb: { id: kVerbs[verb], display: { en: verb } },
      object: { objectType: 'Activity', ...(object ?? { id: this.store.activity }) },
      ...(result ? { result } : {}),
      context: {
        ...contextTemplate,
        registration: this.store.registration,
        contextActivities: activities,
        extensions: { ...contextTemplate.extensions, ...(scored && masteryScore !== undefined ? { [kMasteryScore]: masteryScore } : {}), ...extensions },
      },
    };
  }

  prediction({ period, test, right, regret, ms }: Prediction): object {
    const id = `${this.store.activity}#prediction-${period + 1}-${test + 1}`;
    const definition = { type: 'http://adlnet.gov/expapi/activities/interaction', name: { en: `Prediction ${test + 1} of round ${period + 1}` } };
    return this.of('answered', { object: { id, definition }, result: { success: right, duration: duration(ms), extensions: { [`${kOwn}regret`]: regret } } });
  }

  component(name: string, index: number, status: string): object {
    const definition = { type: 'http://adlnet.gov/expapi/activities/objective', name: { en: name } };
    return this.of('progressed', { object: { id: `${this.store.activity}#component-${index + 1}`, definition }, result: { success: status === 'learned', extensions: { [`${kOwn}level`]: status } } });
  }
}

const launched = (): URLSearchParams | null => {
  const query = new URLSearchParams(location.search);
  return ['endpoint', 'fetch', 'actor', 'registration', 'activityId'].every((name) => query.has(name)) ? query : null;
};

export async function openCmi5(): Promise<Door | null> {
  const query = launched();
  if (!query) return null;
  const begun = Date.now();
  const store = await Store.open(query);
  const launch = JSON.parse(await store.state('LMS.LaunchData')) as LaunchData;
  const isNormal = launch.launchMode === 'Normal'; // others may only look
  const statements = new Statements(store, launch);
  const session = String(launch.contextTemplate.extensions?.[kSession]);
  const terminated = `visit.terminated.${session}`;
  const failed = `visit.failed.${session}`; // told of a failure, a visit cannot be told of a pass any more
  await store.readPreferences();
  // What is told, and the statements that may not have been taken yet: after a reload the same ones are sent again.
  const place = `visit.told.${session}`;
  const kept = JSON.parse((await store.state('kith')) || '{}') as Partial<Told>;
  let { told, waiting } = recall<{ told: Told; waiting: object[] }>(place) ?? {
    told: { ...kNothing, hasPassed: false, hasCompleted: false, ...kept },
    waiting: [statements.of('initialized', { isDefined: true })], // once a session
  };
  let isFinished = false;
  const send = async (): Promise<void> => {
    keep(place, { told, waiting });
    await store.tell(waiting);
    waiting = [];
    keep(place, { told, waiting });
    if (isNormal) await store.setState('kith', JSON.stringify(told));
  };
  const judge = (progress: Progress): void => {
    const scaled = scoreOf(progress) ?? 0;
    const success = launch.masteryScore === undefined ? isLearned(progress) : scaled >= launch.masteryScore;
    const time = duration(Date.now() - begun);
    if (!told.hasPassed && !recall(failed)) {
      waiting.push(statements.of(success ? 'passed' : 'failed', { isDefined: true, result: { success, score: { scaled }, duration: time } }));
      told.hasPassed = success;
      if (!success) keep(failed, true);
    }
    if (!told.hasCompleted) waiting.push(statements.of('completed', { isDefined: true, result: { completion: true, duration: time } }));
    told.hasCompleted = true;
  };
  const terminate = async (): Promise<void> => {
    if (recall(terminated)) return;
    keep(terminated, true);
    await store.tell([statements.of('terminated', { isDefined: true, result: { duration: duration(Date.now() - begun) } })], true);
  };
  await send();
  return {
    learner: JSON.stringify(store.actor),
    recalled: told.log,
    room: Infinity,
    report: async (progress, log) => {
      if (!isNormal) return;
      if (recall(terminated)) throw new VisitIsOver('terminated');
      const { predictions, components } = progress;
      waiting.push(
        ...predictions.slice(told.predictions).map((one) => statements.prediction(one)),
        ...components.flatMap(({ name, status }, i) => (status !== 'open' && told.components[i] !== status ? [statements.component(name, i, status)] : [])),
      );
      if (progress.isFinished) judge(progress);
      told = { ...told, log: log ?? told.log, predictions: predictions.length, components: components.map(({ status }) => status) };
      await send();
      isFinished = progress.isFinished;
    },
    restart: async () => {
      told = { ...told, ...kNothing };
      isFinished = false;
      if (isNormal && !recall(terminated)) await send();
    },
    // A page that is loaded again says more, so that only what is over ends with the page.
    leave: () => {
      if (isFinished) void terminate().catch(() => undefined);
    },
    close: async () => {
      await terminate();
      return launch.returnURL ?? '';
    },
  };
}

export const findCmi5 = (): Opening | null => (launched() ? { system: 'cmi5', open: async () => (await openCmi5()) as Door } : null);
