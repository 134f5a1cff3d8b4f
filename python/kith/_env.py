"""Teaching as an environment, so that others can learn teachers."""

from __future__ import annotations

import importlib
from typing import Any, Optional

from ._domain import Domain
from ._records import Start
from ._session import People, Session


try:
    _gymnasium: Any = importlib.import_module("gymnasium")
except ImportError:
    _gymnasium = None


class _Discrete:
    """A number from 0 to n - 1; in place of gymnasium.spaces.Discrete where that is not installed."""

    def __init__(self, n: int) -> None:
        import random

        self.n = n
        self._random = random.Random(0)

    def seed(self, seed: Optional[int] = None) -> None:
        self._random.seed(seed)

    def sample(self) -> int:
        return self._random.randrange(self.n)

    def contains(self, x: Any) -> bool:
        return bool(int(x) == x and 0 <= x < self.n)


class _Box:
    """Numbers in [low, high]; in place of gymnasium.spaces.Box where that is not installed."""

    def __init__(self, low: float, high: float, shape: tuple[int, ...]) -> None:
        self.low, self.high, self.shape = low, high, shape

    def contains(self, x: Any) -> bool:
        return bool(x.shape == self.shape and (x >= self.low).all() and (x <= self.high).all())


class TeachingEnv(_gymnasium.Env if _gymnasium is not None else object):  # type: ignore[misc]
    """A team of simulated people to be taught, demonstration by demonstration; Gymnasium's interface.

    action       a number below len(starts): show what the robot does there; len(starts): on to the tests
    observation  what a teacher may know, float32 in [0, 1], shape [3 n + c + 2]: per member how much of the teacher's
                 belief lies in the component and in all there is to understand, and the share of right answers in the
                 last period; one place per component; demonstrations chosen so far and periods, as shares of the most
    reward       the rise of the members' mean knowledge over demonstrations and tests of the period, when it ends
    terminated   all components are learned; truncated: max_periods are over

    options as of Session: study, and keys of a study file.
    """

    metadata: dict[str, Any] = {"render_modes": []}
    render_mode: Optional[str] = None
    MOST = 8
    """Demonstrations of a period; the next one begins the tests."""

    def __init__(self, domain: Domain | str = "item-delivery", group: str = "NNP", *, max_periods: int = 30,
                 study: str = "paper", **settings: Any) -> None:
        self.domain = domain if isinstance(domain, Domain) else Domain(domain)
        self.group = group
        self.starts: list[Start] = self.domain.starts
        self._study, self._settings, self._max_periods = study, settings, int(max_periods)
        size = 3 * len(group) + len(self.domain.components) + 2
        if _gymnasium is None:
            self.action_space: Any = _Discrete(len(self.starts) + 1)
            self.observation_space: Any = _Box(0.0, 1.0, (size,))
        else:
            import numpy as np

            self.action_space = _gymnasium.spaces.Discrete(len(self.starts) + 1)
            self.observation_space = _gymnasium.spaces.Box(0.0, 1.0, (size,), np.float32)
        self._seed = 0
        self._session: Optional[Session] = None

    def reset(self, *, seed: Optional[int] = None, options: Optional[dict[str, Any]] = None) -> tuple[Any, dict[str, Any]]:
        """A new team. Without a seed the next one after that of the last."""
        if _gymnasium is not None:
            super().reset(seed=seed)
        self._seed = int(seed) if seed is not None else self._seed + 1
        self._session = Session(self.domain, self.group, strategy="by-hand", seed=self._seed, study=self._study,
                                **self._settings)
        self._people = People(self.domain, self.group, self._seed, self._study, **self._settings)
        self._chosen: list[Start] = []
        self._ended = False
        return self._observation(), {"seed": self._seed}

    def step(self, action: Any) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        """Shows a demonstration, or begins the tests."""
        if self._session is None:
            raise RuntimeError("call reset() before step()")
        number = int(action)
        if not 0 <= number <= len(self.starts):
            raise ValueError(f"the action must be 0 to {len(self.starts)}, not {number}")
        session = self._session
        if self._ended:
            raise RuntimeError("the episode has ended; call reset()")
        if number < len(self.starts):
            self._chosen.append(self.starts[number])
            if len(self._chosen) < self.MOST:
                return self._observation(), 0.0, False, False, {}
        before = sum(self._people.knowledge) / len(self._people)
        reward = 0.0
        if session.propose(demonstrations=self._chosen):
            lesson = session.lesson
            session.run_period(self._people)
            items = len(lesson.demonstrations) + len(lesson.tests)
            reward = (sum(self._people.knowledge) / len(self._people) - before) / max(items, 1)
        self._chosen = []
        terminated = "open" not in session.components
        truncated = not terminated and (session.phase == "finished" or session.periods >= self._max_periods)
        self._ended = terminated or truncated
        return self._observation(), reward, terminated, truncated, {"knowledge": list(self._people.knowledge)}

    def _observation(self) -> Any:
        import numpy as np

        assert self._session is not None
        session = self._session
        parts = self.domain.components
        open_parts = [i for i, status in enumerate(session.components) if status == "open"]
        now = open_parts[0] if open_parts else len(parts) - 1
        last = session.history[-1] if session.periods else None
        values: list[float] = []
        for member in range(session.num_members):
            belief = session.belief(member)
            verdicts = last.feedback.verdicts[member] if last is not None else []
            values += [belief.mass_in(parts[now].half_spaces), belief.mass_in(self.domain.region),
                       sum(one.correct for one in verdicts) / max(len(verdicts), 1)]
        values += [float(i == now) for i in range(len(parts))]
        values += [len(self._chosen) / self.MOST, min(session.periods / self._max_periods, 1.0)]
        return np.clip(np.array(values, dtype=np.float32), 0.0, 1.0)

    def render(self) -> None:
        """Nothing: domain.board(start) draws a demonstration."""

    def close(self) -> None:
        """Nothing is open."""
