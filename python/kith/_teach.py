"""One simulated team, step by step."""

from __future__ import annotations

import json
import os
from typing import Any, Union

from . import _core
from ._domain import Domain
from ._kinds import strategy_name
from ._settings import overrides


class Record:
    """A part of a document, with its keys as attributes: record.tests is record["tests"]."""

    def __init__(self, values: dict[str, Any]) -> None:
        self._values = values

    def __getattr__(self, name: str) -> Any:
        try:
            return self._values[name]
        except KeyError:
            raise AttributeError(f"there is no '{name}', only {', '.join(self._values)}") from None

    def __getitem__(self, name: str) -> Any:
        return self._values[name]

    def __dir__(self) -> list[str]:
        return list(self._values)

    def __getstate__(self) -> dict[str, Any]:
        return self._values

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__["_values"] = state

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Record) and self._values == other._values

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        short = {name: "..." if isinstance(value, (list, Record)) else value for name, value in self._values.items()}
        return f"Record({', '.join(f'{name}={value!r}' for name, value in short.items())})"


class Transcript(Record):
    """Everything that happened to one team: the document kith.teach/1, with its keys as attributes.

    .sessions[0].periods[0].demonstrations, .tests, .before, .after, ...; .text is what `kith teach` prints.
    """

    def __init__(self, document: str, text: str) -> None:
        super().__init__(json.loads(document, object_hook=Record)._values)
        self._values["text"] = text

    @property
    def document(self) -> dict[str, Any]:
        """Plain dictionaries and lists."""
        return {name: _plain(value) for name, value in self._values.items() if name != "text"}

    def __repr__(self) -> str:
        return f"<kith.Transcript of {self.composition} by {self.strategy}: {self.periods} periods, {self.status}>"

    def _repr_html_(self) -> str:
        from ._html import transcript_html

        return transcript_html(self)


def _plain(value: Any) -> Any:
    if isinstance(value, Record):
        return {name: _plain(one) for name, one in value._values.items()}
    return [_plain(one) for one in value] if isinstance(value, list) else value


def teach(domain: Union[Domain, str], group: str = "NNP", strategy: Any = "common", seed: int = 1,
          study: str = "paper", **settings: Any) -> Transcript:
    """Teaches one simulated team and tells what happened, as `kith teach` does.

    group     letters of the study's learner types
    strategy  the name of one, or a class of your own (kith.Strategy)
    settings  keys of a study file, such as teacher={"particles": 500}
    """
    robot = domain if isinstance(domain, Domain) else Domain(domain)
    transcript = Transcript(*_core.teach(robot._native, group, strategy_name(strategy), seed, study, "",
                                         list(overrides(settings))))
    transcript.__dict__["domain_object"] = robot
    return transcript


def replay(run: Union[str, os.PathLike[str]], team: int) -> Transcript:
    """The same for a team of a run, by its number."""
    return Transcript(*_core.replay(os.fspath(run), team))
