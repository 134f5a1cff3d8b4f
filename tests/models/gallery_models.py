#!/usr/bin/env python3
"""Writes the explicit models of domains/gallery from their published definitions, or checks that they are up to date.

    gallery_models.py --write|--check [FOLDER]

FrozenLake and CliffWalking: Gymnasium's toy_text environments (gymnasium2024 in docs/references.bib), with their
argument is_slippery and, between its two values, the chance at which a move goes where it should. Taxi: Dietterich's
task (dietterich2000) as Gymnasium's Taxi-v3 has it, without and with road features of our own.
Exit code 1 if a file differs.
"""
import pathlib
import sys

from generated import is_up_to_date

MOVES = {"up": (0, -1), "down": (0, 1), "left": (-1, 0), "right": (1, 0)}
ASIDE = {"up": "left right", "down": "left right", "left": "up down", "right": "up down"}
SLIPPERY = {"firm": 1.0, "slippery": 0.8, "very slippery": 1 / 3}


def number(p):
    return f"{p:.7f}".rstrip("0").rstrip(".")


def yes(claim):
    return "true" if claim else "false"


def table(columns, rows):
    return "\n".join([columns, *(",".join(map(str, row)) for row in rows)]) + "\n"


def outcomes(move, chance, action):
    """{next state and features: probability} of an action; what is left of the chance goes to both sides alike."""
    found = {}
    for direction, p in [(action, chance)] + [(aside, (1 - chance) / 2) for aside in ASIDE[action].split()]:
        if p > 0:
            found[move(direction)] = found.get(move(direction), 0) + p
    return found


class Grid:
    """Cells (x, y) from the top left, from 1; moves off the grid change nothing."""

    def __init__(self, rows):
        self.rows = [row.split() if " " in row else list(row) for row in rows]
        self.cells = [(x, y) for y in range(1, len(rows) + 1) for x in range(1, len(self.rows[0]) + 1)]

    def at(self, cell):
        return self.rows[cell[1] - 1][cell[0] - 1]

    def step(self, cell, direction):
        to = (cell[0] + MOVES[direction][0], cell[1] + MOVES[direction][1])
        return to if to in self.cells else cell


def key(cell):
    return f"{'abcdefghijkl'[cell[0] - 1]}{cell[1]}"


def frozen_lake(rows):
    grid = Grid(rows)
    names = {"S": "on the ice", "F": "on the ice", "H": "in the hole", "G": "at the goal"}
    states = [
        (key(c), f'"{names[grid.at(c)]} at ({c[0]},{c[1]})"', yes(grid.at(c) in "HG"), yes(grid.at(c) == "S"),
         yes(grid.at(c) in "SF"), *c)
        for c in grid.cells
    ]
    transitions = []
    for world, chance in SLIPPERY.items():
        for cell in grid.cells:
            if grid.at(cell) in "HG":
                continue
            for action in MOVES:
                for to, p in outcomes(lambda d: grid.step(cell, d), chance, action).items():
                    transitions.append((world + " ice", key(cell), action, key(to), number(p), int(grid.at(to) == "H"), 1))
    return {
        "states": table("state,name,terminal,initial,start,x,y", states),
        "transitions": table("mdp,state,action,next,probability,hole,step", transitions),
    }


def cliff_walking():
    grid = Grid(["." * 12, "." * 12, "." * 12, "SCCCCCCCCCCG"])
    # Who falls is at the start again, in a state of its own: outcomes with and without a fall are told apart.
    start, again = (1, 4), "a4again"
    states = [
        (key(c), f'"{"at the goal" if grid.at(c) == "G" else "on the path"} at ({c[0]},{c[1]})"', yes(grid.at(c) == "G"),
         yes(c == start), yes(grid.at(c) != "G"), *c)
        for c in grid.cells if grid.at(c) != "C"
    ]
    states.append((again, f'"back at the start at ({start[0]},{start[1]})"', "false", "false", "false", *start))
    transitions = []
    for world, chance in SLIPPERY.items():
        for cell, here in [*((c, key(c)) for c in grid.cells if grid.at(c) not in "CG"), (start, again)]:

            def move(direction):
                to = grid.step(cell, direction)
                return (again, 1) if grid.at(to) == "C" else (key(to), 0)

            for action in MOVES:
                for (to, fall), p in outcomes(move, chance, action).items():
                    transitions.append((world + " path", here, action, to, number(p), fall, 1 - fall))
    return {
        "states": table("state,name,terminal,initial,start,x,y", states),
        "transitions": table("mdp,state,action,next,probability,fall,step", transitions),
    }


