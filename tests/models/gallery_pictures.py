#!/usr/bin/env python3
"""Draws the pictures of docs/gallery.md: the maps of its robots with what the robot does, as kith plans it.

    gallery_pictures.py KITH --write|--check [FOLDER]

Exit code 1 if a picture differs.
"""
import json
import pathlib
import re
import subprocess
import sys

from generated import is_up_to_date

SOURCE = pathlib.Path(__file__).resolve().parents[2]
CELL = 30
INK = "#1c2127"
GROUND = {"hole": "#57606a", "ice": "#d3e4f7", "goal": "#b9e2c6", "cliff": "#57606a", "wall": "#3c444d", "lava": "#e5895f",
          "heat": "#fbe3c4", "toll": "#f8edc0", "bumps": "#e9dcc9", "depot": "#e6dcf3", "lane": "#e9dcc9", "close": "#f7d4d0",
          "person": "#c25a50", "wet": "#a9cbee", "view": "#fbdcbf", "camera": "#8d6fb5", "charger": "#ffe08a"}
ANGLES = {"right": 0, "down": 90, "left": 180, "up": 270}

# Per picture: the rows, what symbols stand for, the world, what the names of the states have to say, and the caption.
LAKE = {"F": "ice", "S": "ice", "H": "hole", "G": "goal"}
PICTURES = {
    "frozen_lake": dict(rows=["SFFF", "FHFH", "FFFH", "HFFG"], kinds=LAKE, world=2, where="",
                        title="FrozenLake 4 x 4, very slippery: what the robot does"),
    "frozen_lake_8x8": dict(
        rows=["SFFFFFFF", "FFFFFFFF", "FFFHFFFF", "FFFFFHFF", "FFFHFFFF", "FHHFFFHF", "FHFFHFHF", "FFFHFFFG"],
        kinds=LAKE, world=2, where="", title="FrozenLake 8 x 8, very slippery: what the robot does"),
    "cliff_walking": dict(rows=["." * 12, "." * 12, "." * 12, "SCCCCCCCCCCG"], kinds={"C": "cliff", "G": "goal"}, world=1, where="",
                          title="CliffWalking, slippery: what the robot does"),
    "taxi": dict(rows=["R...G", "b....", "...t.", ".....", "Y..B."],
                 kinds={"R": "depot", "G": "depot", "Y": "depot", "B": "depot", "b": "bumps", "t": "toll"}, world=1,
                 where="passenger waiting at blue, going to red", signs="RGYB",
                 walls=[(2, 1), (2, 2), (1, 4), (3, 4), (1, 5), (3, 5)],
                 title="Taxi with a toll gate and bumps: how it fetches a passenger at the blue depot"),
    "four_rooms": dict(rows=["###########", "#S...#....#", "#....#.hh.#", "#....N.HH.#", "#....#.hh.#", "##.####w###", "#....#....#",
                             "#.d..#.e..#", "#.D..w.E..#", "#.d..#.e.G#", "###########"],
                       kinds={"#": "wall", "G": "goal", **dict.fromkeys("NHDE", "lava"), **dict.fromkeys("hdew", "heat")}, world=31,
                       where="", title="Four rooms with all the lava: what the robot does"),
    # The rows are those of the domain, which come from an image; too large for an arrow in every cell.
    "warehouse": dict(file="domains/warehouse.toml", kinds={"#": "wall", "f": "lane", "d": "view", "v": "view", "e": "camera", "c": "close",
                                                            "a": "person", "w": "wet", "b": "wet", "B": "charger", "G": "goal"},
                      world=6, cell=12, title="The warehouse with everything in it: how the robot brings a crate from the dock to packing"),
}


def inspect(kith, name, picture):
    """What `kith inspect` says about the world of a picture."""
    file = SOURCE / picture.get("file", f"domains/gallery/{name}.toml")
    command = [kith, "inspect", str(file), "--show", "demos", "--mdp", str(picture["world"]), "--json"]
    return json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)


