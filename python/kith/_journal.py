"""What was done to sessions and simulated people, so that a pickle can do it again."""

from __future__ import annotations

from typing import Any, NamedTuple, Optional, TypeVar

T = TypeVar("T", bound="Journaled")


class _Other(NamedTuple):
    """In the place of an argument: a thing of the same journal."""

    place: int


class Journal:
    """How some things were made, and what was done to them, in order. Things that have met share one."""

    def __init__(self) -> None:
        self.made: list[tuple[type, tuple[Any, ...], dict[str, Any]]] = []
        self.done: list[tuple[int, str, tuple[Any, ...]]] = []
        self.joined: Optional[Journal] = None
        self.shift = 0
        self.things: list[Journaled] = []  # made again, where it comes out of a pickle

    def join(self, other: Journal) -> None:
        """Takes over what `other` has, whose things had nothing to do with those of this one so far."""
        other.joined, other.shift = self, len(self.made)
        self.made += other.made
        for index, method, arguments in other.done:
            moved = tuple(_Other(one.place + other.shift) if isinstance(one, _Other) else one for one in arguments)
            self.done.append((index + other.shift, method, moved))
        other.made, other.done = [], []

    def __deepcopy__(self, memo: dict[int, Any]) -> Journal:
        other = Journal()
        other.made, other.done = list(self.made), list(self.done)
        return other

    def __reduce__(self) -> tuple[Any, ...]:
        return _replayed, (self.made, self.done)


class Journaled:
    """Something native that is copied, and pickled as what was done to it."""

    _native: Any
    _journal: Journal
    _index: int

    def _begin(self, *arguments: Any, **settings: Any) -> None:
        """Called by the constructor with its own arguments."""
        self._journal, self._index = Journal(), 0
        self._journal.made.append((type(self), arguments, settings))

    def _home(self) -> Journal:
        while self._journal.joined is not None:
            self._index += self._journal.shift
            self._journal = self._journal.joined
        return self._journal

    def _do(self, method: str, *arguments: Any) -> Any:
        """Calls a native method that changes something, and remembers it unless it fails."""
        result = getattr(self._native, method)(*(one._native if isinstance(one, Journaled) else one for one in arguments))
        journal = self._home()
        for one in arguments:
            if isinstance(one, Journaled) and one._home() is not journal:
                journal.join(one._home())
        kept = tuple(_Other(one._place()) if isinstance(one, Journaled) else one for one in arguments)
        journal.done.append((self._place(), method, kept))
        return result

    def _place(self) -> int:
        self._home()
        return self._index

    def __copy__(self: T) -> T:
        return self.__deepcopy__({})

    def __deepcopy__(self: T, memo: dict[int, Any]) -> T:
        import copy

        other = type(self).__new__(type(self))
        other.__dict__.update(self.__dict__)
        other._native = self._native.copy()
        other._journal, other._index = copy.deepcopy(self._home(), memo), self._place()
        return other

    def __reduce__(self) -> tuple[Any, ...]:
        return _thing, (self._home(), self._place())


def _replayed(made: list[tuple[type, tuple[Any, ...], dict[str, Any]]],
              done: list[tuple[int, str, tuple[Any, ...]]]) -> Journal:
    journal = Journal()
    for kind, arguments, settings in made:
        thing: Journaled = kind(*arguments, **settings)
        thing._journal, thing._index = journal, len(journal.things)
        journal.things.append(thing)
    journal.made = made
    for index, method, told in done:
        journal.things[index]._do(method, *(journal.things[one.place] if isinstance(one, _Other) else one for one in told))
    return journal


def _thing(journal: Journal, index: int) -> Journaled:
    return journal.things[index]
