#!/usr/bin/env python3
"""Which model predicts people's answers best? predict.py lee2021_test_responses.csv, the public answers of [lee2021].

Every answer is predicted from the person's answers before and from all other people, in ten folds of people. Loss is
-log p(what was answered), per answer, with its standard error over people. Needs numpy.

To add a model, write a class as below and put it into MODELS: Model(answers, items) learns from other people, answers a
list of (item, right) per person and items their names; right(before, item) is the probability of a right answer of
somebody with the answers `before`. The robot's side of a world is in kith.Domain("domains/lee2021_taxi.toml") and alike.
"""
import csv
import sys

import numpy as np

WEIGHT, FOLDS = 2.0, 10  # answers that a mean counts as; parts of the people


class ShareOfOthers:
    def __init__(self, answers, items):
        self.share = np.mean([right for person in answers for _, right in person])

    def right(self, before, item):
        return self.share


class ShareOfWorld(ShareOfOthers):
    def __init__(self, answers, items):
        super().__init__(answers, items)
        self.of = {}
        for item in items:
            rights = [right for person in answers for name, right in person if name == item]
            self.of[item] = (sum(rights) + WEIGHT * self.share) / (len(rights) + WEIGHT)

    def right(self, before, item):
        return self.of[item]


class OwnShare(ShareOfOthers):
    def right(self, before, item):
        return (sum(right for _, right in before) + WEIGHT * self.share) / (len(before) + WEIGHT)


class Rasch:
    """P(right) = 1 / (1 + exp(difficulty - ability)), abilities normal [rasch1960], by marginal maximum likelihood."""

    def __init__(self, answers, items):
        self.number = {item: i for i, item in enumerate(items)}
        self.nodes = np.linspace(-6, 6, 61)
        self.difficulty, self.sd = np.zeros(len(items)), 1.0
        asked, right = np.zeros((2, len(answers), len(items)))
        for p, person in enumerate(answers):
            for item, is_right in person:
                asked[p, self.number[item]] += 1
                right[p, self.number[item]] += is_right
        for _ in range(100):
            chance = self.chances()
            logs = right @ np.log(chance) + (asked - right) @ np.log(1 - chance) + self.prior()
            mass = np.exp(logs - logs.max(axis=1, keepdims=True))
            mass /= mass.sum(axis=1, keepdims=True)
            self.sd = np.sqrt((mass @ self.nodes**2).mean())
            expected = asked.T @ mass  # shape [items, nodes]
            slope = (expected * chance).sum(axis=1) - right.sum(axis=0) - self.difficulty / 9  # weak prior N(0, 3^2)
            self.difficulty += slope / ((expected * chance * (1 - chance)).sum(axis=1) + 1 / 9)

    def prior(self):
        return -((self.nodes / self.sd) ** 2) / 2

    def chances(self):
        return 1 / (1 + np.exp(self.difficulty[:, None] - self.nodes))

    def right(self, before, item):
        chance, logs = self.chances(), self.prior()
        for name, is_right in before:
            one = chance[self.number[name]]
            logs = logs + np.log(one if is_right else 1 - one)
        mass = np.exp(logs - logs.max())
        return (mass / mass.sum()) @ chance[self.number[item]]


MODELS = [ShareOfOthers, ShareOfWorld, OwnShare, Rasch]

people, items = {}, {}
with open(sys.argv[1], newline="", encoding="utf-8") as file:
    for row in csv.DictReader(file):
        items[row["mdp_id"]] = None
        people.setdefault((row["experiment"], row["participant"]), []).append((row["mdp_id"], int(row["optimal_response"])))
answers = list(people.values())
print(f"{sum(map(len, answers))} answers of {len(answers)} people\nmodel             loss     +-")
for kind in MODELS:
    losses = np.zeros(len(answers))
    for fold in range(FOLDS):
        model = kind([person for p, person in enumerate(answers) if p % FOLDS != fold], list(items))
        for p in range(fold, len(answers), FOLDS):
            told = [model.right(answers[p][:t], item) for t, (item, _) in enumerate(answers[p])]
            losses[p] = -np.mean([np.log(q if right else 1 - q) for q, (_, right) in zip(told, answers[p])])
    print(f"{kind.__name__:14} {losses.mean():7.3f} {losses.std(ddof=1) / len(losses) ** 0.5:6.3f}")
