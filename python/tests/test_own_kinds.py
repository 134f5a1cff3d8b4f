"""Strategies and learners written in Python."""

import pathlib
import tempfile
import threading
import unittest

import kith
import numpy as np

ROBOT = kith.Domain("item-delivery")
SMALL = {"teacher": {"particles": 200}, "stop": {"max_periods": 6}}


class Joint(kith.Strategy):
    """teach for what at least one member knows"""

    name = "my-joint"
    needs = ("joint",)

    def propose(self, view):
        return view.select("joint")


class Weakest(kith.Strategy):
    """teach for whoever knows least of the component"""

    needs = ("members",)

    def __init__(self):
        self.periods = 0

    def propose(self, view):
        self.periods += 1
        masses = [view.mass_in_component(i) if here else 2 for i, here in enumerate(view.present)]
        return int(np.argmin(masses))


class Scattered(kith.Strategy):
    """show three candidates by chance"""

    def propose(self, view):
        candidates = view.candidates
        random = view.random
        return [candidates[int(random.uniform() * len(candidates))] for _ in range(3)]


class Broken(kith.Strategy):
    """fails in the second period"""

    mended = False

    def propose(self, view):
        if view.period == 2 and not Broken.mended:
            raise KeyError("a mistake of mine")
        return "common"


class Simple(kith.Learner):
    """keeps one opinion and changes it when it was wrong"""

    def __init__(self, start):
        super().__init__(start)
        self.random = start.random
        self.points = np.array(start.belief.points)
        self.heard = []
        self.opinion = self.points[0]

    def watch(self, half_spaces, period):
        self.heard += half_spaces

    def answer(self, tests, period):
        return self.opinion

    def hear_feedback(self, all_correct, half_spaces, period):
        self.heard += half_spaces
        if not all_correct:
            fits = (self.points @ np.array(self.heard).T >= 0).sum(axis=1)
            best = np.flatnonzero(fits == fits.max())
            self.opinion = self.points[best[int(self.random.split(period).uniform() * len(best))]]

    def mass_in(self, half_spaces):
        return float(all(np.dot(n, self.opinion) >= 0 for n in half_spaces))


