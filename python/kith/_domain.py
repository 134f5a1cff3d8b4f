"""Robots: kith.Domain."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Mapping
from functools import cached_property
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any, Optional, Union, overload

from . import _core
from ._errors import Error
from ._records import Component, Path, Start, World

if TYPE_CHECKING:
    from ._infer import Explanation
    from ._study import Report

Features = Union[Mapping[str, Callable[[int, int, int], float]], Any]
"""Functions of (state, action, next state) by name, or an array; see Domain.from_gymnasium()."""


class Domain:
    """A robot in one or several worlds: what it does, and what there is to understand about it.

    Domain("item-delivery")      built in; Domain.built_in() names all
    Domain("mine.toml")          a domain file
    Domain(text)                 the text of one, of more than one line
    Domain.from_arrays(...)      probabilities, features and weights
    Domain.from_gymnasium(...)   an environment with tables

    kith.Error if a file is wrong, with its place. It does not change; planning happens when it is first needed.
    """

    def __init__(self, source: Union[str, os.PathLike[str]]) -> None:
        text = os.fspath(source)
        self._native = _core.Domain.from_text(text, "domain") if "\n" in text else _core.Domain(text)

    def __reduce__(self) -> tuple[Any, ...]:
        return _unpickled, (self.text, dict(self._native.files), self.id, self.explanation)

    def __copy__(self) -> Domain:
        return self  # it does not change

    def __deepcopy__(self, memo: dict[int, Any]) -> Domain:
        return self

    @classmethod
    def _of(cls, native: _core.Domain) -> Domain:
        domain = cls.__new__(cls)
        domain._native = native
        return domain

    @classmethod
    def from_text(cls, text: str, files: Optional[Mapping[str, str]] = None, name: str = "domain") -> Domain:
        """The text of a domain file; files: the texts of those that it names."""
        return cls._of(_core.Domain.from_text(text, name, dict(files or {})))

    @classmethod
    def from_arrays(cls, transitions: Any, features: Any, weights: Any, **options: Any) -> Domain:
        """A robot from arrays.

        transitions  probabilities, shape [S, A, S]; each row sums to 1, or is 0 where a state has no such action
        features     shape [S, A, S, d] or [S, A, d], d = 2 to 8
        weights      the robot's reward weights, shape [d], or a dictionary by name

        Options: terminal (states in which an episode has ended; default: those that nothing leaves), discount = 1,
        feature_names, action_names, state_names, initial, starts (default: where other states lead), prior
        (half-spaces that everybody knows, shape [n, d] or dictionaries by name), words (how people call features),
        columns (of a grid whose states are numbered row by row: it is drawn), map (rows and legend of its picture, as
        in a domain file), id, title. ValueError for arrays of wrong shape, NaN, or rows that do not sum to 1.

        States keep their numbers: in policy, paths and starts.
        """
        from ._models import domain_from_arrays

        return cls._of(domain_from_arrays(transitions, features, weights, **options))

    @classmethod
    def from_gymnasium(cls, env: Any, features: Features = None, weights: Any = None, **options: Any) -> Domain:
        """A robot from an environment whose env.unwrapped.P is Gymnasium's table; Gymnasium need not be there.

        features  {name: f(state, action, next state)}, or an array as of from_arrays(); without, every distinct reward
                  becomes a feature whose weight it is
        weights   {name: weight} or shape [d]

        Options as of from_arrays(), without transitions and terminal.
        """
        from ._models import domain_from_table

        return cls._of(domain_from_table(env, features, weights, **options))

    @classmethod
    def from_policy(cls, transitions: Any, features: Any, policy: Any, **options: Any) -> Domain:
        """A robot whose reward nobody wrote down: weights under which its policy is optimal or, if there are none, that
        explain most of it. Only starts are taught from which they explain all; see kith.explain_policy(), and
        `explanation`.

        policy: an action per state, shape [S], or probabilities, shape [S, A]; the others as of from_arrays().
        """
        from ._infer import infer

        native, explanation = infer(transitions, features, policy, **options)
        domain = cls._of(native)
        domain.explanation = explanation
        return domain

    explanation: Optional[Explanation] = None
    """Of a domain that was made from a policy: how well its weights explain it."""

    @staticmethod
    def built_in() -> list[str]:
        """Names of the domains that come with kith."""
        return _core.Domain.built_in()

    @property
    def id(self) -> str:
        """Its name in files."""
        return self._native.id

    @property
    def title(self) -> str:
        """What it is about, in a sentence."""
        return self._native.title

    @property
    def text(self) -> str:
        """The domain file."""
        return self._native.text

    def save(self, folder: Union[str, os.PathLike[str]]) -> FilePath:
        """Writes domain.toml and the files that it names into the folder, and returns the path of domain.toml."""
        place = FilePath(folder)
        place.mkdir(parents=True, exist_ok=True)
        for name, text in self._native.files.items():
            (place / name).parent.mkdir(parents=True, exist_ok=True)
            (place / name).write_text(text, encoding="utf-8", newline="")
        file = place / "domain.toml"
        file.write_text(self.text, encoding="utf-8", newline="")
        return file

    @property
    def feature_names(self) -> tuple[str, ...]:
        """d names."""
        return self._native.feature_names

    @property
    def action_names(self) -> tuple[str, ...]:
        """Names of the actions, in the order in which ties are broken."""
        return self._native.action_names

    @property
    def weights(self) -> tuple[float, ...]:
        """The robot's reward weights as written, shape [d]."""
        return self._native.weights

    @cached_property
    def worlds(self) -> list[World]:
        """The worlds, in order."""
        native = self._native
        return [World(m, native.world_name(m), native.state_names(m), [(m, s) for s in native.starts(m)],
                      (m, native.initial(m)), native.map(m)) for m in range(native.num_worlds)]

    @property
    def starts(self) -> list[Start]:
        """Where demonstrations and tests may begin, in all worlds."""
        return [start for world in self.worlds for start in world.starts]

    @cached_property
    def policy(self) -> list[list[Optional[str]]]:
        """What the robot does: policy[world][state] is the name of an action; None where an episode has ended or the
        robot never is."""
        return [self._native.policy(m) for m in range(self._native.num_worlds)]

    @cached_property
    def components(self) -> list[Component]:
        """What there is to understand, part by part, in the order in which it is taught."""
        return [Component(**one) for one in self._native.components]

    @cached_property
    def region(self) -> _core.Cone:
        """All weights under which the robot's policy is optimal, within the prior."""
        return self._native.region

    @cached_property
    def prior(self) -> _core.Cone:
        """What everybody knows beforehand."""
        return self._native.prior

    @overload
    def path(self, start: Start) -> Path: ...

    @overload
    def path(self, start: Start, weights: Any) -> Optional[Path]: ...

    def path(self, start: Start, weights: Any = None) -> Optional[Path]:
        """What the robot does from a start or, with weights of shape [d], somebody who has these.

        Weights need one of `starts`; None if they have no optimum there. What chance decides goes as is likeliest; counts
        are expectations.
        """
        found = self._native.path(start, weights)
        return None if found is None else Path(**found)

    def words(self, half_spaces: Any) -> list[str]:
        """Half-spaces as people would say them: "crossing rubble costs more than 2 steps"."""
        return self._native.words(half_spaces)

    def described(self, demonstrations: bool = False) -> dict[str, Any]:
        """All that is known of it, as `kith inspect --json` says it."""
        document: dict[str, Any] = json.loads(self._native.described(demonstrations))
        return document

    def lesson(self, path: Union[str, os.PathLike[str], None] = None, *, program: str = "kith") -> Report:
        """A lesson in one file that teaches whoever opens it, as `kith lesson --adaptive` writes it; a notebook shows it.

        path: where it is written; without, nowhere that lasts. program: a kith with the engine of lessons, built with
        `./run.sh --lesson`; kith.Error if it has none, FileNotFoundError if there is no such program.
        """
        import subprocess
        import tempfile

        from ._study import Report

        with tempfile.TemporaryDirectory() as folder:
            place = FilePath(path) if path is not None else FilePath(folder) / "lesson.html"
            done = subprocess.run([program, "lesson", str(self.save(folder)), "--adaptive", "-o", str(place)], capture_output=True, text=True)
            if done.returncode != 0:
                raise Error(done.stderr.strip(), "infeasible" if done.returncode == 4 else "usage")
            return Report(place, place.read_text(encoding="utf-8"))

    def board(self, start: Start, path: bool = True) -> str:
        """A picture of the start, with the robot's path, as SVG; empty without a map."""
        return self._native.board(start, path)

    def region_picture(self) -> str:
        """The sphere of weights with the prior and the region in it, as SVG; beyond three features, pair by pair."""
        return self._native.region_picture()

    def __str__(self) -> str:
        rows = "\n".join(self.worlds[-1].map)
        return f"{self.title or self.id}\n{rows}".rstrip()

    def __repr__(self) -> str:
        return f"<kith.Domain {self.id!r}: {self._native.num_worlds} worlds, features {', '.join(self.feature_names)}>"

    def _repr_html_(self) -> str:
        from ._html import domain_html

        return domain_html(self)


def _unpickled(text: str, files: dict[str, str], name: str, explanation: Optional[Explanation]) -> Domain:
    import warnings

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # they were given when it was made
        domain = Domain.from_text(text, files, name)
    domain.explanation = explanation
    return domain
