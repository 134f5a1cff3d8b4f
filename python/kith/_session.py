"""Sessions and simulated people."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from copy import copy
from typing import Any, Optional, Union

from . import _core
from ._domain import Domain
from ._journal import Journaled
from ._kinds import strategy_name
from ._records import Counts, Feedback, Lesson, Period, Start
from ._settings import overrides


class People(Journaled):
    """Simulated people with beliefs of their own, as studies draw them. Copied, and pickled as what was done to them.

    group     letters of the study's learner types, such as "NNP"
    seed      equal seeds give the people that `kith teach` and kith.teach() have
    settings  keys of a study file, such as learner={"N": {"ability": {"mean": 0.8}}}
    """

    def __init__(self, domain: Domain, group: str = "NNP", seed: int = 1, study: str = "paper", **settings: Any) -> None:
        self._begin(domain, group, seed, study, **settings)
        self.domain = domain
        self._native: _core.People = _core.People(domain._native, group, seed, study, "", list(overrides(settings)))

    def __len__(self) -> int:
        return len(self._native)

    def copy(self) -> People:
        """The same people, who go on independently."""
        return copy(self)

    @property
    def knowledge(self) -> list[float]:
        """How much of each belief lies where the robot's policy is optimal, in [0, 1]."""
        return self._native.knowledge

    def belief(self, member: int) -> Optional[_core.ParticleBelief]:
        """A copy of what one of them believes; None for people without such a belief."""
        return self._native.belief(member)

    def answers(self, session: Session, member: int) -> list[Optional[Counts]]:
        """One of them watches the session's lesson and answers its tests; once per lesson."""
        answers: list[Optional[Counts]] = self._do("answers", session, member)
        return answers

    def hear_feedback(self, session: Session, member: int) -> None:
        """One of them hears the feedback of the session's last period."""
        self._do("hear_feedback", session, member)


class Session(Journaled):
    """One group being taught, event by event. Whoever drives it brings the answers: people, a robot, a program.

        while session.propose():                     # chooses session.lesson; False: nothing is left to teach
            session.show()                           # its demonstrations were watched
            for member in range(session.num_members):
                session.answer(member, answers)      # to its tests: feature counts of a path, or None
            session.close_tests()
            session.give_feedback()

    An event that is refused raises kith.Error and changes nothing. copy() gives a session that goes on independently; a
    pickle holds what was done.

    group     letters of the study's learner types; without, `members` people
    strategy  the name of one, a class of your own (kith.Strategy), or "by-hand": propose(demonstrations=[start, ...])
    settings  keys of a study file, such as teacher={"particles": 500}
    """

    def __init__(self, domain: Domain, group: str = "", *, members: int = 3, strategy: Any = "common", seed: int = 1,
                 study: str = "paper", **settings: Any) -> None:
        self._begin(domain, group, members=members, strategy=strategy, seed=seed, study=study, **settings)
        self.domain = domain
        self._native: _core.Session = _core.Session(domain._native, group, members, strategy_name(strategy), seed,
                                                    study, "", list(overrides(settings)))

    def copy(self) -> Session:
        """A session in the same state that goes on independently."""
        return copy(self)

    def propose(self, demonstrations: Optional[Iterable[Start]] = None, people: Optional[People] = None) -> bool:
        """Chooses the next lesson. False: nothing is left to teach, the session has ended.

        demonstrations: what to show, with strategy="by-hand"; people: for strategies that see into simulated people.
        """
        more: bool = self._do("propose", None if demonstrations is None else list(demonstrations), people)
        return more

    def show(self) -> None:
        """Everybody present has watched the demonstrations."""
        self._do("show")

    def answer(self, member: int, answers: Sequence[Optional[Counts]]) -> None:
        """A member's answers, one per test: feature counts of the expected path, shape [d], or None."""
        self._do("answer", member, list(answers))

    def close_tests(self) -> Feedback:
        """No more answers are taken. What give_feedback() will tell."""
        feedback: Feedback = self._do("close_tests")
        return feedback

    def give_feedback(self) -> Feedback:
        """Everybody present has heard the feedback. The period ends."""
        feedback: Feedback = self._do("give_feedback")
        return feedback

    def leave(self, member: int) -> None:
        """A member leaves."""
        self._do("leave", member)

    def come_back(self, member: int) -> None:
        """A member who left takes part from the next lesson on."""
        self._do("come_back", member)

    def replace(self, member: int) -> None:
        """Somebody else takes the place of a member who left."""
        self._do("replace", member)

    def run_period(self, people: People) -> None:
        """A whole period with simulated people, one per seat, after propose()."""
        self._do("run_period", people)

    @property
    def lesson(self) -> Lesson:
        """What to show and ask now. kith.Error if there is no lesson."""
        lesson: Lesson = self._native.lesson
        return lesson

    @property
    def history(self) -> list[Period]:
        """All completed periods."""
        return self._native.history

    def belief(self, whose: Union[int, str]) -> _core.ParticleBelief:
        """A copy of what the teacher believes about a member, by seat from 0, or the team: "common", "joint"."""
        return self._native.belief(whose)

    def takes_part(self, member: int) -> bool:
        """Whether a member takes part in the current period."""
        return self._native.takes_part(member)

    def has_answered(self, member: int) -> bool:
        """Whether a member has answered the current tests."""
        return self._native.has_answered(member)

    @property
    def phase(self) -> str:
        """What it waits for: "proposal", "lesson", "tests", "feedback", or "finished"."""
        return self._native.phase

    @property
    def status(self) -> str:
        """"running", "complete", "skipped" or "max_periods"."""
        return self._native.status

    @property
    def periods(self) -> int:
        """Completed periods."""
        return self._native.periods

    @property
    def num_members(self) -> int:
        """Seats."""
        return self._native.num_members

    @property
    def components(self) -> list[str]:
        """How each of Domain.components stands: "open", "learned" or "skipped"."""
        return self._native.components

    @property
    def events(self) -> list[str]:
        """What was accepted so far, in order: "lesson-proposed", ..."""
        return self._native.events

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Session) and self._native == other._native

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        return f"<kith.Session about {self.domain.id}: {self.num_members} members, {self.periods} periods, {self.status}>"
