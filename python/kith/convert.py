"""Robots of other programs as kith's tables:

    python -m kith.convert lake.json -o lake.toml       Gymnasium's env.unwrapped.P, written by json.dump
    python -m kith.convert m.tra -o m.toml              PRISM's explicit files; m.lab, m.sta and rewards lie beside it
    python -m kith.convert old.toml -o new.toml         a domain file whose [model] names such files
    python -m kith.convert agent.json -o policy.csv     what an agent does, for `kith infer`

The states and the transitions are written beside the domain file, as CSV. This needs Python alone and runs as a file,
too: python3 convert.py FILE -o DOMAIN.toml.
"""

from __future__ import annotations

import argparse
import csv
import io
import json
import math
import pathlib
import re
import sys
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple, Optional, Union

if TYPE_CHECKING or __package__:
    from ._settings import toml_key, toml_value
else:  # run as a file
    from _settings import toml_key, toml_value

Step = Union[int, str]


class Wrong(ValueError):
    """What is wrong with a file, where, and what mends it."""

    def __init__(self, place: str, message: str, help: str) -> None:
        super().__init__(f"{place + ': ' if place else ''}{message}\nhelp: {help}")


class Tables(NamedTuple):
    """The texts of a model."""

    states: str
    transitions: str


class State:
    """As a row of the table of states."""

    def __init__(self, key: str, terminal: bool = False) -> None:
        self.key, self.terminal = key, terminal
        self.name = ""
        self.start = self.initial = False
        self.variables: Sequence[int] = ()


class Mdp:
    """One world: its states, and (state, action, next, probability, features) of every transition."""

    def __init__(self, name: str) -> None:
        self.name = name
        self.states: list[State] = []
        self.outcomes: list[tuple[int, str, int, float, tuple[float, ...]]] = []


def _note(place: str, message: str) -> None:
    print(f"note: {place + ': ' if place else ''}{message}", file=sys.stderr)


# --- files ---


class Text:
    """The text of a file, and where in it something stands. Without a file: of a table in memory."""

    def __init__(self, path: Optional[pathlib.Path]) -> None:
        self.name = "" if path is None else str(path)
        self.text = ""
        if path is None:
            return
        data = path.read_bytes()
        if data[:2] in (b"\xff\xfe", b"\xfe\xff"):
            raise Wrong(self.name, "the file is UTF-16", "save it as UTF-8")
        try:
            self.text = data.decode("utf-8-sig")
        except UnicodeDecodeError as error:
            raise Wrong(self.name, f"byte {error.start + 1} is not UTF-8", "save it as UTF-8") from None

    def place(self, at: int) -> str:
        """file:line:column of a character."""
        line = self.text.count("\n", 0, at) + 1
        return f"{self.name}:{line}:{at - self.text.rfind(chr(10), 0, at)}"

    def place_of(self, path: Sequence[Step], of_key: bool = False) -> str:
        """Of a value of a JSON text, or of the key before it."""
        if not self.name:
            return "".join(f"[{step}]" if isinstance(step, int) or step.isdigit() else str(step) for step in path)
        return self.place(_locate(self.text, path, of_key))


def _skip(text: str, at: int) -> int:
    while at < len(text) and text[at] in " \t\r\n":
        at += 1
    return at


def _locate(text: str, path: Sequence[Step], of_key: bool) -> int:
    decoder = json.JSONDecoder()
    at = key_at = _skip(text, 0)
    for step in path:
        found, number = at, 0
        is_list = text[at] == "["
        at = _skip(text, at + 1)
        while text[at] not in "]}":
            here: Step = number
            start = at
            if not is_list:
                here, at = decoder.raw_decode(text, at)
                at = _skip(text, _skip(text, at) + 1)
            if here == step:  # the last of two, as json.loads() takes it
                found, key_at = at, start
            at = _skip(text, decoder.raw_decode(text, at)[1])
            at = _skip(text, at + 1) if text[at] == "," else at
            number += 1
        at = found
    return key_at if of_key else at


def _json(file: Text) -> Any:
    def once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        keys = [key for key, _ in pairs]
        twice = next((key for i, key in enumerate(keys) if len(keys) != len(set(keys)) and key in keys[:i]), None)
        if twice is not None:
            raise Wrong(file.name, f"the key \"{twice}\" is given twice in one object", "keep one of them")
        return dict(pairs)

    try:
        return json.loads(file.text, object_pairs_hook=once)
    except json.JSONDecodeError as error:
        raise Wrong(file.place(error.pos), f"this is not valid JSON: {error.msg}", "a JSON validator says more") from None
    except RecursionError:
        raise Wrong(file.name, "the lists are too deep", "P[s][a] is a list of lists") from None


# --- Gymnasium: P[s][a] = [[probability, next state, reward, terminated], ...] ---

_OUTCOME = "for instance [0.8, 3, -1.0, false]; the reward may be a list, a number per feature"


