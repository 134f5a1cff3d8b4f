#!/usr/bin/env python3
"""What people get wrong after every number of items, under each strategy: anytime curves.

usage: anytime.py KITH OUT.csv [--domains FILE...] [--random N] [--teams 30] [--kinds KIND...] [--strategies NAME...]
       anytime.py --summary OUT.csv...
       anytime.py --page OUT.csv... [--note TEXT] > anytime.md

Teams of three are taught and sit an exam over the whole domain after every period. The row of a strategy at k items is
the mean over teams of the exam after the last period within k items, carried on when a team has finished. The
strategies of the paper stop by their own rule; all others go on until 40 items. --random N takes N grids of two or three
features, by chance. --summary says where "plan" is first: at most 1.1 times the regret of the best other strategy, or
not more beyond two standard errors; and the median of its regret as a share of theirs. --page writes that for people.

Columns: domain, kind, strategy, k, regret, regret_se, share, share_se, teams.
"""
import argparse
import collections
import csv
import itertools
import math
import pathlib
import random
import statistics
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
ITEMS = (4, 8, 15, 25, 40)
SHOWN = (4, 15, 40)  # on the page
PAPER = ("individual-low", "individual-high", "common", "joint")
WHOLE = ('teacher.scaffold="none"', 'stop.mastery="fixed"')
# Name, kind of strategy, settings.
STRATEGIES = [(name, name, ()) for name in PAPER]
STRATEGIES += [(f"{name}, whole", name, WHOLE) for name in ("joint", "common")]
STRATEGIES += [("joint, review", "joint", ("teacher.review=true",))]
STRATEGIES += [(name, name, WHOLE) for name in ("set-cover", "random", "highlights", "plan")]
BUILT_IN = ("item-delivery", "colored-tiles", "skateboard", "cookie-crumb", "two-goals", "rescue-floor",
            "icy-crossing", "navigation", "warehouse")
