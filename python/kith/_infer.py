"""Weights for a robot whose reward nobody wrote down, as `kith infer` finds them."""

from __future__ import annotations

from typing import Any, NamedTuple

from . import _core
from ._models import _numbers, file_from_arrays
from .convert import policy_text


class Explanation(NamedTuple):
    """What reward weights say about a policy."""

    region: _core.Cone
    """All weights under which the policy is optimal or, if there are none, under which what is best stays so."""
    weights: tuple[float, ...]
    """Inside the region, of about length 1, with few digits."""
    share: float
    """Share of what the policy does that is best under the weights, mean over states."""
    loss: float
    """Return that its actions give away, mean over states; weights of length 1."""
    margin: float
    """Sine of the angle from the weights to the nearest facet of the region."""
    unexplained: list[int]
    """States in which what it does most often is not best."""
    sides: list[tuple[tuple[int, ...], int]]
    """Facets of the region, and in how many states the policy shows each; 0 if the prior says it."""
    clashes: list[list[int]]
    """States in which the policy prefers what no weights prefer together: a further feature would tell them apart."""


def _choices(policy: Any, states: int, actions: int) -> Any:
    """Actions, shape [S], or probabilities, shape [S, A]; None for a state in which nothing is known."""
    import numpy as np

    known = [s for s, one in enumerate(policy) if one is not None]
    if len(known) < len(policy) == states:
        choices = iter(_choices([policy[s] for s in known], len(known), actions))
        return [None if one is None else next(choices) for one in policy]
    given = _numbers(policy, "policy")
    if given.shape == (states,):
        if (given != np.floor(given)).any() or (given < 0).any() or (given >= actions).any():
            raise ValueError(f"policy must be numbers of actions, 0 to {actions - 1}")
        return given.astype(int).tolist()
    if given.shape != (states, actions):
        raise ValueError(f"policy must have shape ({states},) or ({states}, {actions}), not {given.shape}")
    if (given < 0).any() or (abs(given.sum(axis=1) - 1) > 1e-6).any():
        raise ValueError("the probabilities of policy must sum to 1 in every state")
    return given.tolist()


def infer(transitions: Any, features: Any, policy: Any, **options: Any) -> tuple[_core.Domain, Explanation]:
    """The domain with weights that explain the policy, and how well they do."""
    text, name, files = file_from_arrays(transitions, features, None, **options)
    states, actions = _numbers(transitions, "transitions").shape[:2]
    domain, found = _core.infer(text, name, files, policy_text(_choices(policy, states, actions)))
    return domain, Explanation(**found)


def explain_policy(transitions: Any, features: Any, policy: Any, **options: Any) -> Explanation:
    """The weights under which a policy is optimal or, if there are none, some that explain most of it.

    transitions, features, and options such as terminal, discount and prior as of Domain.from_arrays(); policy: an
    action per state, shape [S], or probabilities, shape [S, A]; None in their place where nothing is known. Actions
    that never leave their state, or after which an end cannot surely be reached, count as unexplained. kith.Error if
    the best weights explain less than half of it, or no more than of a robot that acts at random.
    """
    return infer(transitions, features, policy, **options)[1]
