// Takes part in what `kith serve` teaches as people would: whole sessions, failures, discussions, and every screen.
//
//   node tests/live_test.mjs --kith PROGRAM [--only SUITE] [--screenshots DIR] [--modules DIR] [--chromium FILE]
//
// SUITE is one of those below.
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
    kith: { type: 'string' },
    only: { type: 'string' },
    screenshots: { type: 'string' },
    modules: { type: 'string', default: join(here, '..') },
    chromium: { type: 'string', default: '/usr/bin/chromium' },
  },
});
const suites = {
  texts: textTests,
  session: sessionTests,
  failures: failureTests,
  kith: kithTests,
  discussion: discussionTests,
  screens: screenTests,
};
if (!values.kith || (values.only && !Object.hasOwn(suites, values.only))) {
  console.error(
    'usage: node tests/live_test.mjs --kith PROGRAM [--only SUITE] [--screenshots DIR] [--modules DIR] [--chromium FILE]',
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
