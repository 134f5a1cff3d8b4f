"""kith: teach a robot's policy to a group of people.

    import kith

    robot = kith.Domain("item-delivery")             # or kith.Domain.from_arrays(...), from_gymnasium(...)
    kith.teach(robot, group="NNP", strategy="joint") # one simulated team, step by step
    run = kith.study("quick")                        # many; run.tables["teams"] is a pandas frame
    run.analyze(), run.report(), run.verify()

Sessions with whoever you like at the other end: kith.Session. Strategies and simulated people of your own: kith.Strategy,
kith.Learner. Beliefs alone: kith.Cone, kith.ParticleBelief, kith.region. What goes wrong is kith.Error; wrong arguments
raise ValueError, TypeError and IndexError.
"""

import copyreg as _copyreg
from typing import TYPE_CHECKING as _TYPE_CHECKING

from ._core import Cone, LearnerStart, ParticleBelief, RandomStream, Unit, View
from ._domain import Domain
from ._errors import Diagnostic, Error, Warning
from ._infer import Explanation, explain_policy
from ._kinds import Learner, Strategy, strategies
from ._records import (Component, Counts, Demonstration, Feedback, HalfSpace, Lesson, Path, Period, Start, Test, Verdict,
                       World)
from ._session import People, Session
from ._study import Analysis, Finding, Report, Run, Tables, audit, fit, power, resolve, study
from ._teach import Record, Transcript, replay, teach
from ._core import program as _program

if _TYPE_CHECKING:
    from ._env import TeachingEnv as TeachingEnv

_copyreg.pickle(Cone, lambda cone: (Cone, (cone.facets, cone.dimension)))

__version__ = _program().split()[0]

__all__ = [
    "Analysis", "Component", "Cone", "Counts", "Demonstration", "Diagnostic", "Domain", "Error", "Explanation",
    "Feedback", "Finding", "HalfSpace", "Learner", "LearnerStart", "Lesson", "ParticleBelief", "Path", "People",
    "Period", "RandomStream", "Record", "Report", "Run", "Session", "Start", "Strategy", "Tables", "TeachingEnv",
    "Test", "Transcript", "Unit", "Verdict", "View", "Warning", "World", "audit", "explain_policy",
    "fit", "power", "region", "replay", "resolve", "strategies", "study", "teach",
]


def __getattr__(name: str) -> object:
    """TeachingEnv is made when it is first used: a gymnasium.Env wherever Gymnasium is installed."""
    if name != "TeachingEnv":
        raise AttributeError(f"module 'kith' has no attribute '{name}'")
    from ._env import TeachingEnv

    return TeachingEnv


def region(domain: Domain) -> Cone:
    """All weights under which the robot's policy is optimal, within what everybody knows beforehand."""
    return domain.region
