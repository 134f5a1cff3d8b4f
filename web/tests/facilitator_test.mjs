// The facilitator page of `kith serve`, as facilitators and observers use it.
//
//   node tests/facilitator_test.mjs --kith PROGRAM [--screenshots DIR] [--modules DIR] [--chromium FILE]
import { dirname, join } from 'node:path';
import { after, before, describe } from 'node:test';
import { fileURLToPath } from 'node:url';
import { parseArgs } from 'node:util';
import { connectionTests } from './facilitator/connection_tests.mjs';
import { controlTests } from './facilitator/control_tests.mjs';
import { Harness } from './facilitator/harness.mjs';
import { lookTests } from './facilitator/look_tests.mjs';
import { pageTests } from './facilitator/page_tests.mjs';

const here = dirname(fileURLToPath(import.meta.url));
const { values } = parseArgs({
  options: {
    kith: { type: 'string' },
    screenshots: { type: 'string' },
    modules: { type: 'string', default: join(here, '..') },
    chromium: { type: 'string', default: '/usr/bin/chromium' },
  },
});
if (!values.kith) {
  console.error(
    'usage: node tests/facilitator_test.mjs --kith PROGRAM [--screenshots DIR] [--modules DIR] [--chromium FILE]',
  );
  process.exit(2);
}

describe('the connection to the server', () => connectionTests(values.modules));

describe('the facilitator page', () => {
  const harness = new Harness(values);
  before(() => harness.open());
  after(() => harness.close());
  pageTests(harness);
  lookTests(harness);
  controlTests(harness);
});
