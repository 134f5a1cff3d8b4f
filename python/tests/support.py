"""What the tests share."""

import os
import pathlib

SOURCE = pathlib.Path(os.environ.get("KITH_SOURCE_DIR", pathlib.Path(__file__).resolve().parents[2]))
PROGRAM = os.environ.get("KITH_PROGRAM", "")

SMALL = {"replicates": 2, "teacher": {"particles": 200}, "stop": {"max_periods": 6}}
"""Settings that make the study `quick` quicker."""


def lake(slip=False):
    """The table of a frozen lake as Gymnasium has it, without Gymnasium."""
    rows = ["SFFF", "FHFH", "FFFH", "HFFG"]
    moves = [(0, -1), (1, 0), (0, 1), (-1, 0)]  # left, down, right, up
    table = {}
    for s in range(16):
        y, x = divmod(s, 4)
        table[s] = {}
        for a in range(4):
            if rows[y][x] in "GH":
                table[s][a] = [(1.0, s, 0, True)]
                continue
            outcomes = []
            for b in [(a - 1) % 4, a, (a + 1) % 4] if slip else [a]:
                ny = min(max(y + moves[b][0], 0), 3)
                nx = min(max(x + moves[b][1], 0), 3)
                end = rows[ny][nx]
                outcomes.append((1 / 3 if slip else 1.0, 4 * ny + nx, float(end == "G"), end in "GH"))
            table[s][a] = outcomes
    return table, rows


class LakeEnv:
    """What from_gymnasium() needs of an environment."""

    def __init__(self, slip=False):
        self.P, rows = lake(slip)
        self.unwrapped = self
        self.initial_state_distrib = [1.0] + [0.0] * 15
        self.holes = [s for s in range(16) if rows[s // 4][s % 4] == "H"]


LAKE_ACTIONS = ["left", "down", "right", "up"]


def lake_domain(kith, slip=False):
    env = LakeEnv(slip)
    return kith.Domain.from_gymnasium(
        env, features={"hole": lambda s, a, t: t in env.holes, "step": lambda s, a, t: 1, "goal": lambda s, a, t: t == 15},
        weights={"hole": -5, "step": -1, "goal": 10}, action_names=LAKE_ACTIONS)
