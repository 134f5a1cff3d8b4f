"""Weights for a robot whose reward nobody wrote down: those under which its policy is optimal."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Optional

from . import _core
from ._errors import Error
from ._models import _feature_array, _numbers

MOST = 2**20
"""Normals that are expectations are rounded to whole numbers of about this length, as kith does with its own."""
LEAST = 0.5
"""A policy of which weights explain less is not taught."""


@dataclass(frozen=True)
class Explanation:
    """What reward weights say about a policy."""

    region: _core.Cone
    """Weights that explain as much as these do; of an optimal policy, all under which it is optimal."""
    weights: tuple[float, ...]
    """Inside the region, of about length 1, with few digits."""
    share: float
    """Share of the states in which the policy does what is best under the weights."""
    loss: float
    """Return that the policy loses by the best single change of its action, mean over states; weights of length 1."""
    unexplained: list[int]
    """States in which it does something else."""


def _choices(policy: Any, states: int, actions: int) -> Any:
    """Probabilities, shape [S, A]."""
    import numpy as np

    given = _numbers(policy, "policy")
    if given.shape == (states,):
        if (given != np.floor(given)).any() or (given < 0).any() or (given >= actions).any():
            raise ValueError(f"policy must be numbers of actions, 0 to {actions - 1}")
        return np.eye(actions)[given.astype(int)]
    if given.shape != (states, actions):
        raise ValueError(f"policy must have shape ({states},) or ({states}, {actions}), not {given.shape}")
    if (given < 0).any() or (abs(given.sum(axis=1) - 1) > 1e-6).any():
        raise ValueError("the probabilities of policy must sum to 1 in every state")
    return given


def _whole(normals: Any) -> list[tuple[int, ...]]:
    """Normals as whole numbers: exactly where they are, else rounded."""
    import numpy as np

    rounded = np.round(normals)
    if (abs(normals - rounded) < 1e-9).all() and (abs(rounded) < 2**31).all():
        return [tuple(int(x) for x in row) for row in rounded]
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    return [tuple(int(x) for x in row) for row in np.round(normals / lengths * MOST)]


def _short(weights: Any, region: _core.Cone) -> Any:
    """The same direction, or nearly, with as few digits as keep it inside the region."""
    import numpy as np

    normals = np.array(region.facets, dtype=float).reshape(-1, len(weights))
    for digits in range(2, 9):
        short = np.round(weights, digits)
        if short.any() and (normals @ short > 0).all():
            return short
    return weights


def explain_policy(transitions: Any, features: Any, policy: Any, *, discount: float = 1.0,
                   terminal: Optional[Sequence[int]] = None, prior: Any = None) -> Explanation:
    """The weights under which a policy is optimal or, if there are none, some that explain most of it.

    transitions, features, terminal, discount and prior as of Domain.from_arrays(); policy: an action per state, shape
    [S], or probabilities, shape [S, A]. kith.Error if no weights explain half of the states.
    """
    import numpy as np

    chance = _numbers(transitions, "transitions")
    if chance.ndim != 3 or chance.shape[0] != chance.shape[2] or 0 in chance.shape:
        raise ValueError(f"transitions must have shape (S, A, S), not {chance.shape}")
    states, actions, _ = chance.shape
    phi = _feature_array(features, (states, actions), "features")
    d = phi.shape[3]
    there = chance.sum(axis=2) > 0
    if terminal is None:
        ends = np.array([all(chance[s, a, s] == 1 or not there[s, a] for a in range(actions)) for s in range(states)])
    else:
        ends = np.isin(np.arange(states), [int(s) for s in terminal])
    takes = _choices(policy, states, actions) * there
    expected = (chance[:, :, :, None] * phi).sum(axis=2) if phi.shape[2] > 1 else phi[:, :, 0, :]
    goes_on = chance * ~ends
    acting = np.flatnonzero(~ends)
    leads = np.einsum("sa,sat->st", takes, goes_on)[np.ix_(acting, acting)]
    counts = np.zeros((states, d))
    try:
        counts[acting] = np.linalg.solve(np.eye(len(acting)) - discount * leads, np.einsum("sa,sak->sk", takes, expected)[acting])
    except np.linalg.LinAlgError:
        raise ValueError("from some states the policy never ends; with discount = 1 every path must") from None
    if not np.isfinite(counts).all() or abs(counts).max(initial=0.0) > 2**31:
        raise ValueError("from some states the policy never ends; with discount = 1 every path must")
    ahead = expected + discount * np.einsum("sat,tk->sak", goes_on, counts)
    # n . w >= 0: what the policy does at s is no worse than b once, and then the policy. As everywhere in kith, actions
    # that never leave their state do not count.
    pairs = [(int(s), b) for s in acting for b in range(actions) if there[s, b] and takes[s, b] < 1 and chance[s, b, s] < 1
             and abs(counts[s] - ahead[s, b]).max() > 1e-9]
    base = _core.Cone(prior if prior is not None else (), d)
    if not pairs:
        raise Error("nothing follows from this policy: every action counts the same", "infeasible")
    normals = np.array([counts[s] - ahead[s, b] for s, b in pairs])
    wholes = _whole(normals)
    region = base.clipped(sorted(set(wholes)))
    owner = np.array([s for s, _ in pairs])
    if region is None:
        region = _most(base, normals, wholes, owner)
    interior = np.array([np.array(ray) / np.linalg.norm(ray) for ray in region.generators]).sum(axis=0)
    if not region.contains(interior if abs(interior).max() > 1e-9 else region.interior):
        interior = np.array(region.interior, dtype=float)
    weights = _short(interior / np.linalg.norm(interior), region)
    values = normals @ weights
    wrong = sorted(set(owner[values < -1e-9].tolist()))
    share = 1 - len(wrong) / len(acting)
    loss = float(np.mean([max(0.0, *(-values[owner == s]), 0.0) for s in acting]))
    if share < LEAST:
        raise Error(f"no weights found explain this policy: the best explain {100 * share:.0f} % of its states, in "
                    "which it does what is best; another feature would have to tell the others apart", "infeasible")
    return Explanation(region, tuple(float(w) for w in weights), share, loss, wrong)


def _most(base: _core.Cone, normals: Any, wholes: list[tuple[int, ...]], owner: Any) -> _core.Cone:
    """The region of weights that satisfy all constraints of the states that some weights satisfy; these are the best of
    many that cover the sphere, improved by what they nearly satisfy."""
    import numpy as np

    points = base.cover(4096)
    number = {s: i for i, s in enumerate(sorted(set(owner.tolist())))}
    index = np.array([number[s] for s in owner.tolist()])
    best, most = points[0], -1
    for begin in range(0, len(points), 512):
        block = points[begin:begin + 512]
        worst = np.full((len(block), len(number)), np.inf)
        np.minimum.at(worst.T, index, (block @ normals.T).T)
        right = (worst >= -1e-9).sum(axis=1)
        if right.max() > most:
            most, best = int(right.max()), block[int(right.argmax())]
    margins = np.full(len(number), np.inf)
    np.minimum.at(margins, index, normals @ best)
    region = base
    for s in sorted(number, key=lambda state: -float(margins[number[state]])):
        smaller = region.clipped([wholes[i] for i in np.flatnonzero(owner == s)])
        region = smaller if smaller is not None else region
    return region