FILES = ("lee2021_taxi", "lee2021_two_goals", "lee2021_skateboard", "gallery/cliff_walking", "gallery/four_rooms",
         "gallery/frozen_lake", "gallery/frozen_lake_8x8", "gallery/taxi")
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
        subprocess.run(command, check=True, cwd=ROOT, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
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


def random_domain(number, folder):
    """A file with a grid of random terrains and weights; everything optional appears or not."""
    draw = random.Random(number)
    terrains = "ab"[: draw.choice((1, 2, 2))]
    width, height = draw.randint(4, 6), draw.randint(3, 5)
    cells = [[draw.choices("." + terrains + terrains.upper() + "#", [8] + [1] * 2 * len(terrains) + [1])[0]
              for _ in range(width)] for _ in range(height)]
    cells[draw.randrange(height)][width - 1] = "G"
    cells[draw.randrange(height)][0] = "S"
    for letter in terrains:
        cells[draw.randrange(height)][draw.randrange(1, width - 1)] = letter
    rows = ",\n".join(f'"{"".join(row)}"' for row in cells)
    legend = "".join(f'{letter} = {{ terrain = "{letter}" }}\n{letter.upper()} = {{ terrain = "{letter}", '
                     f'optional = "more-{letter}" }}\n' for letter in terrains)
    features = "".join(f'[[feature]]\nname = "{letter}"\nwhen = "enter:{letter}"\n' for letter in terrains)
    weights = ", ".join(f"{letter} = {-draw.choice((0.5, 1.5, 2.5, 4.5))}" for letter in terrains)
    prior = ", ".join(f"{{ {name} = -1 }}" for name in [*terrains, "step"])
    file = pathlib.Path(folder, f"random-{number}.toml")
    file.write_text(f'schema = "kith.domain/1"\nid = "random-{number}"\n[mdp]\ndiscount = 1.0\nmax_steps = 60\n'
                    f'[map]\nrows = [{rows}]\n[map.legend]\n"." = "floor"\n"#" = "wall"\nG = {{ goal = true }}\nS = {{ start = true }}\n'
                    f'{legend}{features}[[feature]]\nname = "step"\nwhen = "action"\n[reward]\n'
                    f'weights = {{ {weights}, step = -1 }}\n[prior]\nhalfspaces = [{prior}]\n', encoding="utf-8")
    return file


def random_domains(kith, n, folder):
    """The first n of them that can be taught."""
    files = []
    for number in range(1, 10 * n):
        file = random_domain(number, folder)
        try:
            run(kith, file, "joint", (), 1, "bayesian")
        except subprocess.CalledProcessError:
            continue  # there is nothing to teach
        files.append(file)
        if len(files) == n:
            break
    return files


def read_cells(files):
    """{(domain, kind, k): {strategy: (regret, its standard error)}}"""
    cells = collections.defaultdict(dict)
    for file in files:
        with open(file, newline="", encoding="utf-8") as table:
            for row in csv.DictReader(table):
                cells[row["domain"], row["kind"], int(row["k"])][row["strategy"]] = (
                    float(row["regret"]), float(row["regret_se"]))
    return dict(sorted(cells.items()))


def compare(regrets):
    """Of a cell: regret and error of plan, the best other strategy with its own, and whether plan loses."""
    plan, error = regrets["plan"]
    name, (best, best_error) = min((one for one in regrets.items() if one[0] != "plan"), key=lambda one: one[1])
    lost = plan > 1.1 * best and plan - best > 2 * math.hypot(error, best_error)
    return plan, error, name, best, best_error, lost


def summary(cells):
    """Sentences: in how many cells plan is first, what it loses, its share of the best other regret."""
    lost, ratios = [], collections.defaultdict(list)
    for cell, regrets in cells.items():
        plan, error, name, best, best_error, is_lost = compare(regrets)
        if best > 1e-9:
            ratios[cell[2]].append(plan / best)
        if is_lost:
            lost.append(f"{', '.join(map(str, cell))}: {plan:.4g} ({error:.2g}), {name} {best:.4g} ({best_error:.2g})")
    medians = [f"{k} items: median of {len(values)} ratios to the best other {statistics.median(values):.2g}"
               for k, values in sorted(ratios.items())]
    return f"first in {len(cells) - len(lost)} of {len(cells)} cells", lost, medians


def page(cells, note):
    first, lost, medians = summary(cells)
    print("# Regret after every number of items\n\nMade by `anytime.py --page`. Regret of `plan` and of the best other "
          "strategy at that number of items, which is\nnamed; in bold where `plan` loses: more than 1.1 times as much, "
          f"and beyond two standard errors.\n\n{note}`plan` is {first}.\n")
    print(*(f"* {median}" for median in medians), sep="\n")
    names = list(dict.fromkeys(cell[:2] for cell in cells))
    print("\nOf domains made by chance, the table has those in which `plan` loses.\n\n| domain |",
          *(f" {k} |" for k in SHOWN), "\n|---|", "---|" * len(SHOWN), sep="")
    beside = []  # lost where the table has no column
    for domain, kind in names:
        title, row, any_lost = domain if kind == "bayesian" else f"{domain}, {kind}", [], False
        for k in ITEMS:
            plan, _, name, best, _, is_lost = compare(cells[domain, kind, k])
            text = f"{plan:.2g}, {name} {best:.2g}"
            any_lost = any_lost or is_lost
            if k in SHOWN:
                row.append(f" **{text}** |" if is_lost else f" {text} |")
            elif is_lost:
                beside.append(f"{title} at {k} items ({text})")
        if not domain.startswith("random-") or any_lost:
            print(f"| {title} |", *row, sep="")
    if beside:
        print(f"\nLost between the columns: {'; '.join(beside)}.")


def at(team, k):
    return [exam for exam in team if exam[0] <= k][-1][1:]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("kith", nargs="?")
    parser.add_argument("out", nargs="?")
    parser.add_argument("--summary", nargs="+")
    parser.add_argument("--page", nargs="+")
    parser.add_argument("--note", default="", help="for the page: when and with how many teams")
    parser.add_argument("--random", type=int, default=0)
    parser.add_argument("--domains", nargs="+")
    parser.add_argument("--teams", type=int, default=30)
    parser.add_argument("--kinds", nargs="+", default=["bayesian"])
    parser.add_argument("--strategies", nargs="+")
    arguments = parser.parse_args()
    if arguments.page:
        page(read_cells(arguments.page), f"{arguments.note} " if arguments.note else "")
        return
    if arguments.summary:
        first, lost, medians = summary(read_cells(arguments.summary))
        print(f"{first}; lost:", *lost, sep="\n  ")
        print(*medians, sep="\n")
        return
    with open(arguments.out, "w", newline="", encoding="utf-8") as out, tempfile.TemporaryDirectory() as folder:
        domains = arguments.domains or ([] if arguments.random else
                                        [*BUILT_IN, *(ROOT / f"domains/{name}.toml" for name in FILES)])
        domains = [*domains, *random_domains(arguments.kith, arguments.random, folder)]
        table = csv.writer(out)
        table.writerow(["domain", "kind", "strategy", "k", "regret", "regret_se", "share", "share_se", "teams"])
        for domain, learner in itertools.product(domains, arguments.kinds):
            for name, kind, settings in STRATEGIES:
                if arguments.strategies and name not in arguments.strategies:
                    continue
                teams = run(arguments.kith, domain, kind, settings, arguments.teams, learner)
                for k in ITEMS:
                    row = []
                    for values in zip(*(at(team, k) for team in teams)):
                        error = statistics.stdev(values) / math.sqrt(len(values)) if len(values) > 1 else 0.0
                        row += [f"{statistics.fmean(values):.6g}", f"{error:.3g}"]
                    table.writerow([pathlib.Path(domain).stem, learner, name, k, *row, len(teams)])
                out.flush()
                print(f"{domain}, {learner}: {name}", file=sys.stderr)


if __name__ == "__main__":
    main()
