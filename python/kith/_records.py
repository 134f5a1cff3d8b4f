"""What happens in a session, as values."""

from __future__ import annotations

from typing import NamedTuple, Optional

Start = tuple[int, int]
"""Where a demonstration or a test begins: number of the world, number of the state. Models that count their states from
0, as arrays do, keep these numbers; elsewhere they are those of tables of runs."""
HalfSpace = tuple[int, ...]
"""A normal n, shape [d]: all weights with n . w >= 0."""
Counts = tuple[float, ...]
"""How often each feature counts along a path, shape [d]: whole numbers, or expectations."""


class Demonstration(NamedTuple):
    """A path of the robot that is shown."""

    start: Start
    actions: list[str]
    counts: Counts
    half_spaces: list[HalfSpace]
    """What it conveys."""
    gain: float
    """Area of what is left before / after, >= 1."""


class Test(NamedTuple):
    """A start for which people are asked what the robot would do."""

    start: Start
    robot_actions: list[str]
    robot_counts: Counts
    half_spaces: list[HalfSpace]
    """What it examines, and what its feedback teaches."""
    exact: bool
    """False: nothing tests that itself, so this tests what is nearest."""


class Lesson(NamedTuple):
    """The demonstrations of one period, with the tests that follow."""

    period: int
    """1, 2, ..."""
    component: int
    """Index into Domain.components."""
    component_name: str
    source: str
    """The belief that it was chosen for: "common", "joint", "member 2", "everybody"."""
    demonstrations: list[Demonstration]
    tests: list[Test]
    taught: list[HalfSpace]
    """All that the demonstrations convey, reduced."""
    repeats: bool
    """Whether the lesson before is shown again, because nothing had gain."""
    area_sr: float
    gain: float
    """Logarithm of the area of what is left before / after."""


class Verdict(NamedTuple):
    """What an answer showed."""

    correct: bool
    regret: float
    """Return that the answer loses, >= 0, in the units of the domain file's weights."""
    answered: bool
    half_spaces: list[HalfSpace]
    """What the answer says about what the person believes."""


class Feedback(NamedTuple):
    """What the team hears after its answers."""

    verdicts: list[list[Verdict]]
    """Per member, per test; empty for members who were away."""
    all_correct: list[bool]
    half_spaces: list[HalfSpace]
    """What it teaches."""
    excluded: list[int]
    """Seats that a rule of aggregation left out."""
    component_learned: bool
    released: list[int]
    """Seats that are done with the component before the others."""


class Period(NamedTuple):
    """A completed period."""

    lesson: Lesson
    answers: list[list[Optional[Counts]]]
    """Per member, per test; None: no answer."""
    feedback: Feedback


class Path(NamedTuple):
    """What somebody does from a start."""

    world: int
    states: list[int]
    actions: list[str]
    counts: Counts
    value: float
    """Return under the robot's weights at length 1."""
    repeats_from: Optional[int]
    """Of a path that never ends, the position in `states` at which it begins again."""


class Component(NamedTuple):
    """A part of what there is to understand: a trade-off between features."""

    name: str
    features: list[str]
    half_spaces: list[HalfSpace]
    area_sr: float
    worlds: list[int]
    """Worlds in which it is taught."""


class World(NamedTuple):
    """One of the worlds in which the robot works."""

    index: int  # type: ignore[assignment]  # of a tuple it would be a method
    name: str
    state_names: list[str]
    """By the number of the state; empty for states that were left out. On maps ends come last."""
    starts: list[Start]
    """Where demonstrations and tests may begin."""
    initial: Start
    map: list[str]
    """Rows of text, top first; empty without a map."""
