#!/usr/bin/env python3
"""Reads an MDP in another program's format, by a reader of its own, and prints the optimal value of every state.

usage: solve_mdp.py drn FILE DISCOUNT
       solve_mdp.py cassandra FILE
       solve_mdp.py gym-json FILE DISCOUNT
       solve_mdp.py prism FILE.tra DISCOUNT FILE.trew=WEIGHT ...

Knows nothing of kith: a second opinion about what its exports mean. Standard library only.
"""
import json
import re
import sys


def read_drn(path):
    """Storm's DRN with the reward model "reward": {state: [[(probability, next, reward), ...], ...]}."""
    lines = [line.rstrip("\n") for line in open(path, encoding="utf-8")]
    lines = [line for line in lines if not line.startswith("//")]
    assert "@type: MDP" in lines
    models = lines[lines.index("@reward_models") + 1].split()
    which = models.index("reward")
    num_states = int(lines[lines.index("@nr_states") + 1])
    num_choices = int(lines[lines.index("@nr_choices") + 1])
    states, choices = {}, 0
    state_reward = action_reward = 0.0
    for line in lines[lines.index("@model") + 1:]:
        rewards = re.search(r"\[(.*?)\]", line)
        if line.startswith("state "):
            current = states.setdefault(int(line.split()[1]), [])
            assert len(states) - 1 == int(line.split()[1])
            state_reward = float(rewards.group(1).split(",")[which])
        elif line.startswith("\taction "):
            action_reward = float(rewards.group(1).split(",")[which])
            current.append([])
            choices += 1
        elif line:
            target, probability = line.split(" : ")
            current[-1].append((float(probability), int(target), state_reward + action_reward))
    assert len(states) == num_states and choices == num_choices
    return states


def read_cassandra(path):
    """An MDP as pomdp.org has it, without observations; returns the discount too."""
    transitions, rewards = {}, {}
    discount = num_states = None
    actions = []
    for line in open(path, encoding="utf-8"):
        line = line.split("#")[0].strip()
        if not line:
            continue
        key, rest = line.split(":", 1)
        if key == "discount":
            discount = float(rest)
        elif key == "values":
            assert rest.strip() == "reward"
        elif key == "states":
            num_states = int(rest)
        elif key == "actions":
            actions = rest.split()
            assert all(re.fullmatch(r"[A-Za-z][A-Za-z0-9_-]*", name) for name in actions)
        elif key in ("T", "R"):
            action, state, last = rest.split(":")
            target, number = last.split()
            assert re.fullmatch(r"-?\d+\.\d+", number), number
            table = transitions if key == "T" else rewards
            where = (int(state), int(action), int(target))
            assert where not in table
            table[where] = float(number)
    states = {s: [[] for _ in actions] for s in range(num_states)}
    for (s, a, t), probability in transitions.items():
        states[s][a].append((probability, t, rewards.pop((s, a, t), 0.0)))
    assert not rewards
    return states, discount


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
    kind, path = arguments[:2]
    if kind == "cassandra":
        states, discount = read_cassandra(path)
    else:
        discount = float(arguments[2])
        if kind == "prism":
            rewards = [argument.rsplit("=", 1) for argument in arguments[3:]]
            states = read_prism(path, [(file, float(weight)) for file, weight in rewards])
        else:
            states = {"drn": read_drn, "gym-json": read_gym}[kind](path)
    for value in solve(states, discount):
        print(repr(value))


main(sys.argv[1:])
