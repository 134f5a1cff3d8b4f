"""Domain files of models in memory: they are written as tables, and read as any other file is."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Optional

from . import _core
from ._settings import toml_text
from .convert import gym_tables


def _names(names: Optional[Sequence[str]], count: int, what: str) -> list[str]:
    if names is None:
        return [f"{what}{i + 1}" for i in range(count)]
    names = [str(name) for name in names]
    if len(names) != count:
        raise ValueError(f"there are {count} {what}s, but {len(names)} names")
    return names


def _numbers(array: Any, what: str) -> Any:
    import numpy as np

    try:
        if np.iscomplexobj(array):
            raise TypeError("complex numbers")
        numbers = np.asarray(array, dtype=float)
    except (TypeError, ValueError) as error:
        raise ValueError(f"{what} must be an array of numbers: {error}") from None
    if not np.isfinite(numbers).all():
        raise ValueError(f"{what} must be finite numbers, without NaN")
    return numbers


def _weights(weights: Any, names: Sequence[str]) -> dict[str, float]:
    if isinstance(weights, Mapping):
        unknown = [str(name) for name in weights if name not in names]
        if unknown:
            raise ValueError(f"there is no feature '{unknown[0]}', only {', '.join(names)}")
        return {name: float(weights.get(name, 0.0)) for name in names}
    numbers = _numbers(weights, "weights")
    if numbers.shape != (len(names),):
        raise ValueError(f"weights must have shape ({len(names)},), one for each feature, not {numbers.shape}")
    return {name: float(one) for name, one in zip(names, numbers)}


def _tidy(number: float) -> float:
    return int(number) if number == int(number) and abs(number) < 2**53 else number


def _file(table: list[Any], features: Sequence[str], weights: Optional[Mapping[str, float]], actions: Sequence[str],
            *, discount: float = 1.0, state_names: Optional[Sequence[str]] = None, initial: Optional[int] = None,
            starts: Optional[Sequence[int]] = None, prior: Any = None, words: Optional[Mapping[str, Any]] = None,
            columns: Optional[int] = None, map: Optional[Mapping[str, Any]] = None,
            id: str = "robot", title: str = "", max_steps: Optional[int] = None) -> tuple[str, str, dict[str, str]]:
    """Text and name of a domain file, and the files that it names; without weights where there are features, nothing
    says what they are worth yet."""
    model: dict[str, Any] = {"P": table, "actions": list(actions)}
    if state_names is not None:
        model["states"] = _names(state_names, len(table), "state")
    if initial is not None:
        model["initial"] = int(initial)
    if starts is not None:
        model["starts"] = [int(s) for s in starts]
    mdp: dict[str, Any] = {"discount": float(discount), "actions": list(actions)}
    if max_steps is not None:
        mdp["max_steps"] = int(max_steps)
    file: dict[str, Any] = {
        "schema": "kith.domain/1", "id": id, "title": title or f"A robot of {len(table)} states", "mdp": mdp,
        "model": {"format": "csv", "states": "states.csv", "transitions": "transitions.csv"}}
    texts, found = gym_tables(model, features)
    file["feature"] = [{"name": name} for name in features or found]
    weights = weights or found
    if weights:
        file["reward"] = {"weights": {name: _tidy(one) for name, one in weights.items()}}
    if prior is not None:
        rows = prior if all(isinstance(one, Mapping) for one in prior) else [
            dict(zip(features, row)) for row in _numbers(prior, "prior").reshape(-1, len(features)).tolist()]
        file["prior"] = {"halfspaces": [{str(name): _tidy(float(x)) for name, x in row.items() if x} for row in rows]}
    if columns is not None:
        file["model"]["drawing"] = {"columns": int(columns)}
    if map is not None:
        file["map"] = dict(map)
    if words is not None:
        file["words"] = dict(words)
    return toml_text(file), id, {"states.csv": texts.states, "transitions.csv": texts.transitions}


def _feature_array(features: Any, shape: tuple[int, int], what: str) -> Any:
    array = _numbers(features, what)
    states, actions = shape
    if array.ndim == 3 and array.shape[:2] == shape:
        array = array[:, :, None, :]
    elif array.ndim != 4 or array.shape[:3] != (states, actions, states):
        raise ValueError(f"{what} must have shape ({states}, {actions}, {states}, d) or ({states}, {actions}, d), "
                         f"not {array.shape}")
    return array


def file_from_arrays(transitions: Any, features: Any, weights: Any, *, terminal: Optional[Sequence[int]] = None,
                     feature_names: Optional[Sequence[str]] = None, action_names: Optional[Sequence[str]] = None,
                     **options: Any) -> tuple[str, str, dict[str, str]]:
    """As of Domain.from_arrays(); weights may be None."""
    import numpy as np

    chance = _numbers(transitions, "transitions")
    if chance.ndim != 3 or chance.shape[0] != chance.shape[2] or 0 in chance.shape:
        raise ValueError(f"transitions must have shape (S, A, S), not {chance.shape}")
    states, actions, _ = chance.shape
    if (chance < 0).any():
        raise ValueError("transitions must not be negative")
    sums = chance.sum(axis=2)
    wrong = np.argwhere((np.abs(sums - 1) > 1e-6) & (sums != 0))
    if len(wrong):
        s, a = (int(i) for i in wrong[0])
        raise ValueError(f"transitions[{s}, {a}] sums to {sums[s, a]:.6g}, not to 1 (or 0 where a state has no such "
                         "action)")
    phi = _feature_array(features, (states, actions), "features")
    names = _names(feature_names, phi.shape[3], "feature")
    stays = np.array([all(chance[s, a, s] == 1 or sums[s, a] == 0 for a in range(actions)) for s in range(states)])
    ends = stays if terminal is None else np.isin(np.arange(states), [int(s) for s in terminal])
    table: list[Any] = []
    for s in range(states):
        rows: list[Any] = []
        for a in range(actions):
            outcomes = []
            leads_to: list[int] = [] if ends[s] else np.flatnonzero(chance[s, a]).tolist()
            for t in leads_to:
                row = phi[s, a, t if phi.shape[2] > 1 else 0]
                outcomes.append([float(chance[s, a, t]), t, [float(x) for x in row], bool(ends[t])])
            rows.append(outcomes)
        table.append(rows)
    given = None if weights is None else _weights(weights, names)
    return _file(table, names, given, _names(action_names, actions, "action"), **options)


def domain_from_arrays(transitions: Any, features: Any, weights: Any, **options: Any) -> _core.Domain:
    if weights is None:
        raise ValueError("features need weights")
    text, name, files = file_from_arrays(transitions, features, weights, **options)
    return _core.Domain.from_text(text, name, files)


def _gym_table(env: Any) -> Any:
    table = getattr(getattr(env, "unwrapped", env), "P", None)
    if table is None:
        raise ValueError("the environment has no table: env.unwrapped.P must be P[state][action] = "
                         "[(probability, next state, reward, terminated), ...]")
    return table


def domain_from_table(env: Any, features: Any, weights: Any, *, feature_names: Optional[Sequence[str]] = None,
                      action_names: Optional[Sequence[str]] = None, **options: Any) -> _core.Domain:
    P = _gym_table(env)
    states = len(P)
    actions = max((len(P[s]) for s in range(states)), default=0)
    if features is None:
        def row(s: int, a: int, t: int, reward: float) -> Any:
            return float(reward)
        names: list[str] = []
    elif isinstance(features, Mapping):
        names = [str(name) for name in features]

        def row(s: int, a: int, t: int, reward: float) -> Any:
            return [float(f(s, a, t)) for f in features.values()]
    else:
        phi = _feature_array(features, (states, actions), "features")
        names = _names(feature_names, phi.shape[3], "feature")

        def row(s: int, a: int, t: int, reward: float) -> Any:
            return [float(x) for x in phi[s, a, t if phi.shape[2] > 1 else 0]]
    table = [[[[float(p), int(t), row(s, a, int(t), r), bool(end)] for p, t, r, end in P[s][a] if p > 0]
              for a in range(len(P[s]))] for s in range(states)]
    distribution = getattr(getattr(env, "unwrapped", env), "initial_state_distrib", None)
    if distribution is not None and "starts" not in options and "initial" not in options:
        begins = [s for s in range(states) if distribution[s] > 0]
        options["initial"] = begins[0]
        if len(begins) > 1:
            options["starts"] = begins
    if features is not None and weights is None:
        raise ValueError("features need weights")
    given = None if features is None else _weights(weights, names)
    options.setdefault("id", _name_of(env))
    text, name, files = _file(table, names, given, _names(action_names, actions, "action"), **options)
    return _core.Domain.from_text(text, name, files)


def _name_of(env: Any) -> str:
    spec = getattr(env, "spec", None)
    name = getattr(spec, "id", None) or type(getattr(env, "unwrapped", env)).__name__
    words = "".join(c if c.isalnum() else "-" for c in str(name)).strip("-").lower()
    return words or "robot"
