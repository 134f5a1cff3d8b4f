#!/usr/bin/env python3
"""Reads an MDP in another program's format, by a reader of its own, and prints the optimal value of every state.

usage: solve_mdp.py gym-json FILE DISCOUNT
       solve_mdp.py prism FILE.tra DISCOUNT FILE.trew=WEIGHT ...

Knows nothing of kith: a second opinion about what its exports mean. Standard library only.
"""
import json
import sys


def read_gym(path):
    """P[s][a] = [[probability, next state, reward, terminated], ...]."""
    table = json.load(open(path, encoding="utf-8"))["P"]
    states = {}
    for s, actions in table.items():
        assert len(actions) == len(table["0"])
        states[int(s)] = [[(p, t, r) for p, t, r, _ in outcomes] for outcomes in actions.values()]
    ends = {t for actions in table.values() for outcomes in actions.values() for _, t, _, end in outcomes if end}
    for s in ends:
        states[s] = []
    return states


def read_prism(path, rewards):
    """PRISM's .tra, with the weighted sum of .trew files as reward."""
    def rows(file):
        lines = [line.split() for line in open(file, encoding="utf-8") if not line.startswith("#")]
        header = [int(word) for word in lines[0]]
        assert len(lines) - 1 == header[2]
        return header, lines[1:]

    header, lines = rows(path)
    reward = {}
    for file, weight in rewards:
        size, entries = rows(file)
        assert size[:2] == header[:2]
        for s, c, t, x in entries:
            where = (int(s), int(c), int(t))
            reward[where] = reward.get(where, 0.0) + weight * float(x)
    states = {s: {} for s in range(header[0])}
    for s, c, t, p, *_ in lines:
        where = (int(s), int(c), int(t))
        states[int(s)].setdefault(int(c), []).append((float(p), int(t), reward.pop(where, 0.0)))
    assert not reward
    assert sum(len(choices) for choices in states.values()) == header[1]
    return {s: list(choices.values()) for s, choices in states.items()}


def solve(states, discount):
    """Value iteration until nothing changes any more."""
    for choices in states.values():
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


def main(arguments):
    kind, path, discount = arguments[:3]
    rewards = [argument.rsplit("=", 1) for argument in arguments[3:]]
    if kind == "prism":
        states = read_prism(path, [(file, float(weight)) for file, weight in rewards])
    else:
        states = read_gym(path)
    for value in solve(states, float(discount)):
        print(repr(value))


main(sys.argv[1:])
