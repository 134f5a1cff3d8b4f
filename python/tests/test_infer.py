"""Weights for policies whose reward nobody wrote down."""

import unittest

import kith
import numpy as np

MOVES = [(0, -1), (1, 0), (0, 1), (-1, 0)]


def grid(random, size=5, slip=0.0):
    """A grid with two kinds of ground and a goal in a corner: transitions and features (mud, ice, step)."""
    states = size * size
    ground = random.integers(0, 4, states)  # 0: mud, 1: ice
    transitions = np.zeros((states, 4, states))
    features = np.zeros((states, 4, states, 3))
    for s in range(states - 1):
        y, x = divmod(s, size)
        for a in range(4):
            for b, p in ((a, 1 - slip), ((a + 1) % 4, slip / 2), ((a - 1) % 4, slip / 2)):
                dy, dx = MOVES[b]
                t = size * min(max(y + dy, 0), size - 1) + min(max(x + dx, 0), size - 1)
                transitions[s, a, t] += p
                features[s, a, t] = [ground[t] == 0, ground[t] == 1, 1]
    transitions[states - 1, :, states - 1] = 1
    return transitions, features


def optimal(transitions, features, weights, discount=1.0):
    """An optimal policy by value iteration."""
    reward = (transitions[..., None] * features).sum(axis=2) @ weights
    values = np.zeros(len(transitions))
    for _ in range(2000):
        q = reward + discount * transitions @ values
        values = q.max(axis=1)
        values[-1] = 0
    return (q + 1e-9 * np.arange(4)[::-1]).argmax(axis=1)


class Policies(unittest.TestCase):
    def setUp(self):
        self.random = np.random.default_rng(20_240_424)

    def weights(self):
        return -np.append(self.random.uniform(0, 3, 2).round(2), 1.0)

    def test_known_weights_lie_in_the_region(self):
        for n in range(200):
            slip = 0.0 if n % 2 else 0.2
            transitions, features = grid(self.random, 4, slip)
            weights = self.weights()
            found = kith.explain_policy(transitions, features, optimal(transitions, features, weights))
            self.assertEqual(found.share, 1.0)
            self.assertEqual(found.unexplained, [])
            self.assertTrue(all(np.dot(n, weights) / np.linalg.norm(n) > -1e-5 for n in found.region.facets))
            self.assertTrue(found.region.contains(found.weights))

    def test_the_region_is_that_of_the_domain(self):
        names = [f"cell {s}" for s in range(16)]
        for _ in range(20):
            transitions, features = grid(self.random, 4)
            robot = kith.Domain.from_arrays(transitions, features, self.weights(), state_names=names)
            world = robot.worlds[0]
            policy = np.zeros(16, int)
            for name, action in zip(world.state_names, robot.policy[0]):
                policy[names.index(name)] = robot.action_names.index(action)
            found = kith.explain_policy(transitions, features, policy, prior=robot.prior.facets)
            self.assertEqual(found.region, robot.region)

    def test_odd_states_are_named(self):
        shares = []
        for odd in (1, 2, 5):
            transitions, features = grid(self.random, 6, 0.1)
            policy = optimal(transitions, features, self.weights(), 0.95)
            for s in self.random.choice(35, odd, replace=False):
                policy[s] = (policy[s] + 2) % 4
            found = kith.explain_policy(transitions, features, policy, discount=0.95)
            shares.append(found.share)
            self.assertEqual(round((1 - found.share) * 35), len(found.unexplained))
            self.assertGreater(found.loss, 0)
        self.assertGreater(min(shares), 0.5)

    def test_a_random_policy_is_refused(self):
        transitions, features = grid(self.random, 8, 0.1)
        with self.assertRaises(kith.Error) as caught:
            kith.explain_policy(transitions, features, self.random.integers(0, 4, 64), discount=0.95)
        self.assertEqual(caught.exception.kind, "infeasible")
        self.assertIn("%", str(caught.exception))

    def test_what_was_learned_can_be_taught(self):
        transitions, features = grid(self.random, 4)
        policy = optimal(transitions, features, np.array([-2.3, -0.4, -1.0]))
        robot = kith.Domain.from_policy(transitions, features, policy, feature_names=["mud", "ice", "step"],
                                        prior=[[0, 0, -1]])
        self.assertEqual(robot.explanation.share, 1.0)
        self.assertGreater(kith.teach(robot, "NP", "joint").periods, 0)

    def test_nonsense_is_refused(self):
        transitions, features = grid(self.random, 4)
        for wrong in (np.full(16, 9), np.zeros((16, 4)), "text", [0.5] * 16, np.zeros(15, int)):
            with self.assertRaises(ValueError):
                kith.explain_policy(transitions, features, wrong)
        with self.assertRaises(ValueError):  # goes on for ever
            kith.explain_policy(transitions, features, np.zeros(16, int))


if __name__ == "__main__":
    unittest.main()
