#!/usr/bin/env python3
"""Enters what a night did into docs/nightly.md, whose tables keep what all nights did together.

usage: nightly.py RESULTS COMMIT [PAGE]   RESULTS has a line per part: name, budget, minutes, minutes of building and
                                          outcome, with tabs between them; its output is beside it, in NAME.log
"""
import pathlib
import re
import sys

PAGE = pathlib.Path(__file__).parents[1] / "docs" / "nightly.md"
GOAL_OF_FUZZING = 1_000_000


def rows_under(text, heading):
    """Cells of the table under a heading, by the first of them."""
    lines = text.split(f"## {heading}\n", 1)[1].split("\n## ")[0].splitlines()
    cells = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines if line.startswith("|")]
    return {row[0]: row[1:] for row in cells[2:]}


def number(text):
    return int(text.replace(" ", ""))


def spaced(value):
    return f"{value:,}".replace(",", " ")


def counts(part, log):
    """What a log adds to the totals."""
    if part == "fuzz":
        return {f"executions of {name}": int(n) for name, n in re.findall(r"^(\w+) +(\d+) executions ", log, re.M)}
    return {}


def covered(log):
    """Percent of the lines that the corpora reach, all targets together."""
    found = re.findall(r"^together +\d+ lines +([\d.]+) %$", log, re.M)
    return found[-1] if found else None


def tests(log):
    passed = re.findall(r"^\d+% tests passed, (\d+) tests? failed out of (\d+)", log, re.M)
    failed, all_tests = (sum(int(pair[i]) for pair in passed) for i in (0, 1))
    return f"{all_tests - failed} of {all_tests}" if passed else "-"


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join((name, *row)) + " |" for name, row in rows.items()]) + "\n"


def enter(text, results, commit, log_of):
    """The page after one more night."""
    parts, totals = rows_under(text, "Parts"), rows_under(text, "Counts")
    for part, budget, minutes, building, outcome in results:
        log = log_of(part)
        nights = int(parts[part][-1]) + 1
        parts[part] = [budget, minutes, building, outcome, tests(log), commit, str(nights)]
        for what, count in counts(part, log).items():
            before = number(totals[what][0]) if what in totals else 0
            goal = totals[what][1] if what in totals else spaced(GOAL_OF_FUZZING)
            totals[what] = [spaced(before + count), goal]
        if part == "coverage" and covered(log):
            totals["lines of the parsers and the journal, %"][0] = covered(log)
    head = text.split("## Parts\n", 1)[0]
    columns = ("part", "budget, min", "last took", "building", "outcome", "tests passed", "commit", "runs")
    return head + f"## Parts\n\n{table(columns, parts)}\n## Counts\n\n{table(('what', 'so far', 'goal'), totals)}"


def main():
    arguments = sys.argv[1:]
    if len(arguments) not in (2, 3):
        sys.exit(__doc__)
    page = pathlib.Path(arguments[2]) if len(arguments) == 3 else PAGE
    text = page.read_text()
    results = pathlib.Path(arguments[0])
    rows = [line.split("\t") for line in results.read_text().splitlines()]
    logs = {row[0]: (results.parent / f"{row[0]}.log").read_text(errors="replace") for row in rows}
    page.write_text(enter(text, rows, arguments[1], logs.__getitem__))


if __name__ == "__main__":
    main()
