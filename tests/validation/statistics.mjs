// The few statistics that the page needs beside those of `kith analyze`.

const sum = (values) => values.reduce((total, value) => total + value, 0);
export const mean = (values) => sum(values) / values.length;

export function variance(values) {
  const center = mean(values);
  return sum(values.map((value) => (value - center) ** 2)) / (values.length - 1);
}

export const sd = (values) => Math.sqrt(variance(values));
export const errorOfMean = (values) => sd(values) / Math.sqrt(values.length);

// Standard error of a standard deviation of normal values.
export const errorOfSd = (deviation, n) => deviation / Math.sqrt(2 * (n - 1));

// Pearson's correlation, with its standard error if both are normal.
export function correlation(x, y) {
  const [centerX, centerY] = [mean(x), mean(y)];
  const product = sum(x.map((one, i) => (one - centerX) * (y[i] - centerY)));
  const value = product / ((x.length - 1) * sd(x) * sd(y));
  return { value, se: (1 - value ** 2) / Math.sqrt(x.length - 1) };
}

export const share = (hits, n) => ({ value: hits / n, se: Math.sqrt(((hits / n) * (1 - hits / n)) / n) });

// The area under the receiver operating characteristic curve: how probably one of `positive` is larger than one of
// `negative`; with Hanley and McNeil's standard error.
export function areaUnderCurve(negative, positive) {
  const sorted = [...negative].sort((a, b) => a - b);
  const below = (value, orEqual) => {
    let [low, high] = [0, sorted.length];
    while (low < high) {
      const middle = (low + high) >> 1;
      if (orEqual ? sorted[middle] <= value : sorted[middle] < value) low = middle + 1;
      else high = middle;
    }
    return low;
  };
  const value = mean(positive.map((one) => (below(one, false) + below(one, true)) / 2)) / negative.length;
  const [q1, q2] = [value / (2 - value), (2 * value ** 2) / (1 + value)];
  const spread = value * (1 - value) + (positive.length - 1) * (q1 - value ** 2) + (negative.length - 1) * (q2 - value ** 2);
  return { value, se: Math.sqrt(spread / (positive.length * negative.length)) };
}

export function groupBy(rows, key) {
  const groups = new Map();
  for (const row of rows) {
    const name = key(row);
    if (!groups.has(name)) groups.set(name, []);
    groups.get(name).push(row);
  }
  return groups;
}

// Number, sum and sum of squares of values, to which sets of values can be added and from which
// they can be taken away. Values are shifted by a constant, which keeps the digits of variances.
export class Moments {
  constructor(n = 0, total = 0, squares = 0, shift = 0) {
    Object.assign(this, { n, total, squares, shift });
  }
  static of(values, shift = 0) {
    const shifted = values.map((value) => value - shift);
    return new Moments(values.length, sum(shifted), sum(shifted.map((value) => value * value)), shift);
  }
  plus(other, sign = 1) {
    return new Moments(this.n + sign * other.n, this.total + sign * other.total, this.squares + sign * other.squares, this.shift);
  }
  mean() {
    return this.shift + this.total / this.n;
  }
  variance() {
    return (this.squares - (this.total * this.total) / this.n) / (this.n - 1);
  }
  sd() {
    return Math.sqrt(this.variance());
  }
}

// Estimates by name, with standard errors: the jackknife that leaves out one group of people at a
// time, within strata (compositions). All teams of the same people are left out together.
//
// `teams` have a stratum, a person (which identifies the people within the stratum), a cell and a
// value; `estimate` maps {"stratum cell": Moments} to {name: number}.
export function jackknife(teams, estimate) {
  const shift = mean(teams.map((team) => team.value));
  const cells = {};
  const strata = groupBy(teams, (team) => team.stratum);
  for (const [name, members] of groupBy(teams, (team) => `${team.stratum} ${team.cell}`)) {
    cells[name] = Moments.of(members.map((team) => team.value), shift);
  }
  const full = estimate(cells);
  const names = Object.keys(full);
  const squares = Object.fromEntries(names.map((name) => [name, 0]));
  for (const [stratum, members] of strata) {
    const people = [...groupBy(members, (team) => team.person).values()];
    const without = people.map((group) => {
      const rest = { ...cells };
      for (const team of group) {
        const cell = `${stratum} ${team.cell}`;
        rest[cell] = rest[cell].plus(Moments.of([team.value], shift), -1);
      }
      return estimate(rest);
    });
    for (const name of names) {
      const values = without.map((one) => one[name]);
      const center = mean(values);
      squares[name] += ((people.length - 1) / people.length) * sum(values.map((value) => (value - center) ** 2));
    }
  }
  return Object.fromEntries(names.map((name) => [name, { value: full[name], se: Math.sqrt(squares[name]) }]));
}