DEPOTS = {"R": (1, 1), "G": (5, 1), "Y": (1, 5), "B": (4, 5)}
CALLED = {"R": "red", "G": "green", "Y": "yellow", "B": "blue"}
# Between which columns there is a wall, by row.
WALLS = {(2, 1), (2, 2), (1, 4), (3, 4), (1, 5), (3, 5)}  # (x, y): between x and x + 1
BUMPS = {(1, 2)}
TOLLS = {(4, 3)}


def taxi():
    cells = [(x, y) for y in range(1, 6) for x in range(1, 6)]

    def step(cell, direction):
        to = (cell[0] + MOVES[direction][0], cell[1] + MOVES[direction][1])
        blocked = direction in ("left", "right") and (min(cell[0], to[0]), cell[1]) in WALLS
        return cell if blocked or to not in cells else to

    def code(cell, passenger, destination):
        return f"{key(cell)}{passenger}{destination}"

    def name(cell, passenger, destination):
        depot = next((f", the {CALLED[d]} depot" for d in DEPOTS if DEPOTS[d] == cell), "")
        road = ", the toll gate" if cell in TOLLS else ", the bumps" if cell in BUMPS else ""
        here = f"at ({cell[0]},{cell[1]}){depot}{road}"
        if passenger == destination:
            return f'"{here}; the passenger has arrived"'
        rides = "passenger aboard" if passenger == "T" else f"passenger waiting at {CALLED[passenger]}"
        return f'"{here}; {rides}, going to {CALLED[destination]}"'

    states = []
    for cell in cells:
        for passenger in [*DEPOTS, "T"]:
            for destination in DEPOTS:
                done = passenger == destination
                if done and cell != DEPOTS[destination]:
                    continue  # of the 500 states 96 are never reached: delivered, and the taxi elsewhere
                where = cell if passenger == "T" else DEPOTS[passenger]
                states.append((
                    code(cell, passenger, destination), name(cell, passenger, destination), yes(done),
                    yes((cell, passenger, destination) == ((3, 3), "R", "B")), yes(not done and passenger != "T"),
                    *cell, *where, int(passenger == "T"), *DEPOTS[destination],
                ))
    transitions = []
    for world in ("free roads", "toll gate and bumps"):
        special = world != "free roads"
        for cell in cells:
            for passenger in [*DEPOTS, "T"]:
                for destination in DEPOTS:
                    if passenger == destination:
                        continue
                    here = code(cell, passenger, destination)
                    for action in MOVES:
                        to = step(cell, action)
                        if to != cell:
                            bump = int(special and passenger == "T" and to in BUMPS)
                            toll = int(special and to in TOLLS)
                            transitions.append((world, here, action, code(to, passenger, destination), bump, toll, 1))
                    if passenger != "T" and cell == DEPOTS[passenger]:
                        transitions.append((world, here, "pickup", code(cell, "T", destination), 0, 0, 1))
                    if passenger == "T" and cell in DEPOTS.values():
                        depot = next(d for d in DEPOTS if DEPOTS[d] == cell)
                        transitions.append((world, here, "dropoff", code(cell, depot, destination), 0, 0, 1))
    return {
        "states": table(
            "state,name,terminal,initial,start,x,y,passenger_x,passenger_y,passenger_carried,destination_x,destination_y", states),
        "transitions": table("mdp,state,action,next,bumps,toll,step", transitions),
    }


def models():
    yield "frozen_lake", frozen_lake(["SFFF", "FHFH", "FFFH", "HFFG"])
    yield "frozen_lake_8x8", frozen_lake(
        ["SFFFFFFF", "FFFFFFFF", "FFFHFFFF", "FFFFFHFF", "FFFHFFFF", "FHHFFFHF", "FHFFHFHF", "FFFHFFFG"])
    yield "cliff_walking", cliff_walking()
    yield "taxi", taxi()


def main(mode, folder):
    return 0 if all([is_up_to_date(mode, folder / f"{name}_{part}.csv", text)
                     for name, files in models() for part, text in files.items()]) else 1


if __name__ == "__main__":
    if len(sys.argv) not in (2, 3) or sys.argv[1] not in ("--write", "--check"):
        sys.exit(__doc__)
    default = pathlib.Path(__file__).resolve().parents[2] / "domains" / "gallery"
    sys.exit(main(sys.argv[1], pathlib.Path(sys.argv[2]) if len(sys.argv) > 2 else default))
