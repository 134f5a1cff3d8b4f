// Synthetic beliefs: clouds that start spread over a hemisphere and gather at the true reward.
const normalise = (v) => v.map((x) => x / Math.hypot(...v));
const dot = (a, b) => a.reduce((sum, x, i) => sum + x * b[i], 0);

const truth = normalise([-3, 3.5, -1]);
const prior = [0, 0, -1]; // a step costs: the third weight is negative
const half = (normals) => (w) => normals.every((n) => dot(n, w) >= 0);

// Corners of the region around the truth, counter-clockwise seen from outside.
function ring(centre, radius, count, squash = 1) {
  const a = normalise(Math.abs(centre[2]) < 0.9 ? [centre[1], -centre[0], 0] : [1, 0, 0]);
  const b = [
    centre[1] * a[2] - centre[2] * a[1],
    centre[2] * a[0] - centre[0] * a[2],
    centre[0] * a[1] - centre[1] * a[0],
  ];
  return [...Array(count).keys()].map((i) => {
    const angle = (2 * Math.PI * i) / count;
    const [c, s] = [Math.cos(angle), squash * Math.sin(angle)];
    return normalise(centre.map((x, j) => Math.cos(radius) * x + Math.sin(radius) * (c * a[j] + s * b[j]))).map((x) =>
      Number(x.toFixed(6)),
    );
  });
}
const bec = ring(truth, 0.5, 5, 0.6);
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const becNormals = bec.map((p, i) => cross(p, bec[(i + 1) % bec.length]));

function team(random, { title, number, why, strategy, composition, components }) {
  const beliefs = [
    ...[...composition].map((letter, i) => ({
      name: `member ${i + 1} (${letter === 'N' ? 'novice' : 'proficient'})`,
      kind: 'own',
    })),
    { name: 'common belief', kind: 'common' },
    { name: 'joint belief', kind: 'joint' },
  ];
  const count = 120;
  const frames = components.length + 1;
  const data = new Int16Array(frames * beliefs.length * count * 3);
  const mass = [];
  let at = 0;
  const inBec = half(becNormals);
  for (let frame = 0; frame < frames; ++frame) {
    mass.push(
      beliefs.map((_, index) => {
        const pull = (frame * (1 + 0.25 * index)) / frames;
        let inside = 0;
        for (let i = 0; i < count; ++i) {
          let w;
          do {
            w = normalise([0, 1, 2].map((j) => 2.2 * pull * truth[j] + random.normal() * (1.05 - 0.6 * pull)));
          } while (dot(w, prior) < 0);
          inside += inBec(w) ? 1 : 0;
          for (const x of w) data[at++] = Math.round(32767 * x);
        }
        return Number((inside / count).toFixed(4));
      }),
    );
  }
  return {
    title,
    team: number,
    why,
    strategy,
    composition,
    periods: components.length,
    components,
    beliefs,
    mass,
    particles: { bits: 16, count, data: Buffer.from(data.buffer).toString('base64') },
  };
}

export function sampleBeliefs(random) {
  return {
    features: ['rubble', 'recharge', 'step'],
    truth,
    regions: [
      { label: 'policy (BEC)', outline: bec },
      { label: 'prior', outline: ring(prior, Math.PI / 2, 24) },
    ],
    teams: [
      team(random, {
        title: 'Team 181: individual high, NNP, replicate 1',
        number: 181,
        why: 'the median team',
        strategy: 'individual-high',
        composition: 'NNP',
        components: [1, 1, 2, 2, 3, 3],
      }),
      team(random, {
        title: 'Team 77: common, PPP, replicate 2',
        number: 77,
        why: 'the fastest team',
        strategy: 'common',
        composition: 'PPP',
        components: [1, 2, 3],
      }),
    ],
  };
}
