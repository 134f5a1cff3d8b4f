#!/usr/bin/env python3
"""Prints the optimal value of every state of an MDP.

usage: solve_mdp.py FILE NUM_STATES DISCOUNT

FILE has a line for every outcome: state, action, probability, next state, reward. Knows nothing of kith: a second opinion
about what it plans. Standard library only.
"""
import sys


def solve(states, discount):
    """Value iteration until nothing changes any more."""
    for choices in states:
        for outcomes in choices:
            assert abs(sum(p for p, _, _ in outcomes) - 1.0) < 1e-9
    values = [0.0] * len(states)
    for _ in range(1_000_000):
        change = 0.0
        for s in range(len(states)):
            if not states[s]:
                continue
            best = max(sum(p * (r + discount * values[t]) for p, t, r in outcomes) for outcomes in states[s])
            change = max(change, abs(best - values[s]))
            values[s] = best
        if change <= 1e-13 * max(1.0, max(abs(v) for v in values)):
            return values
    raise SystemExit("no convergence")


def main(path, num_states, discount):
    states = [{} for _ in range(int(num_states))]
    for line in open(path, encoding="utf-8"):
        s, a, p, t, r = line.split()
        states[int(s)].setdefault(a, []).append((float(p), int(t), float(r)))
    for value in solve([list(choices.values()) for choices in states], float(discount)):
        print(repr(value))


main(*sys.argv[1:])
