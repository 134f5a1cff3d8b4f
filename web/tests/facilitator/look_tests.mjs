// What facilitators see: boards, spheres, tables, at every width, light and dark.
import assert from 'node:assert/strict';
import { it } from 'node:test';
import { openTab, openRoom } from './harness.mjs';

export function lookTests({ withPage, violations, shoot, titles }) {
  for (const dark of [false, true]) {
    const tone = dark ? 'dark' : 'light';
    const rules = dark ? ['color-contrast'] : undefined; // that the theme may break; otherwise all
    it(`has no serious axe violation on any tab or dialog, ${tone}`, async () => {
      await withPage({ dark, calm: true }, async (page) => {
        const check = async (name) => {
          await shoot(page, `${name}-${tone}`);
          assert.deepEqual(await violations(page, rules), [], name);
        };
        for (const tab of ['Set-up', 'Rooms', 'Data', 'Log']) {
          await openTab(page, tab);
          if (tab === 'Set-up') await page.waitForSelector('.qr img');
          await check(tab.toLowerCase());
        }
        for (const [title, name] of [[titles.three, '3'], [titles.twelve, '12'], [titles.one, '1'], [titles.paused, 'paused']]) {
          await openRoom(page, title);
          await check(`live-${name}`);
        }
        await page.click('.room-buttons button:text-is("Extend")');
        await check('dialog');
        await page.keyboard.press('Escape');
        await page.click('button.seat >> nth=1');
        await page.waitForSelector('dialog');
        await check('seat');
      });
    });
  }

  it('shows a group of twelve on a screen of 1280 x 800 without scrolling', async () => {
    await withPage({ calm: true }, async (page, wire) => {
      // Somebody who is away, or has been answering for long, takes a line of their own.
      const here = ({ needs_help: _, stage_since_ms: __, ...seat }) => ({ ...seat, presence: 'here' });
      wire.bend = (view) => ({ ...view, rooms: view.rooms?.map((room) => ({ ...room, seats: room.seats.map(here) })) });
      wire.again();
      await openRoom(page, titles.twelve);
      assert.equal(await page.locator('.globe').count(), 14);
      assert.equal(await page.locator('.group tbody tr').count(), 12);
      for (const part of ['.room-buttons', '.globes', '.group', '.curves', '.progress', '.lesson-now', '.runners']) {
        const box = await page.locator(part).boundingBox();
        assert.ok(box && box.y >= 0 && box.y + box.height <= 800, `${part} ends at ${box?.y + box?.height}`);
        assert.ok(box.x >= 0 && box.x + box.width <= 1280, `${part} ends at ${box.x + box.width}`);
      }
      const sizes = await page.$$eval('.globe .ball', (all) => all.map((ball) => ball.getBoundingClientRect().width));
      assert.ok(Math.min(...sizes) >= 80, `spheres of ${Math.min(...sizes)} px`);
    });
  });

  it('shows the latest answers of a long session, with the names beside them', async () => {
    await withPage({ calm: true }, async (page, wire) => {
      const long = ({ answers, ...rest }) => ({ ...rest, answers: Array.from({ length: 30 }, (_, i) => answers.filter(({ period }) => period === 1).map((one) => ({ ...one, period: i + 1 }))).flat() });
      wire.bend = (view) => ({ ...view, ...(view.room ? { room: long(view.room) } : {}) });
      await openRoom(page, titles.three);
      const group = await page.locator('.group').boundingBox();
      const last = await page.locator('.group tbody tr >> nth=1 >> .answer-cell').last().boundingBox();
      assert.ok(last.x + last.width <= group.x + group.width + 1, 'the latest answers are out of sight');
      const name = await page.locator('button.seat >> nth=1').boundingBox();
      assert.ok(name.x >= group.x && name.x < group.x + 40, 'the names are out of sight');
      await shoot(page, 'long-light');
    });
  });

  for (const width of [320, 640, 1024]) {
    it(`fits into ${width} px without scrolling sideways`, async () => {
      await withPage({ width, calm: true }, async (page) => {
        for (const tab of ['Set-up', 'Rooms', 'Data', 'Log']) {
          await openTab(page, tab);
          const wide = await page.evaluate(() => document.documentElement.scrollWidth - window.innerWidth);
          assert.ok(wide <= 0, `${tab} is ${wide} px too wide`);
        }
        await openRoom(page, titles.twelve);
        const wide = await page.evaluate(() => document.documentElement.scrollWidth - window.innerWidth);
        await shoot(page, `live-${width}`);
        assert.ok(wide <= 0, `Live is ${wide} px too wide`);
      });
    });
  }

  it('turns all spheres by keys, sliders and dragging', async () => {
    await withPage({ calm: true }, async (page) => {
      await openRoom(page, titles.three);
      const shapes = () => page.$$eval('.globe .dots:not(.behind)', (all) => all.map((path) => path.getAttribute('d')));
      const first = await shapes();
      assert.equal(first.length, 5);
      const changed = async (what) => {
        const now = await shapes();
        now.forEach((path, i) => assert.notEqual(path, first[i], `${what} did not turn sphere ${i}`));
        await page.click('button:text-is("Reset view")');
        assert.deepEqual(await shapes(), first);
      };
      await page.focus('.globes');
      await page.keyboard.press('ArrowRight');
      await changed('a key');
      await page.focus('.turners input >> nth=1');
      await page.keyboard.press('ArrowUp');
      await changed('the slider');
      const box = await page.locator('.globe .ball').nth(2).boundingBox();
      await page.mouse.move(box.x + 40, box.y + 60);
      await page.mouse.down();
      await page.mouse.move(box.x + 90, box.y + 80);
      await page.mouse.up();
      await changed('dragging');
    });
  });

  it('draws particles where they are: behind the ball or in front', async () => {
    await withPage({ calm: true }, async (page) => {
      await openRoom(page, titles.three);
      const counts = await page.$$eval('.globe', (all) =>
        all.map((globe) => [...globe.querySelectorAll('.dots')].reduce((n, path) => n + (path.getAttribute('d').match(/M/g) ?? []).length, 0)),
      );
      assert.deepEqual(counts, [300, 300, 300, 300, 300]);
      const outside = await page.$$eval('.globe .dots', (all) =>
        all.flatMap((path) => {
          const radius = Number(path.closest('.globe').querySelector('.ball').getAttribute('r'));
          return [...path.getAttribute('d').matchAll(/M(-?[\d.]+) (-?[\d.]+)/g)].filter(([, x, y]) => Math.hypot(x, y) > radius + 0.2);
        }).length,
      );
      assert.equal(outside, 0);
    });
  });

  it('clips regions at the rim of the ball, and hides them behind it', async () => {
    await withPage({ calm: true }, async (page) => {
      await openRoom(page, titles.three);
      await page.focus('.globes');
      const seen = new Set();
      const radius = Number(await page.getAttribute('.globe .ball', 'r'));
      for (let i = 0; i < 36; i += 1) {
        const path = (await page.getAttribute('.globe .bec-region', 'd')) ?? '';
        const places = [...path.matchAll(/(-?[\d.]+),(-?[\d.]+)/g)].map(([, x, y]) => Math.hypot(Number(x), Number(y)));
        assert.ok(places.every((distance) => distance <= radius + 0.2), path);
        seen.add(path === '' ? 'behind' : places.some((distance) => distance > radius - 0.5) ? 'at the rim' : 'in front');
        await page.keyboard.press('ArrowRight');
      }
      assert.deepEqual([...seen].sort(), ['at the rim', 'behind', 'in front']);
    });
  });

  it('explains terms and answers on hover and focus; Escape hides the explanation', async () => {
    await withPage({ calm: true }, async (page) => {
      await openRoom(page, titles.three);
      await page.hover('.answer-cell.wrong >> nth=0');
      assert.match(await page.textContent('#tip'), /Period \d+, test \d+: wrong.*regret \d\.\d\d, [\d.]+ s/);
      await page.focus('.chart .term');
      assert.match(await page.textContent('#tip'), /share of a belief/);
      assert.equal(await page.getAttribute('.chart .term', 'aria-describedby'), 'tip');
      await page.keyboard.press('Escape');
      assert.equal(await page.isVisible('#tip'), false);
    });
  });

  it('plays the demonstration that is shown, says why, and shows what came next', async () => {
    await withPage({}, async (page) => {
      await openRoom(page, titles.three);
      await page.waitForFunction(() => document.querySelector('.shown .step')?.textContent.startsWith('Step'));
      assert.match(await page.textContent('.why-text'), /^Why: Chosen for the joint belief/);
      assert.equal(await page.locator('.runners .board').count(), 4);
      await page.click('.picks button:text-is("Test 1")');
      assert.match(await page.textContent('.shown-facts'), /It tests that/);
    });
    await withPage({ calm: true }, async (page) => {
      await openRoom(page, titles.three);
      assert.equal(await page.locator('.shown .play').count(), 0);
      assert.match(await page.textContent('.shown .step'), /has not moved yet/);
    });
  });

  it('draws bars where there are not three features, and lists steps where there is no map', async () => {
    await withPage({ calm: true }, async (page, wire) => {
      const change = (detail) => {
        const states = ['home', 'hall', 'work'].map((state, i) => ({ state, action: i < 2 ? 'walk' : null }));
        const board = { domain: { id: 'walk' }, world: 1, start: states[0] };
        const shown = { board, frames: states, gain: 2, sentences: ['walking costs something'] };
        return {
          ...detail,
          beliefs: [],
          truth: { weights: [0.5, 0.5, 0.5, 0.5], bec: [], prior: [] },
          lesson: { ...detail.lesson, demonstrations: [shown], tests: [shown], runners_up: [{ board, gain: 1, sentences: [] }] },
        };
      };
      wire.bend = (view) => ({ ...view, ...(view.room ? { room: change(view.room) } : {}) });
      await openTab(page, 'Rooms');
      await page.click(`.rooms button:text-is("${titles.three}")`);
      await page.click('.deep summary');
      await page.waitForSelector('.bars li');
      assert.equal(await page.locator('.bars li').count(), 5);
      assert.match(await page.textContent('.spheres'), /this domain has 4/);
      assert.match(await page.textContent('.steps'), /"walk" and gets from "home" to "hall"/);
      assert.deepEqual(await violations(page), []);
      await shoot(page, 'bars-light');
    });
  });

  it('shows what an answer was changed to in a discussion', async () => {
    for (const dark of [false, true]) {
      await withPage({ calm: true, dark }, async (page, wire) => {
        const ends = (answer, i) => (i % 4 === 0 ? { ...answer, changed: true, right_in_the_end: i % 8 === 0 } : answer);
        wire.bend = (view) => ({ ...view, ...(view.room ? { room: { ...view.room, answers: view.room.answers.map(ends) } } : {}) });
        await openRoom(page, titles.three);
        const cells = await page.$$eval('.answer-cell [role=img]', (all) =>
          all.map((one) => [one.getAttribute('aria-label'), [...one.children].map((part) => part.textContent || part.getAttribute('class')).join(' ')]),
        );
        assert.equal(cells.filter(([, shown]) => shown.includes('\u2192')).length, Math.ceil(cells.length / 4));
        for (const [text, shown] of cells) {
          const [, first, end] = /^(right|wrong).*?(?:, then changed to a (right|wrong) one)?$/.exec(text);
          assert.equal(shown, end ? `${first} \u2192 ${end}` : first, text);
        }
        assert.deepEqual(await violations(page, ['color-contrast']), []);
        await shoot(page, `changed-${dark ? 'dark' : 'light'}`);
      });
    }
  });

  it('says what kind of learner everybody seems to be, where the study asks for it', async () => {
    const kinds = [
      ['imitating', { bayesian: 0.04, imitating: 0.951, slipping: 0.009, decaying: 0.002 }],
      ['cannot tell yet', { bayesian: 0.4, imitating: 0.25, slipping: 0.15, decaying: 0.2 }],
    ];
    const ask = (detail) => ({
      ...detail,
      people: detail.people.map((member, i) => ({ ...member, kind: kinds[i % 2][0], kinds: kinds[i % 2][1] })),
    });
    for (const [title, people, dark] of [[titles.three, 3, false], [titles.twelve, 12, true]]) {
      await withPage({ calm: true, dark }, async (page, wire) => {
        await openRoom(page, title);
        const heads = () => page.$$eval('.group thead th', (all) => all.map((head) => head.textContent));
        assert.ok(!(await heads()).includes('Kind'), 'a column of a study that does not ask');
        wire.bend = (view) => ({ ...view, ...(view.room ? { room: ask(view.room) } : {}) });
        wire.again();
        await page.waitForSelector('.group .kind');
        assert.ok((await heads()).includes('Kind'));
        const shown = await page.$$eval('.group tbody .kind', (cells) => cells.map((cell) => cell.textContent));
        assert.equal(shown.length, people);
        assert.deepEqual([...new Set(shown.filter((text) => text !== ''))], ['imitating', 'cannot tell yet']);
        await page.hover('.group .kind >> nth=0');
        assert.equal(await page.textContent('#tip'), 'imitating 95 %, bayesian 4 %, slipping 1 %');
        await page.hover('.group .kind >> nth=1');
        assert.match(await page.textContent('#tip'), /^bayesian 40 %, imitating 25 %, decaying 20 %/);
        const group = await page.locator('.group').boundingBox();
        const last = await page.locator('.group tbody tr >> nth=1 >> .answer-cell').last().boundingBox();
        assert.ok(last.x + last.width <= group.x + group.width + 1, 'the latest answers are out of sight');
        assert.deepEqual(await violations(page), []);
        await shoot(page, `kinds-${people}-${dark ? 'dark' : 'light'}`);
      });
    }
  });

  it('keeps what the reader is doing when a new view arrives', async () => {
    await withPage({ calm: true }, async (page, wire) => {
      await openRoom(page, titles.three);
      await page.click('.shown button[aria-label="Next step"]');
      await page.click('.shown button[aria-label="Next step"]');
      await page.focus('.globes');
      await page.keyboard.press('ArrowLeft');
      const path = await page.getAttribute('.globe .bec-region', 'd');
      wire.bend = (view) => ({ ...view, rooms: view.rooms?.map((room) => ({ ...room, strategy: 'common' })) });
      wire.again();
      await page.waitForFunction(() => document.querySelector('.room-bar').textContent.includes('common'));
      assert.match(await page.textContent('.shown .step'), /^Step 2/);
      assert.equal(await page.getAttribute('.globe .bec-region', 'd'), path);
      assert.ok(await page.evaluate(() => document.activeElement?.classList.contains('globes')));
    });
  });
}