def _is_number(value: Any) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def _entries(file: Text, table: Any, path: tuple[Step, ...], what: str) -> Iterator[tuple[int, Any, tuple[Step, ...]]]:
    """Of a list, or of an object whose keys are numbers."""
    if isinstance(table, (list, tuple)):
        for number, one in enumerate(table):
            yield number, one, (*path, number)
        return
    if not isinstance(table, Mapping):
        raise Wrong(file.place_of(path), "expected a list or an object",
                    "P[s][a] is a list of [probability, next state, reward, terminated]")
    seen: dict[int, str] = {}
    for key, one in table.items():
        if not re.fullmatch("[0-9]+", str(key)):
            raise Wrong(file.place_of((*path, key), of_key=True), f"expected a number as key, not \"{key}\"",
                        "states and actions are numbered from 0")
        if int(key) in seen:
            raise Wrong(file.place_of((*path, key), of_key=True),
                        f"{what} {int(key)} is given twice, as \"{seen[int(key)]}\" and as \"{key}\"",
                        "write numbers without zeros in front, each of them once")
        seen[int(key)] = str(key)
        yield int(key), one, (*path, key)


def _finite(file: Text, number: Any, path: tuple[Step, ...], what: str) -> float:
    if not _is_number(number):
        raise Wrong(file.place_of(path), f"{what} must be a number", "write a number such as -1 or 0.5")
    if not abs(number) < 2**31:  # as features of tables
        raise Wrong(file.place_of(path), f"{what} is too large, or not a finite number", "write a number such as -1 or 0.5")
    return float(number)


class _Outcome(NamedTuple):
    state: int
    action: int
    probability: float
    next: int
    row: tuple[float, ...]
    ended: bool
    path: tuple[Step, ...]


