"""Sessions, event by event; teaching as an environment."""

import copy
import importlib.util
import pathlib
import pickle
import subprocess
import sys
import tempfile
import threading
import unittest

import kith
import numpy as np

ROBOT = kith.Domain("item-delivery")
SMALL = {"teacher": {"particles": 200}}


def robots_answers(session):
    return [test.robot_counts for test in session.lesson.tests]


class Events(unittest.TestCase):
    def test_people_who_are_right_are_done_soon(self):
        session = kith.Session(ROBOT, members=2, strategy="joint", **SMALL)
        while session.propose():
            session.show()
            for member in range(2):
                session.answer(member, robots_answers(session))
            session.close_tests()
            feedback = session.give_feedback()
            self.assertEqual(feedback.all_correct, [True, True])
        self.assertEqual(session.status, "complete")
        self.assertEqual(session.components, ["learned"] * len(ROBOT.components))
        self.assertEqual(session.periods, len(session.history))
        before = kith.Session(ROBOT, members=2, strategy="joint", **SMALL)
        self.assertGreater(session.belief("joint").mass_in(ROBOT.region), 2 * before.belief("joint").mass_in(ROBOT.region))

    def test_what_the_phase_does_not_allow_changes_nothing(self):
        session = kith.Session(ROBOT, **SMALL)
        before = session.copy()
        for event in (session.show, session.close_tests, session.give_feedback, lambda: session.answer(0, []),
                      lambda: session.come_back(0), lambda: session.lesson):
            with self.assertRaises(kith.Error):
                event()
        with self.assertRaises(IndexError):
            session.leave(3)
        self.assertEqual(session, before)
        session.propose()
        session.show()
        with self.assertRaises(kith.Error):
            session.answer(0, [])
        with self.assertRaises(kith.Error):  # better than the robot
            session.answer(0, [(0, 9, 0)] * len(session.lesson.tests))

    def test_a_copy_goes_on_alone_and_alike(self):
        session = kith.Session(ROBOT, "NP", strategy="common", seed=5, **SMALL)
        people = kith.People(ROBOT, "NP", 5, **SMALL)
        session.propose()
        session.run_period(people)
        other, others = copy.copy(session), copy.copy(people)
        self.assertEqual(session, other)
        for one, group in ((session, people), (other, others)):
            one.propose()
            one.run_period(group)
        self.assertEqual(session, other)
        self.assertEqual(people.knowledge, others.knowledge)

    def test_it_is_the_team_that_teach_tells_of(self):
        told = kith.teach(ROBOT, "NNP", "joint", seed=3, **SMALL)
        session = kith.Session(ROBOT, "NNP", strategy="joint", seed=3, **SMALL)
        people = kith.People(ROBOT, "NNP", 3, **SMALL)
        while session.propose():
            session.run_period(people)
        self.assertEqual(session.periods, told.periods)
        for period, shown in zip(session.history, told.sessions[0].periods):
            self.assertEqual([one.start for one in period.lesson.demonstrations],
                             [(one.start.mdp, one.start.start) for one in shown.demonstrations])
        self.assertAlmostEqual(np.mean(people.knowledge), told.knowledge, places=12)

    def test_one_member_can_be_somebody_else(self):
        session = kith.Session(ROBOT, "NP", strategy="joint", **SMALL)
        people = kith.People(ROBOT, "NP", **SMALL)
        session.propose()
        session.show()
        session.answer(0, people.answers(session, 0))
        session.answer(1, robots_answers(session))
        session.close_tests()
        session.give_feedback()
        people.hear_feedback(session, 0)
        self.assertTrue(session.history[0].feedback.all_correct[1])

    def test_who_leaves_can_be_replaced(self):
        session = kith.Session(ROBOT, members=2, **SMALL)
        session.leave(1)
        session.propose()
        self.assertFalse(session.takes_part(1))
        session.show()
        session.answer(0, robots_answers(session))
        self.assertTrue(session.has_answered(0))
        session.close_tests()
        session.give_feedback()
        session.replace(1)
        session.propose()
        self.assertTrue(session.takes_part(1))
        self.assertIn("member-replaced", session.events)

    def test_lessons_by_hand(self):
        session = kith.Session(ROBOT, strategy="by-hand", **SMALL)
        start = next(s for s in ROBOT.starts if s[0] in ROBOT.components[0].worlds)
        self.assertTrue(session.propose([start]))
        self.assertEqual(session.lesson.demonstrations[0].start, start)
        with self.assertRaises(ValueError):
            kith.Session(ROBOT, **SMALL).propose([start])

    def test_a_thread_too_many_is_refused(self):
        session = kith.Session(ROBOT, strategy="plan", **SMALL)
        met = []

        def propose():
            try:
                session.propose()
            except kith.Error as error:
                met.append(error.kind)
        threads = [threading.Thread(target=propose) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertTrue(set(met) <= {"busy", "usage"})
        self.assertEqual(session.phase, "lesson")

    def test_what_is_wrong_is_refused(self):
        for wrong in ({"group": "XYZ"}, {"members": 0}, {"members": 31}, {"strategy": "nothing"}, {"strategy": "baseline"}):
            with self.assertRaises(ValueError, msg=str(wrong)):
                kith.Session(ROBOT, **wrong, **SMALL)
        with self.assertRaises(kith.Error):
            kith.Session(ROBOT, teacher={"particles": 0})
        with self.assertRaises(TypeError):
            kith.Session(ROBOT, strategy=3)
        with self.assertRaises(TypeError):
            kith.Session(ROBOT, teacher={"particles": object()})

    def test_memory_stays_flat(self):
        import resource
        for round_ in range(3):
            for seed in range(334):
                kith.Session(ROBOT, seed=seed, **SMALL).propose()
            if round_ == 0:
                before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
        self.assertLess(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before, 4_000)  # kB


class Environment(unittest.TestCase):
    def test_an_episode_ends_with_knowledge(self):
        env = kith.TeachingEnv(ROBOT, "NP", **SMALL)
        observation, info = env.reset(seed=4)
        self.assertEqual(observation.shape, env.observation_space.shape)
        self.assertTrue(env.observation_space.contains(observation))
        start = len(env.starts) - 1
        gained, ended = 0.0, False
        for _ in range(200):
            env.step(start)
            observation, reward, terminated, truncated, info = env.step(len(env.starts))
            self.assertTrue(env.observation_space.contains(observation))
            gained += reward
            ended = terminated or truncated
            if ended:
                break
        self.assertTrue(ended)
        with self.assertRaises(RuntimeError):
            env.step(0)

    def test_equal_seeds_and_actions_give_equal_episodes(self):
        def episode():
            env = kith.TeachingEnv(ROBOT, "NP", **SMALL)
            env.action_space.seed(3)
            told = [env.reset(seed=2)[0]]
            for _ in range(12):
                observation, reward, *_ = env.step(env.action_space.sample())
                told.append(observation)
            return np.array(told)
        np.testing.assert_array_equal(episode(), episode())

    def test_wrong_actions_are_refused(self):
        env = kith.TeachingEnv(ROBOT, "NP", **SMALL)
        with self.assertRaises(RuntimeError):
            env.step(0)
        env.reset(seed=1)
        with self.assertRaises(ValueError):
            env.step(-1)

    def test_an_episode_is_copied_and_pickled(self):
        env = kith.TeachingEnv(ROBOT, "NP", **SMALL)
        env.reset(seed=4)
        for action in (0, 1, len(env.starts), 2):
            env.step(action)
        others = [copy.deepcopy(env), pickle.loads(pickle.dumps(env))]
        told = env.step(len(env.starts))
        for other in others:
            np.testing.assert_array_equal(other.step(len(other.starts))[0], told[0])

    def test_it_is_an_env_of_gymnasium_whatever_was_imported_first(self):
        stand_in = ("import types\nclass Env:\n    def reset(self, *, seed=None): pass\n"
                    "spaces = types.SimpleNamespace(Discrete=lambda n: n, Box=lambda *a: a)\n")
        with tempfile.TemporaryDirectory() as folder:
            (pathlib.Path(folder) / "gymnasium.py").write_text(stand_in, encoding="utf-8")
            for first, second in (("kith", "gymnasium"), ("gymnasium", "kith")):
                code = (f"import sys; sys.path.insert(0, {folder!r})\nimport {first}, {second}\n"
                        "assert issubclass(kith.TeachingEnv, gymnasium.Env)\n")
                subprocess.run([sys.executable, "-c", code], check=True)

    @unittest.skipUnless(importlib.util.find_spec("gymnasium"), "Gymnasium is not installed")
    def test_gymnasiums_checker_passes(self):
        subprocess.run([sys.executable, "-c", "import gymnasium.utils.env_checker as c, kith; "
                        "c.check_env(kith.TeachingEnv('item-delivery', 'NP'), skip_render_check=True)"], check=True)


if __name__ == "__main__":
    unittest.main()
