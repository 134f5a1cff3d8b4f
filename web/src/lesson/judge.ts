// Says whether a path is right, as kith does (docs/model.md): by what it is worth to the robot, not by its actions.
import { countsAt, type WorldDocument } from '../shared/play/world';

export interface Judge {
  exact: boolean; // counts are whole numbers, and so is what decides
  weights: string[]; // integers
  unit: number[]; // of length 1
  scale: number; // counts of the robot are in units of 1 / scale
  discount: number;
}

// Also the robot's actions, and what it counts from every state on, where chance or discounting have a part.
export interface JudgedWorld extends WorldDocument {
  robot?: number[];
  ahead?: number[][];
}

export interface Verdict {
  isFinished: boolean;
  counts: number[] | null; // nothing unless it is finished
  isRight: boolean;
}

const kRelativeError = 1e-6;

// `repeatsFrom`: the path goes round for ever from that step on.
export function judgePath(
  judge: Judge,
  world: JudgedWorld,
  robot: number[],
  start: number,
  actions: number[],
  repeatsFrom: number | null = null,
): Verdict {
  const states = [start];
  for (const action of actions) {
    const next = world.next[states[states.length - 1] ?? start]?.[action] ?? -1;
    if (next < 0) return { isFinished: false, counts: null, isRight: false };
    states.push(next);
  }
  const isEnd = world.end[states[states.length - 1] ?? start] ?? false;
  const isFinished = repeatsFrom === null ? isEnd : judge.discount < 1;
  if (!isFinished) return { isFinished, counts: null, isRight: false };
  const isRobots = world.robot !== undefined && actions.every((action, t) => action === world.robot?.[states[t] ?? -1]);
  const counts = isRobots ? robot : judge.exact ? summed(world, states, actions) : expected(judge, world, states, actions, repeatsFrom);
  return { isFinished, counts, isRight: isAsGood(judge, robot, counts) };
}

export const isAsGood = (judge: Judge, robot: number[], counts: number[]): boolean =>
  judge.exact ? lossOf(judge, robot, counts) <= 0n : isNearlyAsGood(judge, robot, counts);

function lossOf({ weights }: Judge, robot: number[], counts: number[]): bigint {
  return weights.reduce((sum, weight, k) => sum + BigInt(weight) * BigInt((robot[k] ?? 0) - (counts[k] ?? 0)), 0n);
}

// Expectations are known up to rounding and to the accuracy of the robot's plan.
function isNearlyAsGood(judge: Judge, robot: number[], counts: number[]): boolean {
  const { unit, scale } = judge;
  const dot = (values: number[]): number => unit.reduce((sum, weight, k) => sum + weight * (values[k] ?? 0), 0);
  const loss = dot(robot.map((n, k) => n - (counts[k] ?? 0)));
  if (lossOf(judge, robot, counts) <= 0n) return true;
  const value = Math.abs(dot(robot)) / scale;
  const rounding = (2 * Math.sqrt(robot.length)) / scale;
  return Math.abs(loss) / scale <= Math.max(kRelativeError * Math.max(1, value), rounding);
}

function summed(world: WorldDocument, states: number[], actions: number[]): number[] {
  const sums = (world.kinds?.[0] ?? []).map(() => 0);
  actions.forEach((action, t) => {
    countsAt(world, states[t] ?? -1, action)?.forEach((n, k) => (sums[k] = (sums[k] ?? 0) + n));
  });
  return sums;
}

// Whether a first action is as good as the robot's own, if the robot goes on as ever. Only where expectations decide.
export function judgeMove(judge: Judge, world: JudgedWorld, robot: number[], start: number, action: number): Verdict {
  const counts = world.robot?.[start] === action ? robot : expected(judge, world, [start, -1], [action], null);
  return { isFinished: true, counts, isRight: isAsGood(judge, robot, counts) };
}

// What is to be expected if the robot takes these actions for as long as it is where the path has it, and its own from
// then on.
function expected(judge: Judge, world: JudgedWorld, states: number[], actions: number[], repeatsFrom: number | null): number[] {
  const d = judge.unit.length;
  let ahead = Array.from({ length: d }, () => 0);
  const goBack = (t: number): number => {
    const here = Array.from({ length: d }, () => 0);
    let weight = 0;
    for (const [next, probability, features] of world.outcomes?.[states[t] ?? -1]?.[actions[t] ?? -1] ?? []) {
      const isExpected = next === states[t + 1];
      if (isExpected) weight += probability * judge.discount;
      for (let k = 0; k < d; k += 1) {
        const rest = isExpected ? (ahead[k] ?? 0) : world.end[next] ? 0 : (world.ahead?.[next]?.[k] ?? 0) / judge.scale;
        here[k] = (here[k] ?? 0) + probability * ((features[k] ?? 0) + judge.discount * rest);
      }
    }
    ahead = here;
    return weight;
  };
  if (repeatsFrom !== null) {
    let weight = 1;
    for (let t = actions.length - 1; t >= repeatsFrom; t -= 1) weight *= goBack(t);
    ahead = ahead.map((m) => m / (1 - weight));
  }
  for (let t = actions.length - 1; t >= 0; t -= 1) goBack(t);
  return ahead.map((m) => Math.round(m * judge.scale));
}
