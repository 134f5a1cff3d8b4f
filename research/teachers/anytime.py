#!/usr/bin/env python3
"""What people get wrong after every number of items, under each strategy: anytime curves.

usage: anytime.py KITH OUT.csv [--domains FILE...] [--teams 30] [--kinds KIND...] [--strategies NAME...]

Teams of three are taught and sit an exam over the whole domain after every period. The row of a strategy at k items is
the mean over teams of the exam after the last period within k items, carried on when a team has finished. The
strategies of the paper stop by their own rule; all others go on until 40 items.

Columns: domain, kind, strategy, k, regret, regret_se, share, share_se, teams.
"""
import argparse
import collections
import csv
import math
import pathlib
import statistics
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
ITEMS = (4, 8, 15, 25, 40)
PAPER = ("individual-low", "individual-high", "common", "joint")
WHOLE = ('teacher.scaffold="none"', 'stop.mastery="fixed"')
# Name, kind of strategy, settings.
STRATEGIES = [(name, name, ()) for name in PAPER]
STRATEGIES += [(f"{name}, whole", name, WHOLE) for name in ("joint", "common")]
STRATEGIES += [("joint, review", "joint", ("teacher.review=true",))]
STRATEGIES += [(name, name, WHOLE) for name in ("set-cover", "random", "highlights", "plan")]
BUILT_IN = ("item-delivery", "colored-tiles", "skateboard", "cookie-crumb", "two-goals", "rescue-floor",
            "icy-crossing", "lee2021-taxi", "lee2021-two-goals", "lee2021-skateboard", "navigation")
STUDY = """schema = "kith.study/1"
id = "anytime"
domain = "{domain}"
seed = 1
replicates = {teams}
[design]
strategies = ["{kind}"]
compositions = ["NNP"]
pairing = "replicate"
[learner.N]
{learner}ability = {{ mean = 0.703, sd = 0.034 }}
confirm_gain = {{ half_normal = 0.033 }}
correct_gain = {{ half_normal = 0.056 }}
[learner.P]
{learner}ability = {{ mean = 0.809, sd = 0.025 }}
confirm_gain = {{ half_normal = 0.022 }}
correct_gain = {{ half_normal = 0.052 }}
[stop]
periods_per_component = 20
max_periods = 40
[record]
level = "period"
exam = "period"
"""


def run(kith, domain, kind, settings, teams, learner):
    """Per team the exams after its periods: items so far, mean regret and share right of its members."""
    with tempfile.TemporaryDirectory() as folder:
        study = pathlib.Path(folder, "study.toml")
        learner = f'kind = "{learner}"\n' if learner != "bayesian" else ""
        study.write_text(STUDY.format(domain=domain, teams=teams, kind=kind, learner=learner))
        command = [kith, "study", study, "-o", f"{folder}/run", "-q", "--yes"]
        for setting in settings:
            command += ["--set", setting]
        subprocess.run(command, check=True, cwd=ROOT, stdout=subprocess.DEVNULL)
        items = collections.defaultdict(lambda: {0: 0})
        with open(f"{folder}/run/tables/periods.csv", newline="", encoding="utf-8") as table:
            for row in csv.DictReader(table):
                team = items[row["team"]]
                period = int(row["period"])
                team[period] = team[period - 1] + int(row["demonstrations"]) + int(row["tests"])
        grades = collections.defaultdict(lambda: collections.defaultdict(list))
        with open(f"{folder}/run/tables/exam.csv", newline="", encoding="utf-8") as table:
            for row in csv.DictReader(table):
                if not row["kc"]:
                    grades[row["team"]][int(row["period"])].append((float(row["regret"]), float(row["share_right"])))
        return [[(items[team][period], *map(statistics.fmean, zip(*members)))
                 for period, members in sorted(periods.items())] for team, periods in grades.items()]


def at(team, k):
    return [exam for exam in team if exam[0] <= k][-1][1:]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("kith")
    parser.add_argument("out")
    parser.add_argument("--domains", nargs="+", default=BUILT_IN)
    parser.add_argument("--teams", type=int, default=30)
    parser.add_argument("--kinds", nargs="+", default=["bayesian"])
    parser.add_argument("--strategies", nargs="+")
    arguments = parser.parse_args()
    with open(arguments.out, "w", newline="", encoding="utf-8") as out:
        table = csv.writer(out)
        table.writerow(["domain", "kind", "strategy", "k", "regret", "regret_se", "share", "share_se", "teams"])
        for domain in arguments.domains:
            for learner in arguments.kinds:
                for name, kind, settings in STRATEGIES:
                    if arguments.strategies and name not in arguments.strategies:
                        continue
                    teams = run(arguments.kith, domain, kind, settings, arguments.teams, learner)
                    for k in ITEMS:
                        row = []
                        for values in zip(*(at(team, k) for team in teams)):
                            error = statistics.stdev(values) / math.sqrt(len(values)) if len(values) > 1 else 0.0
                            row += [f"{statistics.fmean(values):.6g}", f"{error:.3g}"]
                        table.writerow([domain, learner, name, k, *row, len(teams)])
                    out.flush()
                    print(f"{domain}, {learner}: {name}", file=sys.stderr)


if __name__ == "__main__":
    main()