class _Gym:
    """Reads one table. `features`: names of the entries of vectors, if they are known."""

    def __init__(self, file: Text, document: Any, features: Optional[Sequence[str]], actions: Optional[Sequence[str]],
                 initial: Optional[int], name: str) -> None:
        self.file, self.features, self.declared = file, features, actions
        self.document: Mapping[str, Any] = document if isinstance(document, Mapping) and "P" in document else {}
        self.table_path: tuple[Step, ...] = ("P",) if self.document else ()
        self.table = self.document.get("P", document)
        self.mdp = Mdp(name)
        self.has_vectors = "phi" in self.document
        self.read(initial)

    def wrong(self, path: tuple[Step, ...], message: str, help: str) -> Wrong:
        return Wrong(self.file.place_of(path), message, help)

    def read(self, initial: Optional[int]) -> None:
        numbers = [s for s, _, _ in _entries(self.file, self.table, self.table_path, "state")]
        self.num_states = len(numbers)
        if not numbers:
            raise self.wrong(self.table_path, "there are no states", "P[s][a] is a list of outcomes")
        if max(numbers) + 1 != len(numbers):
            raise self.wrong(self.table_path, f"there are {len(numbers)} states, but one is number {max(numbers)}",
                             "states are numbered 0, 1, 2, ... without gaps")
        outcomes = list(self.outcomes())
        if "phi" in self.document:
            outcomes = self.with_phi(outcomes)
        self.make_states(outcomes)
        self.add_outcomes(outcomes)
        self.mark("starts")
        if initial is None:
            self.mark("initial")
        elif 0 <= initial < self.num_states:
            self.state_of(initial).initial = True
        else:
            raise self.wrong((), f"there is no state {initial} to begin in",
                             f"states are numbered 0 to {self.num_states - 1}")

    def outcomes(self) -> Iterator[_Outcome]:
        is_first = True
        for s, actions, path in _entries(self.file, self.table, self.table_path, "state"):
            for a, found, where in _entries(self.file, actions, path, "action"):
                if not isinstance(found, (list, tuple)):
                    raise self.wrong(where, "P[s][a] must be a list",
                                     "write [[probability, next state, reward, terminated], ...]")
                for i, one in enumerate(found):
                    at = (*where, i)
                    is_sound = (isinstance(one, (list, tuple)) and len(one) == 4 and _is_number(one[0])
                                and _is_number(one[1]) and isinstance(one[3], bool)
                                and (_is_number(one[2]) or isinstance(one[2], (list, tuple))))
                    if not is_sound:
                        raise self.wrong(at, "an outcome must be [probability, next state, reward, terminated]", _OUTCOME)
                    if one[1] != int(one[1]) or not 0 <= one[1] < self.num_states:
                        raise self.wrong((*at, 1), "there is no such state",
                                         f"states are numbered 0 to {self.num_states - 1}")
                    is_vector = isinstance(one[2], (list, tuple))
                    if is_first and not self.has_vectors:
                        self.has_vectors = is_vector
                    is_first = False
                    if is_vector and not self.has_vectors:
                        raise self.wrong((*at, 2), "this reward is a list, but an earlier one is a number",
                                         "write all rewards in one way")
                    if is_vector:
                        row = self.vector(one[2], (*at, 2))
                    elif self.has_vectors and "phi" not in self.document:
                        raise self.wrong((*at, 2), "this reward is a number, but an earlier one is a list",
                                         "write all rewards in one way")
                    else:
                        row = (_finite(self.file, one[2], (*at, 2), "a reward"),)
                    yield _Outcome(s, a, one[0], int(one[1]), row, one[3], at)

    def vector(self, row: Any, path: tuple[Step, ...]) -> tuple[float, ...]:
        if self.features is None:
            self.features = self.document.get("features") or [f"feature{k + 1}" for k in range(len(row))]
        if not isinstance(row, (list, tuple)) or len(row) != len(self.features):
            raise self.wrong(path, f"there are {len(row) if isinstance(row, (list, tuple)) else 1} features, not "
                             f"{len(self.features)}", "one number for each feature, in the order of the domain file")
        return tuple(_finite(self.file, x, (*path, k), "a feature") for k, x in enumerate(row))

    def with_phi(self, outcomes: list[_Outcome]) -> list[_Outcome]:
        """`phi` has the shape of P, with a vector in the place of every outcome."""
        result: list[_Outcome] = []
        for s, actions, path in _entries(self.file, self.document["phi"], ("phi",), "state"):
            for a, vectors, where in _entries(self.file, actions, path, "action"):
                for i, vector in enumerate(vectors if isinstance(vectors, (list, tuple)) else [None]):
                    k = len(result)
                    if k >= len(outcomes) or (outcomes[k].state, outcomes[k].action) != (s, a):
                        raise self.wrong(where, "\"phi\" must have the shape and the order of \"P\"", "a vector per outcome")
                    result.append(outcomes[k]._replace(row=self.vector(vector, (*where, i))))
        if len(result) != len(outcomes):
            raise self.wrong(("phi",), "\"phi\" must have the shape and the order of \"P\"", "a vector per outcome")
        return result

    def make_states(self, outcomes: Sequence[_Outcome]) -> None:
        """A state that is only entered as the end of an episode is terminal. One that is also entered otherwise is both:
        it gets a terminal twin."""
        ended = {one.next for one in outcomes if one.ended}
        entered = {one.next for one in outcomes if not one.ended and one.next != one.state}
        names = self.texts("states")
        if len(names) > self.num_states:
            raise self.wrong(("states",), "there are more names than states", "leave some out")
        self.alive: dict[int, int] = {}
        self.end: dict[int, int] = {}
        for s in range(self.num_states):
            is_state = s not in ended or s in entered
            for numbers, key, wanted in ((self.alive, str(s), is_state),
                                         (self.end, f"{s} (end)" if is_state else str(s), s in ended)):
                if not wanted:
                    continue
                numbers[s] = len(self.mdp.states)
                state = State(key, terminal=numbers is self.end)
                state.name = names[s] if s < len(names) else ""
                self.mdp.states.append(state)

    def texts(self, key: str) -> Sequence[str]:
        value = self.document.get(key, [])
        if not isinstance(value, (list, tuple)) or not all(isinstance(one, str) for one in value):
            raise self.wrong((key,), f"\"{key}\" must be a list of names", "write [\"left\", \"right\", ...]")
        for i, one in enumerate(value):
            if key == "actions" and one in value[:i]:
                raise self.wrong((key, i), f"action '{one}' is listed twice", "give every action a name of its own")
        return [str(one) for one in value]

    def add_outcomes(self, outcomes: Sequence[_Outcome]) -> None:
        names = self.texts("actions")
        merged: dict[tuple[int, str, int, tuple[float, ...]], float] = {}  # two things may happen that lead to one state
        noted = False
        for one in outcomes:
            if one.state not in self.alive:  # after the end nothing happens, although tables often go on there
                if not noted and (one.next != one.state or any(one.row)):
                    _note(self.file.place_of(one.path), f"state {one.state} ends episodes: what happens in it is left "
                          "out (said for the first such state)")
                    noted = True
                continue
            after = self.end[one.next] if one.ended else self.alive.get(one.next, self.end.get(one.next, 0))
            key = (self.alive[one.state], self.name_of(one, names), after, one.row)
            merged[key] = merged.get(key, 0.0) + one.probability
        self.mdp.outcomes = [(s, a, t, p, row) for (s, a, t, row), p in merged.items()]

    def name_of(self, one: _Outcome, names: Sequence[str]) -> str:
        if one.action < len(names):
            return names[one.action]
        if self.declared is None or names:
            return f"action {one.action}"
        if one.action < len(self.declared):
            return self.declared[one.action]
        raise self.wrong(one.path, f"there is no name for action {one.action} in [mdp] actions",
                         "list all actions, in the order of their numbers")

    def state_of(self, s: int) -> State:
        return self.mdp.states[self.alive[s] if s in self.alive else self.end[s]]

    def mark(self, key: str) -> None:
        value = self.document.get(key, [])
        for i, s in enumerate(value if isinstance(value, (list, tuple)) else [value]):
            if not _is_number(s) or s != int(s) or not 0 <= s < self.num_states:
                raise self.wrong((key, *([i] if isinstance(value, (list, tuple)) else [])), "there is no such state",
                                 f"states are numbered 0 to {self.num_states - 1}")
            setattr(self.state_of(int(s)), "start" if key == "starts" else "initial", True)


