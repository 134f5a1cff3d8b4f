// People in browsers who take part in what a real `kith serve` teaches.
import { readFileSync } from 'node:fs';
import { launch, requireFrom } from '../browser.mjs';
import { withServer } from '../kith.mjs';
import { openPerson } from './person.mjs';

// What tests are given: the program, packages, browser, and where screenshots go.
export class Setting {
  constructor({ modules, chromium, screenshots, kith }) {
    Object.assign(this, { modules, chromium, screenshots, kith });
    this.axe = readFileSync(requireFrom(modules).resolve('axe-core/axe.min.js'), 'utf8');
  }

  async start() {
    this.browser = await launch(this.modules, this.chromium);
  }

  async stop() {
    await this.browser?.close();
  }
}

// Runs a body with a group of people who have joined a study; nothing may go wrong on any of their pages.
export async function withGroup(setting, { size = 1, look = {}, ...study }, body) {
  await withServer(setting.kith, { size, ...study }, async (running) => {
    const people = [];
    try {
      for (let i = 0; i < size; i += 1) {
        people.push(await openPerson(setting.browser, running.server.join, look));
        await people[i].join();
      }
      const [person] = people;
      await body({ running, people, person, page: person.page, wire: person.wire });
      for (const { trouble } of people) {
        if (trouble.length > 0) throw new Error(`requests, console messages or uncaught errors: ${trouble.join('; ')}`);
      }
    } finally {
      for (const person of people) await person.close();
    }
  });
}
