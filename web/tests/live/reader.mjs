// Somebody at a lesson in a file: what they see is told by the page, since there are no frames to read.
import { until } from '../kith.mjs';
import { Person } from './person.mjs';

const readers = new WeakMap(); // by page

export class Reader extends Person {
  constructor(context, page, address) {
    super(context, page, address);
    readers.set(page, this);
  }

  // Before the page of the lesson is opened.
  static async listen(context) {
    await context.exposeBinding('tellView', ({ page }, view) => void ((page.kithView = view) && readers.get(page)?.look(view)));
    await context.addInitScript(() => window.addEventListener('kith-view', ({ detail }) => window.tellView(detail)));
  }

  look(view) {
    this.view = view;
  }

  async open() {
    await super.open();
    return this.arrived();
  }

  async arrived() {
    await this.page.waitForSelector('h1');
    this.view ??= this.page.kithView ?? null; // told before anybody listened
    await until(() => this.view !== null);
    return this;
  }

  // Lessons in a file ask for a guess first.
  async watch() {
    await this.page.waitForSelector('.drive-area, .player');
    const skip = this.button('Watch without a guess');
    if (await skip.isVisible()) await skip.click();
    await super.watch();
  }

  table(key) {
    return this.page.evaluate((name) => window.kithLesson.world(name), key);
  }

  async reload() {
    this.view = null;
    this.page.kithView = null;
    await this.page.reload();
    return this.arrived();
  }

  async log() {
    return this.page.evaluate(() => window.kithLesson.log());
  }
}