def _features_of_rewards(mdps: Sequence[Mdp], declared: Sequence[tuple[str, Optional[float]]],
                         place: str) -> dict[str, float]:
    """Every distinct reward other than 0 becomes a feature that is 1 where it is given, and whose weight it is."""
    found: dict[float, None] = {}
    for mdp in mdps:
        for s, _, t, p, row in mdp.outcomes:
            if row[0] != 0 and (t != s or p < 1):  # what is never a choice does not count
                found[row[0]] = None
    values = sorted(found)
    if not 1 <= len(values) <= 8:
        raise Wrong(place, f"the table has {len(values)} different rewards other than 0; each is a feature, of which "
                    "there are 1 to 8", "write feature vectors in place of rewards" if values else
                    "give at least one transition a reward")
    known = ", ".join(repr(float(one)) for one in values)
    weights = {f"reward {float(one)!r}": one for one in values}
    if declared:
        for name, reward in declared:
            if reward is None:
                raise Wrong(place, f"feature '{name}' needs a reward: the table has numbers, not vectors",
                            f"the rewards of the table are {known}")
            if reward not in found:
                raise Wrong(place, f"no transition has the reward of feature '{name}'", f"the rewards are {known}")
        weights = {name: reward for name, reward in declared if reward is not None}
        missing = [one for one in values if one not in weights.values()]
        if missing:
            raise Wrong(place, f"no feature stands for reward {missing[0]!r}",
                        f"declare one: name = \"...\", reward = {missing[0]!r}")
    order = list(weights.values())
    for mdp in mdps:
        mdp.outcomes = [(s, a, t, p, tuple(float(row[0] == one) for one in order)) for s, a, t, p, row in mdp.outcomes]
    return weights


# --- PRISM's explicit files (PRISM manual, appendix "Explicit model files") ---

_MANUAL = "see PRISM's manual, explicit model files"


class _Line(NamedTuple):
    file: Text
    at: int
    text: str
    words: list[str]

    def wrong(self, word: int, message: str, help: str = _MANUAL) -> Wrong:
        starts = [m.start() for m in re.finditer(r"\S+", self.text)]
        return Wrong(self.file.place(self.at + starts[min(word, len(starts) - 1)]), message, help)

    def whole(self, word: int, expected: str, count: int = 2**32 - 1) -> int:
        if word >= len(self.words) or not re.fullmatch("[0-9]+", self.words[word]):
            raise self.wrong(word, f"expected {expected}")
        number = int(self.words[word])
        if number >= count:
            raise self.wrong(word, f"there is no state {number}", f"states are numbered 0 to {count - 1}")
        return number

    def number(self, word: int, expected: str) -> float:
        """Also a fraction, which PRISM writes where it computes exactly."""
        try:
            above, _, below = self.words[word].partition("/")
            number = float(above) / float(below or 1)
        except (ValueError, ZeroDivisionError):
            raise self.wrong(word, f"expected {expected}") from None
        if not math.isfinite(number):
            raise self.wrong(word, f"expected {expected}", "write a number such as -1 or 0.5")
        return number


def _lines(file: Text) -> Iterator[_Line]:
    """Those that say something; a line that begins with # is a comment."""
    at = 0
    for text in file.text.split("\n"):
        line = _Line(file, at, text.rstrip("\r"), text.split())
        at += len(text) + 1
        if line.words and not line.words[0].startswith("#"):
            yield line


def _head(lines: Iterator[_Line], file: Text, expected: str) -> _Line:
    line = next(lines, None)
    if line is None:
        raise Wrong(file.name, f"expected {expected}", "the file may be cut off: export it again")
    return line


class PrismFiles(NamedTuple):
    """One model in PRISM's files."""

    transitions: pathlib.Path
    states: Optional[pathlib.Path]
    labels: Optional[pathlib.Path]
    rewards: Mapping[str, Sequence[pathlib.Path]]
    """By feature: .srew and .trew."""


