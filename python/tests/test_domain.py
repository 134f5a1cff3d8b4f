"""Domains, from everywhere."""

import copy
import os
import pathlib
import pickle
import tempfile
import unittest

import kith
import numpy as np
from support import LAKE_ACTIONS, PROGRAM, SOURCE, LakeEnv, lake, lake_domain


def corridor(chance=1.0):
    """Four cells in a row with mud on one; the right one ends an episode."""
    transitions = np.zeros((4, 2, 4))
    features = np.zeros((4, 2, 4, 2))
    for s in range(3):
        for a, t in enumerate([max(s - 1, 0), s + 1]):
            transitions[s, a, t] += chance
            transitions[s, a, s] += 1 - chance
            features[s, a, :, 1] = 1
            features[s, a, 2, 0] = 1
    transitions[3, :, 3] = 1
    return transitions, features


class Built(unittest.TestCase):
    def test_built_in_domains_are_what_the_program_says(self):
        robot = kith.Domain("item-delivery")
        self.assertEqual(robot.feature_names, ("rubble", "recharge", "step"))
        self.assertEqual(len(robot.worlds), 64)
        self.assertEqual(robot.weights, (-3.0, 3.5, -1.0))
        self.assertIn("item-delivery", kith.Domain.built_in())
        self.assertEqual(len(robot.policy), 64)
        self.assertEqual(len(robot.policy[0]), len([n for n in robot.worlds[0].state_names]) - 1)
        self.assertAlmostEqual(robot.region.solid_angle, robot.components[-1].area_sr, places=9)
        self.assertEqual(robot.described()["id"], "item-delivery")

    def test_its_region_holds_its_weights_and_no_others(self):
        robot = kith.Domain("item-delivery")
        self.assertTrue(robot.region.contains(robot.weights))
        self.assertFalse(robot.region.contains([-w for w in robot.weights]))
        for start in robot.starts[::97]:
            inside = robot.path(start, robot.region.interior)
            self.assertEqual(inside.actions, robot.path(start).actions)

    def test_a_file_and_its_text_are_the_same(self):
        file = SOURCE / "domains" / "item_delivery.toml"
        a, b = kith.Domain(file), kith.Domain(file.read_text())
        self.assertEqual(a.region, b.region)
        self.assertEqual(a.text, b.text)

    def test_saving_and_reading_gives_the_same(self):
        with tempfile.TemporaryDirectory() as folder:
            robot = kith.Domain("icy-crossing")
            again = kith.Domain(robot.save(folder))
            self.assertEqual(robot.region, again.region)
            self.assertEqual(robot.policy, again.policy)

    def test_it_shows_itself(self):
        page = kith.Domain("item-delivery")._repr_html_()
        self.assertIn("<svg", page)
        self.assertIn("crossing rubble", page)
        self.assertNotIn("<script", page)

    def test_what_is_wrong_has_id_place_and_help(self):
        text = (SOURCE / "domains" / "item_delivery.toml").read_text()
        with self.assertRaises(kith.Error) as caught:
            kith.Domain(text.replace("rubble = -3", "rubbel = -3", 1))
        self.assertRegex(caught.exception.id, r"^E\d{4}$")
        self.assertRegex(caught.exception.place, r"^domain:\d+:\d+$")
        self.assertIn("rubble", caught.exception.help)
        self.assertEqual(caught.exception.kind, "invalid-input")
        with self.assertRaises(kith.Error) as caught:
            kith.Domain("item-delivrey")
        self.assertIn("item-delivery", str(caught.exception))