class Strategies(unittest.TestCase):
    def test_a_copy_of_joint_gives_the_same_lessons(self):
        for seed in range(1, 6):
            own = kith.teach(ROBOT, "NNP", Joint, seed, **SMALL).document
            theirs = kith.teach(ROBOT, "NNP", "joint", seed, **SMALL).document
            for one in (own, theirs):
                del one["strategy"]
            self.assertEqual(own, theirs)

    def test_a_study_on_threads_is_the_same_on_one(self):
        with tempfile.TemporaryDirectory() as folder:
            runs = [kith.study("quick", f"{folder}/{n}", threads=n, progress=False, replicates=2,
                               strategies=[Joint, Weakest, Scattered, "joint"], **SMALL) for n in (1, 3)]
            files = [{f.name: f.read_bytes() for f in (run.folder / "tables").iterdir()} for run in runs]
            self.assertEqual(files[0], files[1])
            teams = runs[0].tables["teams"]
            self.assertEqual(set(teams["strategy"]), {"my-joint", "weakest", "scattered", "joint"})
            mine = teams[teams["strategy"] == "my-joint"]["knowledge"].to_numpy()
            np.testing.assert_array_equal(mine, teams[teams["strategy"] == "joint"]["knowledge"].to_numpy())
            runs[0].verify(progress=False)
            runs[0].report()

    def test_a_thread_is_the_same_to_python_for_the_whole_study(self):
        kept, counts = threading.local(), []

        class Counting:
            def propose(self, view):
                kept.calls = getattr(kept, "calls", 0) + 1
                counts.append(kept.calls)
                return "joint"
        kith.study("quick", threads=1, progress=False, strategies=[Counting], replicates=2, **SMALL)
        self.assertEqual(counts, list(range(1, len(counts) + 1)))
        self.assertGreater(len(counts), 4)

    def test_what_it_raises_ends_the_study_which_can_be_resumed(self):
        with tempfile.TemporaryDirectory() as folder:
            how = dict(out=f"{folder}/run", threads=1, progress=False, strategies=["joint", Broken], **SMALL)
            with self.assertRaises(kith.Error) as caught:
                kith.study("quick", **how)
            text = str(caught.exception)
            self.assertRegex(text, r"team \d+ \(broken")
            self.assertIn("a mistake of mine", text)
            self.assertIn("test_own_kinds.py", text)
            done = kith.Run(f"{folder}/run").status["done"]
            self.assertGreater(done, 0)
            Broken.mended = True
            self.assertEqual(kith.study("quick", **how).resumed, done)

    def test_what_it_raises_in_a_session_is_raised(self):
        class Wrong:
            def propose(self, view):
                return 1 / 0
        session = kith.Session(ROBOT, strategy=Wrong, **SMALL)
        before = session.copy()
        with self.assertRaises(ZeroDivisionError):
            session.propose()
        self.assertEqual(session, before)

    def test_nonsense_is_refused(self):
        for n, answer in enumerate((object(), 99, "nothing", [(0, 10**9)], [(1, 2, 3)], 1.5, [None])):
            kind = type(f"Nonsense{n}", (), {"propose": lambda self, view, answer=answer: answer})
            with self.assertRaises((kith.Error, ValueError, TypeError, IndexError, RuntimeError), msg=str(answer)):
                kith.Session(ROBOT, strategy=kind, **SMALL).propose()

    def test_a_view_is_closed_behind_it(self):
        kept = []

        class Keeper:
            def propose(self, view):
                kept.append(view)
                return "joint"
        kith.Session(ROBOT, strategy=Keeper, **SMALL).propose()
        with self.assertRaises(ValueError):
            kept[0].candidates
        with self.assertRaises(ValueError):
            kept[0].select("joint")

    def test_a_session_inside_itself_is_refused(self):
        met = []

        class Inside:
            session = None

            def propose(self, view):
                try:
                    Inside.session.propose()
                except kith.Error as error:
                    met.append(error.kind)
                return "joint"

            def __deepcopy__(self, memo):
                return self
        Inside.session = kith.Session(ROBOT, strategy=Inside, **SMALL)
        Inside.session.propose()
        self.assertEqual(met, ["busy"])

    def test_a_study_inside_itself_is_refused(self):
        met = []
        with tempfile.TemporaryDirectory() as folder:
            class Deep:
                def propose(self, view):
                    if not met:
                        try:
                            kith.study("quick", f"{folder}/run", progress=False, strategies=[Deep], **SMALL)
                        except kith.Error as error:
                            met.append(error.kind)
                    return "joint"
            kith.study("quick", f"{folder}/run", progress=False, threads=1, strategies=[Deep], **SMALL)
        self.assertEqual(met, ["busy"])

    def test_names_of_kith_are_taken(self):
        class Mine:
            name = "joint"

            def propose(self, view):
                return None
        with self.assertRaises(ValueError):
            kith.Session(ROBOT, strategy=Mine)
        with self.assertRaises(TypeError):
            kith.study("quick", strategies=[object], progress=False)


class Learners(unittest.TestCase):
    STUDY = {"domain": "item-delivery", "replicates": 2, "learner": {"S": {"label": "simple"}},
             "design": {"strategies": ["joint", "common"], "compositions": ["SS", "S"]}, "seed": 5, **SMALL}

    def test_they_are_taught_the_same_on_threads(self):
        with tempfile.TemporaryDirectory() as folder:
            runs = [kith.study(self.STUDY, f"{folder}/{n}", threads=n, progress=False, learners={"S": Simple})
                    for n in (1, 3)]
            files = [{f.name: f.read_bytes() for f in (run.folder / "tables").iterdir()} for run in runs]
            self.assertEqual(files[0], files[1])
            self.assertEqual(len(runs[0].tables["teams"]), 8)

    def test_nonsense_is_refused(self):
        def study(**methods):
            kind = type("Odd" + "".join(methods), (Simple,), methods)
            with self.assertRaises(kith.Error) as caught:
                kith.study(self.STUDY, progress=False, threads=1, learners={"S": kind})
            self.assertIn("team 1", str(caught.exception))
        study(answer=lambda self, tests, period: [0, 0, 0])
        study(answer=lambda self, tests, period: [None])
        study(answer=lambda self, tests, period: "left")
        study(mass_in=lambda self, half_spaces: float("nan"))
        study(watch=lambda self, half_spaces, period: half_spaces[10**6])
        with self.assertRaises(TypeError):
            kith.study(self.STUDY, learners={"S": object})


if __name__ == "__main__":
    unittest.main()
