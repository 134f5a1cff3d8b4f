"""Strategies and learners of one's own."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, ClassVar, Union

from . import _core
from ._records import HalfSpace, Start


class Strategy:
    """Chooses what is shown next. Derive from it, or write a class with the same methods.

    Teams are taught on several threads: each has an object of its own, made without arguments, which may keep a state.
    propose() is called on a deep copy, which takes the object's place once the lesson is complete. It gives

        view.select("joint")       the best unit for a belief: of the team, of a member by seat, or of your own
        view.pick(starts)          these demonstrations
        "joint", 0, [start, ...]   the same in short
        None                       nothing: showing anything would be useless

    Draw from view.random, so that the same study gives the same tables. What it raises ends the run, which can be
    resumed; results of an earlier `version` are not gone on with.
    """

    name: ClassVar[str] = ""
    """In files and tables; default: the name of the class, in lower case."""
    version: ClassVar[str] = ""
    """Change it with what the strategy does."""
    needs: ClassVar[Sequence[str]] = ("members", "common", "joint")
    """The beliefs that it reads; fewer make it faster."""

    def propose(self, view: _core.View) -> Any:
        """What to show next."""
        raise NotImplementedError


class Learner:
    """A simulated person. Derive from it, or write a class with the same methods; made with a kith.LearnerStart.

    `start.random` is what this person draws from, `start.belief` what people like this know beforehand.
    """

    name: ClassVar[str] = ""
    """`learner.X.kind` in study files; default: the name of the class, in lower case."""
    version: ClassVar[str] = ""

    def __init__(self, start: _core.LearnerStart) -> None:
        self.start = start

    def begin_component(self) -> None:
        """A knowledge component begins."""

    def watch(self, half_spaces: list[HalfSpace], period: int) -> None:
        """Watches demonstrations that convey these half-spaces."""

    def answer(self, tests: list[Start], period: int) -> Any:
        """Weights, shape [d], whose paths are the answers; or a list of feature counts, one per test, None: no answer.

        It changes nothing.
        """
        raise NotImplementedError

    def hear_feedback(self, all_correct: bool, half_spaces: list[HalfSpace], period: int) -> None:
        """Hears whether all answers were right, and what the corrections convey."""

    def mass_in(self, half_spaces: list[HalfSpace]) -> float:
        """How sure the person is that the robot's weights satisfy all of them, in [0, 1]."""
        raise NotImplementedError


_registered: dict[str, type] = {}


def _name(kind: type) -> str:
    return str(getattr(kind, "name", "") or kind.__name__.lower())


def _description(kind: type) -> str:
    lines = (kind.__doc__ or "").strip().splitlines()
    return lines[0].rstrip(".") if lines else f"the class {kind.__name__}"


def strategy_name(strategy: Union[str, type]) -> str:
    """The name of a strategy; a class is registered first."""
    if isinstance(strategy, str):
        return strategy
    if not isinstance(strategy, type) or not callable(getattr(strategy, "propose", None)):
        raise TypeError("a strategy is a name, or a class with a method propose(view)")
    name = _name(strategy)
    if _registered.get("strategy " + name) is not strategy:
        _core.register_strategy(name, _description(strategy), str(getattr(strategy, "version", "")),
                                list(getattr(strategy, "needs", Strategy.needs)), strategy)
        _registered["strategy " + name] = strategy
    return name


def learner_name(learner: Union[str, type]) -> str:
    """The name of a learner model; a class is registered first."""
    if isinstance(learner, str):
        return learner
    if not isinstance(learner, type):
        raise TypeError("a learner is a name or a class")
    missing = [method for method in ("watch", "answer", "hear_feedback", "mass_in")
               if not callable(getattr(learner, method, None))]
    if missing:
        raise TypeError(f"the learner {learner.__name__} has no method {missing[0]}()")
    name = _name(learner)
    if _registered.get("learner " + name) is not learner:
        _core.register_learner(name, _description(learner), str(getattr(learner, "version", "")), learner)
        _registered["learner " + name] = learner
    return name


def strategies() -> dict[str, str]:
    """All strategies with what they do; those of your own once they were used."""
    return _core.strategies()