class _Prism:
    """Reads one model. `terminal` and `start`: labels; without, states that are never left end an episode."""

    def __init__(self, files: PrismFiles, terminal: str, start: str, name: str) -> None:
        self.mdp = Mdp(name)
        self.variables: list[str] = []
        self.found: dict[tuple[int, int, int], float] = {}  # probability by state, choice and next state
        self.action_of: dict[tuple[int, int], str] = {}  # by state and choice
        self.file = Text(files.transitions)
        self.read_transitions()
        if files.states is not None:
            self.read_states(Text(files.states))
        rewards = [self.read_rewards([Text(path) for path in paths]) for paths in files.rewards.values()]
        if files.labels is not None:
            self.read_labels(Text(files.labels), terminal, start)
        if not terminal:
            left = {s for (s, _, t), p in self.found.items() if s != t and p > 0}
            for s, state in enumerate(self.mdp.states):
                state.terminal = s not in left
        self.add_outcomes(rewards)

    def read_transitions(self) -> None:
        expected = "the numbers of states, choices and transitions of an MDP, as in '6 10 16'"
        lines = _lines(self.file)
        head = _head(lines, self.file, expected)
        if len(head.words) != 3:
            raise head.wrong(0, f"expected {expected}")
        self.num_states, _, num_transitions = (head.whole(i, expected) for i in range(3))
        if self.num_states == 0 or self.num_states > len(self.file.text):  # and most states have a line
            raise head.wrong(0, "the first line declares more states than the file can have, or none",
                             "the file may be cut off: export it again")
        self.mdp.states = [State(str(s)) for s in range(self.num_states)]
        count = 0
        choice_of: dict[tuple[int, str], int] = {}
        for line in lines:
            count += 1
            words = line.words
            if len(words) > 2 and ":" in words[2]:
                raise line.wrong(2, "this was exported with rows", "export without -exportrows")
            if len(words) > 3 and words[3].startswith("["):
                raise line.wrong(3, "the probabilities are intervals (an interval MDP); kith needs numbers",
                                 "choose a probability in each interval")
            if len(words) not in (4, 5):
                raise line.wrong(0, "expected state, choice, next state, probability and perhaps an action")
            s, t = line.whole(0, "a state", self.num_states), line.whole(2, "a state", self.num_states)
            choice, chance = line.whole(1, "the number of a choice"), line.number(3, "a probability")
            if len(words) == 4 and s == t and chance == 1:  # how PRISM writes that nothing can be done
                continue
            action = words[4] if len(words) == 5 else f"choice {choice}"
            is_same = (self.action_of.setdefault((s, choice), action) == action
                       and choice_of.setdefault((s, action), choice) == choice)
            if not is_same:
                raise line.wrong(4, f"choices and actions of state {s} do not match: each choice must be a different "
                                 "action", "give every choice of a state an action of its own")
            if (s, choice, t) in self.found:
                raise line.wrong(0, "this transition is given twice", "write one with the sum of the probabilities")
            self.found[s, choice, t] = chance
        if count != num_transitions:
            raise head.wrong(0, f"the first line declares {num_transitions} transitions, but there are {count}",
                             "the file may be cut off: export it again")

    def read_states(self, file: Text) -> None:
        """"(a,b)", then "i:(1,2)"."""
        lines = _lines(file)
        head = _head(lines, file, "the names of variables, as in '(x,y)'")
        names = re.fullmatch(r"\s*\((.+)\)\s*", head.text)
        if names is None:
            raise head.wrong(0, "expected the names of variables, as in '(x,y)'")
        self.variables = names[1].split(",")
        values: dict[int, list[int]] = {}
        for line in lines:
            found = re.fullmatch(r"\s*([0-9]+)\s*:\s*\(([^)]*)\)\s*", line.text)
            parts = found[2].split(",") if found else []
            if found is None or len(parts) != len(self.variables):
                raise line.wrong(0, f"expected a state and its {len(self.variables)} values, as in '3:(1,0)'")
            s = int(found[1])
            if s >= self.num_states or s in values:
                raise line.wrong(0, f"state {s} is given twice" if s in values else f"there is no state {s}",
                                 f"states are numbered 0 to {self.num_states - 1}")
            try:
                values[s] = [{"true": 1, "false": 0}[one] if one in ("true", "false") else int(one) for one in parts]
            except ValueError:
                raise line.wrong(0, "expected integers, true or false") from None
        for s, state in enumerate(self.mdp.states):
            if s not in values:
                raise Wrong(file.name, f"state {s} is missing", f"it needs a line for every state of {self.file.name}")
            state.variables = values[s]

    def read_rewards(self, files: Sequence[Text]) -> tuple[dict[int, float], dict[tuple[int, int, int], float]]:
        """.srew: "n m", then "i x"; .trew: "n c m", then "i k j x"."""
        of_states: dict[int, float] = {}
        of_transitions: dict[tuple[int, int, int], float] = {}
        acting = {s for s, _, _ in self.found}
        for file in files:
            lines = _lines(file)
            head = _head(lines, file, "a line with the numbers of states and rewards")
            width = {2: 2, 3: 4}.get(len(head.words))
            if width is None:
                raise head.wrong(0, "expected 'states rewards' (.srew) or 'states choices rewards' (.trew)")
            if head.whole(0, "the number of states") != self.num_states:
                raise head.wrong(0, f"these are not the rewards of this model: it has {self.num_states} states",
                                 "export all files at once")
            seen: set[Union[int, tuple[int, int, int]]] = set()
            for line in lines:
                if len(line.words) != width:
                    raise line.wrong(0, "expected a state and its reward" if width == 2 else
                                     "expected state, choice, next state and reward")
                s, reward = line.whole(0, "a state", self.num_states), line.number(width - 1, "a number")
                transition = None if width == 2 else (s, line.whole(1, "a choice"),
                                                      line.whole(2, "a state", self.num_states))
                if (transition or s) in seen:
                    what = "state" if width == 2 else "transition"
                    raise line.wrong(0, f"the reward of this {what} is given twice", "keep one of the lines")
                seen.add(transition or s)
                if transition is not None and transition in self.found:
                    of_transitions[transition] = of_transitions.get(transition, 0.0) + reward
                elif transition is not None and (s in acting or transition != (s, 0, s)):
                    raise line.wrong(0, f"there is no such transition in {self.file.name}", "export all files at once")
                elif reward:
                    of_states[s] = of_states.get(s, 0.0) + reward
                    if s not in acting:
                        _note(line.file.name, f"the reward of state {s}, in which nothing can be done, is left out")
        return of_states, of_transitions

    def read_labels(self, file: Text, terminal: str, start: str) -> None:
        """'0="init" 1="deadlock" 2="goal"', then "i: 0 2"."""
        expected = "the names of labels, as in '0=\"init\" 1=\"goal\"'"
        lines = _lines(file)
        head = _head(lines, file, expected)
        names: dict[int, str] = {}
        for i, word in enumerate(head.words):
            found = re.fullmatch('([0-9]+)="(.+)"', word)
            if found is None:
                raise head.wrong(i, f"expected {expected}")
            if int(found[1]) in names:
                raise head.wrong(i, f"label {found[1]} is named twice", "give every label a number of its own")
            names[int(found[1])] = found[2]
        for wanted in (terminal, start):
            if wanted and wanted not in names.values():
                raise head.wrong(0, f"there is no label '{wanted}'", "known: " + ", ".join(names.values()))
        seen: set[int] = set()
        for line in lines:
            if not re.fullmatch("[0-9]+:", line.words[0]):
                raise line.wrong(0, "expected a state and its labels, as in '3: 1 2'")
            s = int(line.words[0][:-1])
            if s >= self.num_states or s in seen:
                raise line.wrong(0, f"state {s} is given twice" if s in seen else f"there is no state {s}",
                                 "write all labels of a state on one line" if s in seen else
                                 f"states are numbered 0 to {self.num_states - 1}")
            seen.add(s)
            for i in range(1, len(line.words)):
                name = names.get(line.whole(i, "the number of a label"))
                if name is None:
                    raise line.wrong(i, "expected the number of a label")
                state = self.mdp.states[s]
                state.terminal = state.terminal or name == terminal
                state.start = state.start or (bool(start) and name == start)
                state.initial = state.initial or name == "init"

    def add_outcomes(self, rewards: Sequence[tuple[dict[int, float], dict[tuple[int, int, int], float]]]) -> None:
        noted = False
        for (s, choice, t), chance in self.found.items():
            row = tuple(of_transitions.get((s, choice, t), 0.0) + of_states.get(s, 0.0)
                        for of_states, of_transitions in rewards)
            if not self.mdp.states[s].terminal:
                self.mdp.outcomes.append((s, self.action_of[s, choice], t, chance, row))
            elif not noted and (t != s or any(row)):
                _note(self.file.name, f"state {s} ends an episode: what happens in it is left out (said for the first "
                      "such state)")
                noted = True


