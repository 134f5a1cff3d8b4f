#!/usr/bin/env python3
"""Compares how long kith takes, as a multiple of plain implementations in the same run, with ratios.json.

usage: ratios.py RIVALS_BENCH KITH [--update]

Exits with 1 if something takes more than 1.25 times as long as it did on a machine with the same vectors; --update
stores what is measured now.
"""
import json
import os
import pathlib
import resource
import subprocess
import sys
import tempfile

STORED = pathlib.Path(__file__).with_name("ratios.json")
ROOT = pathlib.Path(__file__).parents[2]
SLOWER = 1.25
REPETITIONS = 5


def kernels(bench):
    """Microseconds of each benchmark: the shortest of several, which other programs disturb least."""
    command = [bench, "--benchmark_format=json", f"--benchmark_repetitions={REPETITIONS}", "--benchmark_min_time=0.2"]
    runs = json.loads(subprocess.run(command, check=True, capture_output=True).stdout)["benchmarks"]
    times = {}
    for run in runs:
        if run["run_type"] == "iteration":
            assert run["time_unit"] == "ns"
            times.setdefault(run["name"], []).append(run["cpu_time"] / 1e3)
    return {name: min(values) for name, values in times.items()}


def seconds(*command):
    """Processor time of a command, the shortest of several."""
    shortest = float("inf")
    for _ in range(REPETITIONS):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run(command, check=True, cwd=ROOT, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        shortest = min(shortest, after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime)
    return shortest


def measure(bench, kith):
    times = kernels(bench)
    ratios = {name: times[name] / times[name + "_naive"] for name in ("step", "selection")}
    with tempfile.TemporaryDirectory() as folder:
        run, plan = os.path.join(folder, "run"), os.path.join(folder, "plan")
        study = [kith, "study", "studies/paper.toml", "-q", "-j", "1", "--yes"]
        commands = {
            "study": study + ["-o", run],
            "planner": study + ["-o", plan, "--set", 'design.strategies=["plan"]', "--set", "replicates=5"],
            "audit": [kith, "audit", run, "-o", os.path.join(folder, "audit.html"), "-q"],
        }
        for name, command in commands.items():  # in plain filter steps
            ratios[name] = seconds(*command) * 1e6 / times["step_naive"]
    return ratios


def vectors():
    """kith has loops for either kind of vectors (decision 11), the plain implementations have not."""
    return "avx512" if " avx512vl " in pathlib.Path("/proc/cpuinfo").read_text() else "avx2"


def main(bench, kith, *options):
    ratios = {name: float(f"{ratio:.3g}") for name, ratio in measure(bench, kith).items()}
    known = json.loads(STORED.read_text())
    if options == ("--update",):
        STORED.write_text(json.dumps(known | {vectors(): ratios}, indent=2) + "\n")
        return 0
    stored = known[vectors()]
    for name, ratio in ratios.items():
        print(f"{name:10} {ratio:10g}  stored {stored[name]:10g}  {ratio / stored[name]:.2f}")
    return int(any(ratio > SLOWER * stored[name] for name, ratio in ratios.items()))


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    sys.exit(main(*sys.argv[1:]))
