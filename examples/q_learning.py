#!/usr/bin/env python3
"""Trains an agent by Q-learning on an explicit model of kith (CSV) and writes what it does as a policy for `kith infer`.

    q_learning.py domains/gallery/frozen_lake hole=-100 step=-1 -o policy.csv

The first argument is what the names of the model's files begin with; the others are the rewards that the agent is
trained with, which kith does not get to see. Needs nothing but Python.
"""

import argparse
import csv
import random
from collections import defaultdict


def read(prefix, rewards):
    """Terminal states, and outcomes[world][state][action] = [(probability, next, reward)]."""
    with open(f"{prefix}_states.csv", newline="") as file:
        terminal = {(row.get("mdp", ""), row["state"]) for row in csv.DictReader(file) if row["terminal"] == "true"}
    ends = {state for _, state in terminal}
    outcomes = defaultdict(lambda: defaultdict(lambda: defaultdict(list)))
    with open(f"{prefix}_transitions.csv", newline="") as file:
        for row in csv.DictReader(file):
            reward = sum(weight * float(row[name]) for name, weight in rewards.items())
            outcomes[row.get("mdp", "")][row["state"]][row["action"]].append(
                (float(row.get("probability") or 1), row["next"], reward))
    return ends, outcomes


def train(model, ends, episodes, explore, draw):
    """The values of the actions, from episodes that begin anywhere."""
    q = {state: dict.fromkeys(actions, 0.0) for state, actions in model.items()}
    visits = defaultdict(int)
    states = sorted(model)
    for _ in range(episodes):
        state = draw.choice(states)
        for _ in range(200):
            actions = q[state]
            action = draw.choice(list(actions)) if draw.random() < explore else max(actions, key=actions.get)
            lot = draw.random()
            for probability, after, reward in model[state][action]:
                lot -= probability
                if lot < 0:
                    break
            visits[state, action] += 1
            rate = visits[state, action] ** -0.7
            rest = 0.0 if after in ends else max(q[after].values())
            actions[action] += rate * (reward + rest - actions[action])
            if after in ends:
                break
            state = after
    return q


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("model")
    parser.add_argument("reward", nargs="+", help="FEATURE=REWARD")
    parser.add_argument("-o", "--out", required=True)
    parser.add_argument("--episodes", type=int, default=40_000)
    parser.add_argument("--explore", type=float, default=0.2)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    rewards = {name: float(value) for name, value in (one.split("=") for one in options.reward)}
    ends, worlds = read(options.model, rewards)
    draw = random.Random(options.seed)
    with open(options.out, "w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["world", "state", "action"])
        for number, world in enumerate(worlds):
            q = train(worlds[world], ends, options.episodes, options.explore, draw)
            for state in sorted(q):
                table.writerow([number, state, max(q[state], key=q[state].get)])


if __name__ == "__main__":
    main()
