#!/usr/bin/env python3
"""Fits what a study leaves open to published figures: calibrate.py STUDY TARGETS (studies/paper-targets.toml is one).

A [[target]] has a value and its standard error, or sd and n, or n, or a tolerance. Three Latin hypercubes of settings are
simulated, each around what fitted before; quadratics stand for the figures. The misfit is chi squared with a model
discrepancy tau [kennedy2001] at which the least misfit equals its degrees of freedom [paule1982]. The answer is simulated
again with other people. Needs kith, pandas and scipy.
"""
import argparse
import itertools
import tomllib

import kith
import numpy as np
from scipy import optimize, stats

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("study")
parser.add_argument("targets")
parser.add_argument("--points", type=int, default=64, help="settings of a round")
parser.add_argument("--teams", type=int, default=40, help="teams per cell and setting in the last round")
parser.add_argument("--confirm", type=int, default=200, help="teams per cell that confirm the answer")
args = parser.parse_args()
with open(args.targets, "rb") as file:
    published = tomllib.load(file)
targets, parameters = published["target"], published["parameter"]
letters = tomllib.loads(kith.resolve(args.study))["learner"]


def on_scale(parameter, unit):  # of a unit in [0, 1]
    low, high = parameter["min"], parameter["max"]
    value = low * (high / low) ** unit if parameter.get("scale") == "log" else low + (high - low) * unit
    return round(value) if parameter.get("integer") else float(value)


def simulate(point, teams, seed):
    settings = {"seed": seed, "replicates": teams, "record.level": "team"}
    for parameter, unit in zip(parameters, point):
        for key in parameter["keys"]:
            settings.update({key.replace("*", letter): on_scale(parameter, unit) for letter in letters})
    run = kith.study(args.study, progress=False, **settings)  # its tables go when it does
    return np.array([figure_of(target, run.tables["teams"]) for target in targets])


def figure_of(target, teams):
    if target.get("statistic") == "F":  # the mean of the non-central F with the effect of the simulated teams [johnson1995]
        quantity, term = target["effect"].split(": ")
        cells = teams[teams.strategy != "baseline"].groupby(["strategy", "composition"])[quantity]
        means, within, n = cells.mean().unstack(), cells.var().mean(), cells.size().iloc[0]
        effect = means.mean(axis=0 if term == "composition" else 1) - means.values.mean()
        df1, df2 = target["df"]
        explained = max(0.0, (effect**2).sum() * means.size / len(effect) - df1 * within / n)  # without what chance adds
        return df2 * (df1 + explained / within * (df2 / means.size + 1)) / (df1 * (df2 - 2))
    who, _, composition = target["teams"].partition("/")
    some = teams[(teams.strategy != "baseline") if who == "group" else (teams.strategy == who)]
    values = some[some.composition == composition] if composition else some
    return getattr(values[target["quantity"]].astype(float), target.get("statistic", "mean").replace("sd", "std"))()


def error_of(target):
    if target.get("statistic") == "F":
        df1, df2 = target["df"]
        return stats.ncf(df1, df2, max(1e-9, target["value"] * df1 * (df2 - 2) / df2 - df1)).std()
    if "standard_error" in target:
        return target["standard_error"]
    if "n" in target:
        return target["sd"] / target["n"] ** 0.5 if "sd" in target else target["value"] / (2 * (target["n"] - 1)) ** 0.5
    return (target["tolerance"] if "tolerance" in target else target["value"] * np.log(target["within_factor"])) / 2


def features(points):
    pairs = itertools.combinations_with_replacement(range(len(parameters)), 2)
    points = 2 * np.atleast_2d(points) - 1
    return np.column_stack([np.ones(len(points)), points, *(points[:, i] * points[:, j] for i, j in pairs)])


def least(tau2, fixed=None):  # the least misfit, one parameter fixed if wanted
    bounds = [(fixed[1],) * 2 if fixed and fixed[0] == k else (a, b) for k, (a, b) in enumerate(zip(*box))]
    tries = [np.clip(one, *np.array(bounds).T) for one in points[order[:5]]]
    misfit = lambda point: (((features(point) @ weights)[0] ** 2) / (1 + noise + tau2)).sum()
    return min((optimize.minimize(misfit, one, bounds=bounds) for one in tries), key=lambda found: found.fun)


value, error = np.array([target["value"] for target in targets]), np.array([error_of(target) for target in targets])
box, df = (np.zeros(len(parameters)), np.ones(len(parameters))), max(1, len(targets) - len(parameters))
for number in (1, 2, 3):
    cube = stats.qmc.LatinHypercube(len(parameters), seed=number).random(args.points)
    points, teams = box[0] + (box[1] - box[0]) * cube, max(2, args.teams * number // 3)
    misses = np.array([(simulate(point, teams, 1) - value) / error for point in points])
    x = features(points)
    inverse = np.linalg.inv(x.T @ x + 1e-3 * np.eye(x.shape[1])) @ x.T  # ridge
    weights, leverage = inverse @ misses, np.einsum("ij,ji->i", x, inverse)
    noise = (((misses - x @ weights) / (1 - leverage)[:, None]) ** 2).mean(axis=0)  # of settings left out
    misfits = (misses**2 / (1 + noise)).sum(axis=1)
    order = np.argsort(misfits)
    tau2 = optimize.brentq(lambda t: least(t).fun - df, 0, 1e6) if least(0).fun > df else 0.0
    best = least(tau2)
    print(f"round {number}: {args.points} settings of {teams} teams per cell, least misfit {least(0).fun:.1f}", flush=True)
    fits = ((x @ weights) ** 2 / (1 + noise + tau2)).sum(axis=1) < best.fun + 12
    near = points[order[: max(len(parameters) + 1, fits.sum())]]
    if number < 3:
        box = np.maximum(near.min(axis=0) - 0.05, 0), np.minimum(near.max(axis=0) + 0.05, 1)

limit = stats.t.ppf(0.975, df) ** 2 if tau2 else stats.chi2.ppf(0.95, 1)
print(f"\nmodel discrepancy {tau2**0.5:.1f} published standard errors\nparameter         value   95 % interval, others adjusted")
for k, parameter in enumerate(parameters):
    inside = [u for u in np.linspace(box[0][k], box[1][k], 21) if least(tau2, (k, u)).fun <= best.fun + limit]
    shown = [on_scale(parameter, u) for u in (best.x[k], min(inside, default=best.x[k]), max(inside, default=best.x[k]))]
    print("{:16} {:6.3g}   {:.3g} .. {:.3g}".format(parameter["name"], *shown))
print(f"\nwith {args.confirm} other teams per cell     published    model   off by")
for target, found, se in zip(targets, simulate(best.x, args.confirm, 2), error):
    name = target.get("statistic", "mean") + " of " + (target.get("effect") or f"{target['quantity']}, {target['teams']}")
    print(f"{name:34} {target['value']:9.3f} {found:8.3f} {(found - target['value']) / se:+6.1f} se")