class Arrays(unittest.TestCase):
    def test_a_corridor_is_walked_to_its_end(self):
        transitions, features = corridor()
        robot = kith.Domain.from_arrays(transitions, features, [-2, -1], feature_names=["mud", "step"],
                                        action_names=["back", "on"])
        self.assertEqual(robot.policy, [["on", "on", "on", None]])
        self.assertEqual(robot.path((0, 0)).counts, (1, 3))
        self.assertEqual(robot.feature_names, ("mud", "step"))

    def test_strides_types_and_order_do_not_matter(self):
        transitions, features = corridor()
        plain = kith.Domain.from_arrays(transitions, features, [-2, -1])
        for change in (np.asfortranarray, lambda x: x.astype(np.float32), lambda x: x[::-1][::-1],
                       lambda x: x.tolist()):
            other = kith.Domain.from_arrays(change(transitions), change(features), (-2, -1))
            self.assertEqual(plain.text, other.text)
            self.assertEqual(plain.policy, other.policy)
        locked = transitions.copy()
        locked.flags.writeable = False
        self.assertEqual(kith.Domain.from_arrays(locked, features, [-2, -1]).policy, plain.policy)

    def test_chance_is_planned_with(self):
        transitions, features = corridor(0.5)
        robot = kith.Domain.from_arrays(transitions, features, [-2, -1])
        self.assertEqual(robot.policy[0], ["action2"] * 3 + [None])
        self.assertAlmostEqual(robot.path((0, 0)).counts[1], 6.0, places=5)

    def test_wrong_arrays_are_refused(self):
        transitions, features = corridor()
        half = transitions.copy()
        half[0, 1] *= 0.5
        hole = features.copy()
        hole[0, 0, 0, 0] = np.nan
        for wrong in ((half, features, [-2, -1]), (transitions, hole, [-2, -1]), (transitions, features, [-2]),
                      (transitions[:, :, :3], features, [-2, -1]), (transitions, features[:, :1], [-2, -1]),
                      (transitions, features, [np.inf, -1]), ("abc", features, [-2, -1]),
                      (transitions - 0.5, features, [-2, -1]), (transitions, features, {"nothing": 1})):
            with self.assertRaises(ValueError):
                kith.Domain.from_arrays(*wrong)
        with self.assertRaises(kith.Error):  # a reward for standing still
            kith.Domain.from_arrays(transitions, features, [2, 1])