function logGamma(x) {  // Lanczos, g = 7
  const c = [
    0.99999999999980993, 676.5203681218851, -1259.1392167224028, 771.32342877765313, -176.61502916214059,
    12.507343278686905, -0.13857109526572012, 9.9843695780195716e-6, 1.5056327351493116e-7,
  ];
  const y = x - 1;
  const series = c.slice(1).reduce((total, one, k) => total + one / (y + k + 1), c[0]);
  const t = y + 7.5;
  return 0.5 * Math.log(2 * Math.PI) + (y + 0.5) * Math.log(t) - t + Math.log(series);
}

// Regularised incomplete beta function by its continued fraction (Lentz).
function incompleteBeta(a, b, x) {
  if (x <= 0) return 0;
  if (x >= 1) return 1;
  if (x > (a + 1) / (a + b + 2)) return 1 - incompleteBeta(b, a, 1 - x);
  const front = Math.exp(logGamma(a + b) - logGamma(a) - logGamma(b) + a * Math.log(x) + b * Math.log1p(-x)) / a;
  const away = (value) => (Math.abs(value) < 1e-300 ? 1e-300 : value);
  let c = 1;
  let d = 1 / away(1 - ((a + b) * x) / (a + 1));
  let fraction = d;
  for (let m = 1; m < 500; ++m) {
    const even = (m * (b - m) * x) / ((a + 2 * m - 1) * (a + 2 * m));
    d = 1 / away(1 + even * d);
    c = away(1 + even / c);
    fraction *= d * c;
    const odd = (-(a + m) * (a + b + m) * x) / ((a + 2 * m) * (a + 2 * m + 1));
    d = 1 / away(1 + odd * d);
    c = away(1 + odd / c);
    fraction *= d * c;
    if (Math.abs(d * c - 1) < 1e-14) break;
  }
  return front * fraction;
}

// P(F <= f) of the non-central F distribution: a Poisson mixture of beta distributions.
function lowerTailOfNoncentralF(f, df1, df2, lambda) {
  const x = (df1 * f) / (df1 * f + df2);
  let total = 0;
  const last = Math.ceil(lambda / 2 + 12 * Math.sqrt(lambda / 2 + 1) + 20);
  for (let j = 0; j <= last; ++j) {
    const weight = lambda > 0 ? Math.exp(-lambda / 2 + j * Math.log(lambda / 2) - logGamma(j + 1)) : j === 0 ? 1 : 0;
    if (weight > 1e-16) total += weight * incompleteBeta(df1 / 2 + j, df2 / 2, x);
  }
  return total;
}

// Partial eta squared of an F test, with the 95 % interval of the non-central F distribution
// (non-centrality over itself plus the number of observations).
export function partialEtaSquared(f, df1, df2) {
  const observations = df1 + df2 + 1;
  const bound = (tail) => {
    if (lowerTailOfNoncentralF(f, df1, df2, 0) < tail) return 0;
    let low = 0;
    let high = 10 * df1 * f + 100;
    for (let step = 0; step < 60; ++step) {
      const middle = (low + high) / 2;
      if (lowerTailOfNoncentralF(f, df1, df2, middle) > tail) low = middle;
      else high = middle;
    }
    return low / (low + observations);
  };
  return { value: (f * df1) / (f * df1 + df2), low: bound(0.975), high: bound(0.025) };
}