def policy(demos, picture):
    """{(x, y): first action} of the states that the picture shows."""
    moves = {}
    for demo in demos:
        start = demo["start"]
        if "robot" in start:
            moves.setdefault(tuple(start["robot"]), demo["actions"][0])
        elif picture["where"] in start["name"]:
            moves.setdefault(tuple(map(int, re.search(r"\((\d+),(\d+)\)", start["name"]).groups())), demo["actions"][0])
    return moves


def path(demo, cell):
    """A path as the elements of a picture: a line that begins in a disc."""
    x, y = (1 + cell * place - cell // 2 for place in demo["start"]["robot"])
    steps = {"right": f"h{cell}", "left": f"h-{cell}", "up": f"v-{cell}", "down": f"v{cell}"}
    line = "".join(steps.get(action, "") for action in demo["actions"])
    return [f'<path d="M{x} {y}{line}" fill="none" stroke="#0b5cad" stroke-width="2.4" stroke-linejoin="round"/>',
            f'<circle cx="{x}" cy="{y}" r="{cell / 2:g}" fill="#0b5cad"/>']


def draw(picture, known):
    by_cell = "rows" in picture
    rows, kinds = picture["rows"] if by_cell else known["maps"][picture["world"]], picture["kinds"]
    moves = policy(known["demos"], picture) if by_cell else {}
    size = picture.get("cell", CELL)
    width, height = size * len(rows[0]) + 2, size * len(rows) + 2
    used, cells, arrows = [], {}, []
    for y, row in enumerate(rows):
        for x, symbol in enumerate(row):
            kind = kinds.get(symbol)
            if kind and kind not in used:
                used.append(kind)
            fill = GROUND.get(kind, "#ffffff")
            cells[fill] = cells.get(fill, "") + f"M{1 + size * x} {1 + size * y}h{size}v{size}h-{size}z"
            centre = (1 + size * x + size // 2, 1 + size * y + size // 2)
            if symbol in picture.get("signs", ""):
                arrows.append(f'<text x="{centre[0] - 13}" y="{centre[1] - 4}">{symbol}</text>')
            action = moves.get((x + 1, y + 1))
            if action in ANGLES:
                arrows.append(f'<use href="#a" transform="translate({centre[0]} {centre[1]}) rotate({ANGLES[action]})"/>')
            elif action:
                arrows.append(f'<circle cx="{centre[0]}" cy="{centre[1]}" r="7" fill="#0b5cad"/>')
    for x, y in picture.get("walls", []):
        arrows.append(f'<path d="M{1 + CELL * x} {1 + CELL * (y - 1)}v{CELL}" stroke="{INK}" stroke-width="4"/>')
    if not by_cell:
        arrows += path(known["demos"][0], size)
    wide = max(width, 66 * len(used) + 2)
    key = "".join(
        f'<path d="M{1 + 66 * i} {height + 8}h14v14h-14z" fill="{GROUND[kind]}" stroke="#87909b"/>'
        f'<text x="{20 + 66 * i}" y="{height + 20}">{kind}</text>' for i, kind in enumerate(used))
    return "\n".join([
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {wide} {height + 28}" width="{wide}" height="{height + 28}" role="img" '
        f'font-family="sans-serif" font-size="12" fill="{INK}">',
        f"<title>{picture['title']}</title>",
        '<defs><path id="a" d="M-8 0H6M1 -4L7 0L1 4" fill="none" stroke="#0b5cad" stroke-width="2.4"/></defs>',
        f'<rect width="{wide}" height="{height + 28}" fill="#ffffff"/>',
        '<g stroke="#b8bfc7">', *(f'<path d="{path}" fill="{fill}"/>' for fill, path in cells.items()), "</g>", *arrows, key, "</svg>"]) + "\n"


def main(kith, mode, folder):
    return 0 if all([is_up_to_date(mode, folder / f"{name}.svg", draw(picture, inspect(kith, name, picture)))
                     for name, picture in PICTURES.items()]) else 1


if __name__ == "__main__":
    if len(sys.argv) not in (3, 4) or sys.argv[2] not in ("--write", "--check"):
        sys.exit(__doc__)
    sys.exit(main(sys.argv[1], sys.argv[2], pathlib.Path(sys.argv[3]) if len(sys.argv) > 3 else SOURCE / "docs" / "gallery"))
