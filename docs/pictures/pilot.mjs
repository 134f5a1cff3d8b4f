// Takes the pictures of docs/running-a-study.md: three people take part in `kith serve --demo`, and the first expects
// the robot to take the shortest way.
//
//   node docs/pictures/pilot.mjs build/release/bin/kith build/release/web /usr/bin/chromium
import { writeFileSync } from 'node:fs';
import { dirname } from 'node:path';
import { fileURLToPath } from 'node:url';
import { crc32, deflateSync } from 'node:zlib';
import { launch } from '../../web/tests/browser.mjs';
import { bestPath } from '../../web/tests/live/delivery.mjs';
import { reach, withDemonstration } from '../../web/tests/live/kith_tests.mjs';

const [kith, modules, chromium] = process.argv.slice(2);
const here = dirname(fileURLToPath(import.meta.url));
const browser = await launch(modules, chromium);
const look = { width: 880, height: 730 };

// A PNG of at most 256 colours: the most frequent ones, to the nearest of which all others go.
function small({ width, height, data }) {
  const counts = new Map();
  const colourAt = (i) => (data[i] << 16) | (data[i + 1] << 8) | data[i + 2];
  for (let i = 0; i < data.length; i += 4) counts.set(colourAt(i), (counts.get(colourAt(i)) ?? 0) + 1);
  const palette = [...counts].sort((a, b) => b[1] - a[1]).slice(0, 64).map(([colour]) => colour);
  const parts = (colour) => [colour >> 16, (colour >> 8) & 255, colour & 255];
  const distance = (a, b) => parts(a).reduce((sum, value, k) => sum + (value - parts(b)[k]) ** 2, 0);
  const nearest = new Map([...counts.keys()].map((colour) => {
    const all = palette.map((one) => distance(colour, one));
    return [colour, all.indexOf(Math.min(...all))];
  }));
  const rows = Buffer.alloc((width + 1) * height);
  for (let y = 0; y < height; y += 1) {
    for (let x = 0; x < width; x += 1) rows[y * (width + 1) + x + 1] = nearest.get(colourAt(4 * (y * width + x)));
  }
  const chunk = (name, content) => {
    const body = Buffer.concat([Buffer.from(name), content]);
    const [length, sum] = [Buffer.alloc(4), Buffer.alloc(4)];
    length.writeUInt32BE(content.length);
    sum.writeUInt32BE(crc32(body));
    return Buffer.concat([length, body, sum]);
  };
  const head = Buffer.alloc(13);
  head.writeUInt32BE(width, 0);
  head.writeUInt32BE(height, 4);
  head.set([8, 3, 0, 0, 0], 8);
  const signature = Buffer.from([0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a]);
  return Buffer.concat([signature, chunk('IHDR', head), chunk('PLTE', Buffer.from(palette.flatMap(parts))),
    chunk('IDAT', deflateSync(rows, { level: 9 })), chunk('IEND', Buffer.alloc(0))]);
}

const blank = await (await browser.newContext()).newPage();
async function shoot(page, name, clip) {
  await page.evaluate(() => document.fonts.ready);
  await page.waitForTimeout(500);
  const shot = (await page.screenshot({ clip })).toString('base64');
  const pixels = await blank.evaluate(async (base64) => {
    const image = new Image();
    image.src = `data:image/png;base64,${base64}`;
    await image.decode();
    const { width, height } = image;
    const context = new OffscreenCanvas(width, height).getContext('2d');
    context.drawImage(image, 0, 0);
    return { width, height, data: [...context.getImageData(0, 0, width, height).data] };
  }, shot);
  writeFileSync(`${here}/pilot-${name}.png`, small(pixels));
}

async function shortest(person) {
  const { world, start } = person.view.predict;
  const table = await person.table(world);
  const costs = table.next.map((row) => row.map(() => 1));
  return bestPath({ table, costs }, start).actions.map((action) => table.actions[action].name);
}

await withDemonstration({ kith, browser }, async (people, { server }) => {
  const [first] = people;
  await first.at('Before you start');
  await shoot(first.page, 'consent', { x: 0, y: 0, width: look.width, height: 590 });
  await reach(people, ['predict']);
  await first.drive(await shortest(first));
  await shoot(first.page, 'predict');
  await first.button('Submit').click();
  await reach(people, ['feedback']);
  await shoot(first.page, 'feedback');
  const facilitator = await (await browser.newContext({ viewport: { width: 1100, height: 750 } })).newPage();
  await facilitator.goto(server.facilitator);
  await facilitator.waitForSelector('main section');
  await shoot(facilitator, 'facilitator');
  await facilitator.context().close();
}, { looks: [look] });
await browser.close();