def _beside(transitions: pathlib.Path) -> PrismFiles:
    """m.sta, m.lab and m.*rew beside m.tra; a reward structure is called as its file says, or as the file is called."""
    def one(suffix: str) -> Optional[pathlib.Path]:
        path = transitions.with_suffix(suffix)
        return path if path.is_file() else None

    stem = transitions.stem
    rewards: dict[str, list[pathlib.Path]] = {}
    for path in sorted(transitions.parent.iterdir()):
        middle = re.fullmatch(re.escape(stem) + r"(?:\.(.+)|([0-9]*))\.[st]rew", path.name)
        if middle is None or path.with_suffix(".tra") != transitions and path.with_suffix(".tra").is_file():
            continue
        said = re.search('^# Reward structure "(.+)"', Text(path).text, re.MULTILINE)
        name = said[1] if said else middle[1] or f"reward{middle[2]}"
        rewards.setdefault(name, []).append(path)
    return PrismFiles(transitions, one(".sta"), one(".lab"), rewards)


# --- what is written ---


def _plain(number: float) -> str:
    return str(int(number)) if number == int(number) and abs(number) < 2**53 else repr(float(number))


def tables(mdps: Sequence[Mdp], variables: Sequence[str], features: Sequence[str]) -> Tables:
    """The states and the transitions, as CSV."""
    states = [state for mdp in mdps for state in mdp.states]
    has_worlds = len(mdps) > 1 or bool(mdps[0].name)
    flags = [flag for flag in ("start", "initial") if any(getattr(state, flag) for state in states)]
    names = ["name"] if any(state.name for state in states) else []
    taken = {"mdp", "state", "name", "terminal", "start", "initial"}
    columns = [name + "_" if name in taken else name for name in variables]

    def text_of(head: Sequence[str], rows: Iterable[Sequence[Any]]) -> str:
        out = io.StringIO()
        writer = csv.writer(out, lineterminator="\n")
        writer.writerow(head)
        writer.writerows(rows)
        return out.getvalue()

    world = ["mdp"] if has_worlds else []
    return Tables(
        text_of([*world, "state", *names, "terminal", *flags, *columns],
                ([*([mdp.name] if has_worlds else []), state.key, *([state.name] if names else []),
                  str(state.terminal).lower(), *(str(getattr(state, flag)).lower() for flag in flags), *state.variables]
                 for mdp in mdps for state in mdp.states)),
        text_of([*world, "state", "action", "next", "probability", *features],
                ([*([mdp.name] if has_worlds else []), mdp.states[s].key, action, mdp.states[t].key, _plain(p),
                  *(_plain(x) for x in row)] for mdp in mdps for s, action, t, p, row in mdp.outcomes)))


def gym_tables(document: Any, features: Optional[Sequence[str]]) -> tuple[Tables, dict[str, float]]:
    """Those of a table P in memory, whose vectors are `features`; without features, every distinct reward is one, and
    its weight. ValueError if something is wrong with it."""
    found = _Gym(Text(None), document, features or None, None, None, "")
    weights = {} if found.has_vectors else _features_of_rewards([found.mdp], (), "")
    return tables([found.mdp], (), features or list(weights)), weights