class Gymnasium(unittest.TestCase):
    def test_the_lake_is_crossed(self):
        robot = lake_domain(kith)
        path = robot.path((0, 0))
        self.assertEqual(path.counts, (0, 6, 1))
        self.assertEqual(set(robot.action_names), set(LAKE_ACTIONS))

    def test_slipping_is_known(self):
        robot = lake_domain(kith, slip=True)
        self.assertGreater(robot.path((0, 0)).counts[0], 0)  # holes, in expectation

    def test_rewards_become_features(self):
        table, _ = lake()
        for s in table:
            for a in table[s]:
                table[s][a] = [(p, t, r - 1 if s != t or not end else 0, end) for p, t, r, end in table[s][a]]

        class Env:
            P = table
        robot = kith.Domain.from_gymnasium(Env(), discount=0.95)
        self.assertGreaterEqual(len(robot.feature_names), 1)

    def test_policies_paths_and_starts_have_the_numbers_of_the_table(self):
        env = LakeEnv()
        robot = lake_domain(kith)
        self.assertEqual(len(robot.policy[0]), 16)
        for s, action in enumerate(robot.policy[0]):
            self.assertEqual(action is None, s in env.holes + [15], s)
        self.assertEqual({s for _, s in robot.starts}, {s for s in range(16) if robot.policy[0][s] is not None})
        path = robot.path((0, 0))
        self.assertEqual((path.states[0], path.states[-1]), (0, 15))
        for s, action, t in zip(path.states, path.actions, path.states[1:]):
            self.assertEqual(env.P[s][LAKE_ACTIONS.index(action)][0][1], t)
            self.assertEqual(robot.policy[0][s], action)

    def test_no_two_states_have_one_number(self):
        text = """schema = "kith.domain/1"
id = "mixed"
[mdp]
discount = 1.0
[model]
format = "csv"
states = "states.csv"
transitions = "transitions.csv"
[[feature]]
name = "mud"
[[feature]]
name = "step"
[reward]
weights = { mud = -3, step = -1 }
"""
        names = ["0", "door", "1", "01", "2"]  # the door comes second, where others are called by their numbers
        states = "state,terminal\n" + "".join(f"{name},{str(name == '2').lower()}\n" for name in names)
        rows = "".join(f"{s},go,{t},0,1\n{s},wade,{u},1,1\n" for s, t, u in
                       [("0", "door", "1"), ("door", "1", "01"), ("1", "01", "2"), ("01", "2", "0")])
        with tempfile.TemporaryDirectory() as folder:
            for name, content in (("mixed.toml", text), ("states.csv", states),
                                  ("transitions.csv", "state,action,next,mud,step\n" + rows)):
                pathlib.Path(folder, name).write_text(content, encoding="utf-8")
            robot = kith.Domain(str(pathlib.Path(folder, "mixed.toml")))
        self.assertEqual(len(set(robot.starts)), 4)
        called = [robot.worlds[0].state_names[number] for _, number in robot.starts]
        self.assertEqual(sorted(called), ["door", "state 0", "state 01", "state 1"])
        self.assertEqual(called[robot.starts.index((0, 1))], "state 1")

    def test_what_a_file_takes_the_module_takes(self):
        env = LakeEnv()
        features = {"hole": lambda s, a, t: t in env.holes, "step": lambda s, a, t: 1}
        weights = {"hole": -5, "step": -1}
        by_name = kith.Domain.from_gymnasium(env, features, weights, prior=[{"step": -1}], columns=4)
        by_array = kith.Domain.from_gymnasium(env, features, weights, prior=[[0, -1]])
        self.assertEqual(by_name.prior, by_array.prior)
        self.assertEqual(len(by_name.worlds[0].map), 4)
        self.assertIn("<svg", by_name.board((0, 0)))
        told = kith.teach(by_name, "NP", "joint", teacher={"particles": 200})
        for shown in told.sessions[0].periods[0].demonstrations:
            number = next(s for w, s in by_name.starts if by_name.worlds[w].state_names[s] == shown.start.name)
            self.assertIn(by_name.board((0, number)).split("<title>")[1], told._repr_html_())

    def test_it_is_copied_and_pickled(self):
        robot = lake_domain(kith)
        for other in (copy.copy(robot), copy.deepcopy(robot), pickle.loads(pickle.dumps(robot))):
            self.assertEqual((other.text, other.policy, other.id), (robot.text, robot.policy, robot.id))
        self.assertEqual(pickle.loads(pickle.dumps(robot.region)), robot.region)
        session, people = kith.Session(robot, "NP"), kith.People(robot, "NP")
        session.propose()
        session.run_period(people)
        session.propose()
        again, others = pickle.loads(pickle.dumps((session, people)))
        self.assertEqual(again, session)
        self.assertEqual(others.knowledge, people.knowledge)
        session.run_period(people)
        again.run_period(others)
        self.assertEqual(others.knowledge, people.knowledge)
        self.assertEqual(again, session)

    def test_an_environment_without_a_table_is_refused(self):
        with self.assertRaisesRegex(ValueError, "P"):
            kith.Domain.from_gymnasium(object())

    def test_it_can_be_taught(self):
        robot = lake_domain(kith)
        told = kith.teach(robot, group="NP", strategy="joint", seed=3)
        before = kith.ParticleBelief(robot.prior, 2000).mass_in(robot.region)
        self.assertGreater(told.knowledge, 2 * before)

    @unittest.skipUnless(os.path.exists(PROGRAM), "the program is not built")
    def test_its_lesson_is_a_page_where_the_program_has_the_engine(self):
        robot = kith.Domain("icy-crossing")
        try:
            lesson = robot.lesson(program=PROGRAM)
        except kith.Error as error:
            self.assertIn("engine", str(error))
        else:
            self.assertIn("<iframe", lesson._repr_html_())
        with self.assertRaises(FileNotFoundError):
            robot.lesson(program="/nowhere/kith")


if __name__ == "__main__":
    unittest.main()
