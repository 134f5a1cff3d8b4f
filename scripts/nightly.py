#!/usr/bin/env python3
"""Enters what a night did into the table of docs/nightly.md.

usage: nightly.py RESULTS COMMIT [PAGE]   RESULTS has a line per part: name, budget, minutes, minutes of building and
                                          outcome, with tabs between them; its output is beside it, in NAME.log
"""
import pathlib
import re
import sys

PAGE = pathlib.Path(__file__).parents[1] / "docs" / "nightly.md"


def spaced(value):
    return f"{value:,}".replace(",", " ")


def counted(log):
    """What the output of a part counts: tests, inputs that were tried, lines that they reach."""
    counts = []
    passed = re.findall(r"^\d+% tests passed, (\d+) tests? failed out of (\d+)", log, re.M)
    if passed:
        failed, all_tests = (sum(int(pair[i]) for pair in passed) for i in (0, 1))
        counts.append(f"{all_tests - failed} of {all_tests} tests passed")
    executions = [int(n) for n in re.findall(r"^\w+ +(\d+) executions ", log, re.M)]
    if executions:
        counts.append(f"{spaced(sum(executions))} inputs, at least {spaced(min(executions))} a target")
    # Each target's, and last that of all.
    counts += [f"{share} % of lines" for share in re.findall(r"^together +\d+ lines +([\d.]+) %$", log, re.M)[-1:]]
    return ", ".join(counts) or "-"


def enter(text, results, commit, log_of):
    """The page after one more night."""
    head, table = re.split(r"^(?=\| part )", text, maxsplit=1, flags=re.M)
    lines = table.splitlines()
    for part, budget, minutes, building, outcome in results:
        row = f"| {part} | {budget} | {minutes} | {building} | {outcome} | {counted(log_of(part))} | {commit} |"
        lines = [row if line.startswith(f"| {part} |") else line for line in lines]
    return head + "\n".join(lines) + "\n"


def main():
    arguments = sys.argv[1:]
    if len(arguments) not in (2, 3):
        sys.exit(__doc__)
    page = pathlib.Path(arguments[2]) if len(arguments) == 3 else PAGE
    results = pathlib.Path(arguments[0])
    rows = [line.split("\t") for line in results.read_text().splitlines()]
    logs = {row[0]: (results.parent / f"{row[0]}.log").read_text(errors="replace") for row in rows}
    page.write_text(enter(page.read_text(), rows, arguments[1], logs.__getitem__))


if __name__ == "__main__":
    main()