def _domain_text(document: Mapping[str, Any]) -> str:
    """A domain file: what is in a table stands in a line each."""
    text, rest = "", ""
    for name, value in document.items():
        is_list = isinstance(value, list) and bool(value) and all(isinstance(one, Mapping) for one in value)
        if not is_list and not isinstance(value, Mapping):
            text += f"{name} = {toml_value(value)}\n"
            continue
        for one in value if is_list else [value]:
            rest += f"\n[[{name}]]\n" if is_list else f"\n[{name}]\n"
            rest += "".join(f"{toml_key(key)} = {toml_value(part)}\n" for key, part in one.items())
    return text + rest


class _Model(NamedTuple):
    """What a file says, before it is written."""

    mdps: list[Mdp]
    variables: list[str]
    features: list[str]
    weights: dict[str, float]
    document: dict[str, Any]
    """Of the domain file, but for what is said here."""


def _of_domain_file(path: pathlib.Path) -> _Model:
    try:
        import tomllib
    except ImportError:
        raise Wrong(str(path), "reading a domain file needs Python 3.11", "convert the model itself: FILE.tra, FILE.json"
                    ) from None
    text = Text(path).text
    try:
        document = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise Wrong(str(path), f"this is not valid TOML: {error}", "kith validate shows where") from None
    model = document.get("model", {})
    kind, given = model.get("format"), model.get("mdp", [])
    line = next((i for i, one in enumerate(text.splitlines(), 1) if re.match(r"\s*\[model\]", one)), 1)
    place = f"{path}:{line}"
    if kind not in ("prism", "gym-json"):
        raise Wrong(place, "this domain file names no files of PRISM or Gymnasium", "kith reads it as it is")
    if not isinstance(given, list) or not given:
        raise Wrong(place, "there is no [[model.mdp]]", "write one below [model], with the names of its files")
    declared = [(str(one.get("name", "")), one.get("reward")) for one in document.get("feature", [])]
    features = [name for name, _ in declared]

    def file_of(one: Mapping[str, Any], key: str, needed: bool = True) -> Optional[pathlib.Path]:
        if key not in one and not needed:
            return None
        if not isinstance(one.get(key), str):
            raise Wrong(place, f"key '{key}' is missing in [[model.mdp]]", "write the name of the file")
        return path.parent / str(one[key])

    weights: dict[str, float] = {}
    variables: list[str] = []
    if kind == "prism":
        labels = (str(model.get("terminal", "")), str(model.get("start", "")))
        prisms = []
        for one in given:
            named = one.get("rewards", {})
            if set(named) != set(features):
                odd = sorted(set(named) ^ set(features))[0]
                raise Wrong(place, f"feature '{odd}' has no rewards" if odd in features else f"there is no feature "
                            f"'{odd}'", "rewards = { FEATURE = \"FILE\" }, or an empty list if it never occurs")
            rewards = {name: [path.parent / file for file in ([named[name]] if isinstance(named[name], str) else
                                                              named[name])] for name in features}
            files = PrismFiles(file_of(one, "transitions") or path, file_of(one, "states", False),
                               file_of(one, "labels", any(labels)), rewards)
            prisms.append(_Prism(files, *labels, str(one.get("name", ""))))
        mdps, variables = [one.mdp for one in prisms], prisms[0].variables
        if any(one.variables != variables for one in prisms):
            raise Wrong(place, "the MDPs have different variables", "all MDPs of a domain share their variables")
    else:
        gyms = []
        for one in given:
            text_of = Text(file_of(one, "file"))
            gyms.append(_Gym(text_of, _json(text_of), features if features and all(reward is None for _, reward in declared)
                             else None, document.get("mdp", {}).get("actions"), one.get("initial"), str(one.get("name", ""))))
        mdps = [one.mdp for one in gyms]
        if len({one.has_vectors for one in gyms}) > 1:
            raise Wrong(place, "some of the tables have vectors, others numbers", "write all of them in one way")
        if not gyms[0].has_vectors:
            if "reward" in document:
                raise Wrong(place, "the weights follow from the rewards of the table", "leave out [reward]")
            weights = _features_of_rewards(mdps, declared, place)
        elif any(reward is not None for _, reward in declared):
            raise Wrong(place, "a feature has a reward, but the table has vectors", "write it as a weight under [reward]")
        features = features or list(weights)
    rest = {key: value for key, value in document.items() if key not in ("model", "feature")}
    if "drawing" in model:
        rest["model"] = {"drawing": model["drawing"]}
    return _Model(mdps, variables, features, weights, rest)


def _of_model(path: pathlib.Path, options: argparse.Namespace, id: str) -> _Model:
    document: dict[str, Any] = {"schema": "kith.domain/1", "id": id}
    if options.discount is not None:
        document["mdp"] = {"discount": options.discount}
    if path.suffix == ".json":
        file = Text(path)
        table = _Gym(file, _json(file), None, None, options.initial, "")
        weights = {} if table.has_vectors else _features_of_rewards([table.mdp], (), str(path))
        features = list(table.features or weights)
        mdps, variables = [table.mdp], list[str]()
    else:
        path.stat()
        files = _beside(path)
        if not files.rewards:
            raise Wrong(str(path), "there are no rewards beside it", f"export them as {path.stem}.NAME.srew or .trew")
        prism = _Prism(files, options.terminal, options.start, "")
        mdps, variables, features, weights = [prism.mdp], prism.variables, list(files.rewards), {}
    return _Model(mdps, variables, features, weights, document)


