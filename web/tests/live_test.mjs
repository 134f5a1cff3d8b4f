// Takes part in live sessions as people would: whole sessions, failures, and every screen.
//
//   node tests/live_test.mjs --app DIR|--kith PROGRAM [--only SUITE] [--screenshots DIR] [--modules DIR]
//                            [--chromium FILE]
//
// DIR is what `build_app.mjs --page live` has written; a mock server plays the protocol. With --kith it is the
// demonstration of `kith serve` that people take part in. SUITE is one of those below.
import { existsSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { after, before, describe } from 'node:test';
import { fileURLToPath } from 'node:url';
import { parseArgs } from 'node:util';
import { discussionTests } from './live/discussion_tests.mjs';
import { failureTests } from './live/failure_tests.mjs';
import { Setting } from './live/group.mjs';
import { kithTests } from './live/kith_tests.mjs';
import { screenTests } from './live/screen_tests.mjs';
import { sessionTests } from './live/session_tests.mjs';
import { textTests } from './live/text_tests.mjs';

const here = dirname(fileURLToPath(import.meta.url));
const { values } = parseArgs({
  options: {
    app: { type: 'string', default: '' },
    kith: { type: 'string' },
    only: { type: 'string' },
    screenshots: { type: 'string' },
    modules: { type: 'string', default: join(here, '..') },
    chromium: { type: 'string', default: '/usr/bin/chromium' },
  },
});
const all = { texts: textTests, session: sessionTests, failures: failureTests, screens: screenTests };
const suites = values.kith ? { kith: kithTests, discussion: discussionTests } : all;
if ((!values.kith && !existsSync(join(values.app, 'index.html'))) || (values.only && !Object.hasOwn(suites, values.only))) {
  console.error(
    'usage: node tests/live_test.mjs --app DIR|--kith PROGRAM [--only SUITE] [--screenshots DIR] [--modules DIR] [--chromium FILE]',
  );
  process.exit(2);
}
const setting = new Setting(values);

describe('pages of participants', () => {
  before(() => setting.start());
  after(() => setting.stop());
  for (const [name, suite] of Object.entries(suites)) {
    if (!values.only || values.only === name) suite(setting);
  }
});