def _converted(path: pathlib.Path, out: pathlib.Path, options: argparse.Namespace) -> dict[pathlib.Path, str]:
    """The files that are written, with their texts."""
    id = re.sub("[^a-z0-9]+", "-", out.stem.lower()).strip("-") or "robot"
    model = _of_domain_file(path) if path.suffix == ".toml" else _of_model(path, options, id)
    weights = dict(model.weights)
    for one in options.weights:
        name, _, number = one.rpartition("=")
        if name not in model.features:
            raise Wrong("", f"--weights: there is no feature '{name}'", "known: " + ", ".join(model.features))
        weights[name] = float(number)
    if weights and set(weights) != set(model.features):
        missing = next(name for name in model.features if name not in weights)
        raise Wrong("", f"--weights: what feature '{missing}' is worth is missing", f"--weights {missing}=-1")

    stem = out.stem.replace("-", "_")
    names = (f"{stem}_states.csv", f"{stem}_transitions.csv")
    document = dict(model.document)
    document["model"] = {"format": "csv", "states": names[0], "transitions": names[1], **document.pop("model", {})}
    document["feature"] = [{"name": name} for name in model.features]
    if weights:
        document["reward"] = {"weights": {name: weights[name] for name in model.features}}
    elif "reward" not in document:
        _note(str(out), "it has no [reward] yet: give --weights NAME=NUMBER ..., or run kith infer")
    texts = tables(model.mdps, model.variables, model.features)
    return {out: _domain_text(document), out.parent / names[0]: texts.states, out.parent / names[1]: texts.transitions}


# --- policies ---


def policy_text(policy: Any, file: Optional[Text] = None) -> str:
    """The table of an agent's choices: a list with the number of an action per state, or with the probabilities of all;
    None where nothing is known. Of several worlds: an object of such lists."""
    file = file or Text(None)
    worlds: Iterable[tuple[Optional[str], Any]] = policy.items() if isinstance(policy, Mapping) else [(None, policy)]
    rows: list[tuple[Any, ...]] = []
    has_chances = False
    for world, states in worlds:
        path: tuple[Step, ...] = () if world is None else (world,)
        if not isinstance(states, list):
            raise Wrong(file.place_of(path), "expected a list with an action per state", "write [0, 2, 1] or [[1, 0], ...]")
        for s, one in enumerate(states):
            head = (s,) if world is None else (world, s)
            if isinstance(one, list) and all(_is_number(p) for p in one):
                has_chances = True
                rows += [(*head, a, p) for a, p in enumerate(one)]
            elif _is_number(one) and one == int(one) and one >= 0:
                rows.append((*head, int(one), 1))
            elif one is not None:
                raise Wrong(file.place_of((*path, s)), "expected the number of an action, or the probabilities of all",
                            "null where nothing is known")
    world_column = ["world"] if isinstance(policy, Mapping) else []
    lines = [[*world_column, "state", "action", *(["probability"] if has_chances else [])]]
    lines += [[str(x) for x in (row if has_chances else row[:-1])] for row in rows if not has_chances or row[-1] != 0]
    return "".join(",".join(f'"{x}"' if "," in x else x for x in line) + "\n" for line in lines)


# --- the command ---


def main(arguments: Optional[Sequence[str]] = None) -> int:
    parser = argparse.ArgumentParser(prog="python -m kith.convert", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", type=pathlib.Path, help="FILE.tra, FILE.json, or a domain file that names such files")
    parser.add_argument("-o", "--out", type=pathlib.Path, required=True, help="DOMAIN.toml, or POLICY.csv")
    parser.add_argument("--weights", nargs="+", default=[], metavar="NAME=NUMBER", help="what features are worth")
    parser.add_argument("--discount", type=float, help="of rewards (default: 1)")
    parser.add_argument("--initial", type=int, metavar="STATE", help="where a robot enters (Gymnasium)")
    parser.add_argument("--terminal", default="", metavar="LABEL", help="of states that end an episode (PRISM)")
    parser.add_argument("--start", default="", metavar="LABEL", help="of states in which lessons may begin (PRISM)")
    parser.add_argument("--yes", action="store_true", help="replace existing files")
    options = parser.parse_args(arguments)
    if options.file.suffix not in (".tra", ".json", ".toml"):
        parser.error(f"{options.file}: its name ends in .tra (PRISM's transitions), .json (Gymnasium) or .toml")
    try:
        if options.out.suffix == ".csv":
            file = Text(options.file)
            written = {options.out: policy_text(_json(file), file)}
        else:
            written = _converted(options.file, options.out, options)
        for path in written:
            if path.exists() and not options.yes:
                raise Wrong(str(path), "the file exists", "choose another name, or add --yes to replace it")
        for path, text in written.items():
            path.write_text(text, encoding="utf-8", newline="")
            print(f"wrote {path}")
    except Wrong as error:
        print(f"error: {error}", file=sys.stderr)
        return 3
    except OSError as error:
        print(f"error: {error.filename}: {error.strerror}", file=sys.stderr)
        return 5
    return 0


if __name__ == "__main__":
    sys.exit(main())
