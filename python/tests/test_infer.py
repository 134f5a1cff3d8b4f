"""Weights for policies whose reward nobody wrote down."""

import sys
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


def soft_policy(transitions, features, weights, discount, heat=0.1):
    """What somebody does who prefers actions by exp(Q / heat), and the occupancy of states from everywhere alike."""
    expected = (transitions[..., None] * features).sum(axis=2)
    reward = expected @ weights
    values = np.zeros(len(transitions))
    for _ in range(400):
        q = reward + discount * transitions @ values
        values = heat * np.logaddexp.reduce(q / heat, axis=1)
        values[-1] = 0
    chosen = np.exp((q - q.max(axis=1, keepdims=True)) / heat)
    return chosen / chosen.sum(axis=1, keepdims=True), expected


def counts_of(transitions, policy, expected, discount):
    """Discounted feature counts of a stochastic policy, from all states alike."""
    acting = len(transitions) - 1
    leads = np.einsum("sa,sat->st", policy, transitions)[:acting, :acting]
    step = np.einsum("sa,sak->sk", policy, expected)[:acting]
    return np.linalg.solve(np.eye(acting) - discount * leads, step).mean(axis=0)


def maximum_entropy(transitions, features, policy, discount, rounds=150):
    """Weights by maximum-entropy IRL: gradient ascent until the counts of the soft policy are those of the policy."""
    weights = np.array([-1.0, -1.0, -1.0])
    _, expected = soft_policy(transitions, features, weights, discount)
    seen = counts_of(transitions, np.eye(4)[policy], expected, discount)
    for n in range(rounds):
        soft, _ = soft_policy(transitions, features, weights, discount)
        weights = weights + 0.3 / (1 + 0.02 * n) * (seen - counts_of(transitions, soft, expected, discount))
    return weights


def explained_by(transitions, features, policy, weights, discount):
    """Share of the states in which the policy is best under the weights."""
    reward = (transitions[..., None] * features).sum(axis=2) @ (weights / np.linalg.norm(weights))
    values = np.zeros(len(transitions))
    for _ in range(2000):
        q = reward + discount * transitions @ values
        values = q.max(axis=1)
        values[-1] = 0
    acting = np.arange(len(transitions) - 1)
    moves = np.array([[transitions[s, a, s] < 1 for a in range(4)] for s in acting])  # others do not count
    best = np.where(moves, q[:-1], -np.inf).max(axis=1)
    return float((q[acting, policy[:-1]] >= best - 1e-6).mean())


def random_weights(random):
    return -np.append(random.uniform(0, 3, 2).round(2), 1.0)


def compared(random, noise, domains):
    """Shares that are explained of policies with noise in some states: by kith, maximum entropy, and the true weights."""
    shares = []
    for _ in range(domains):
        transitions, features = grid(random, 6, 0.1)
        weights = random_weights(random)
        policy = optimal(transitions, features, weights, 0.95)
        for s in random.choice(35, max(1, round(noise * 35)), replace=False):
            policy[s] = random.integers(4)
        try:
            found = kith.explain_policy(transitions, features, policy, discount=0.95)
        except kith.Error as error:  # shares are compared, and not whether a start is left
            if error.id != "E0343":
                raise
            continue
        shares.append([found.share, *(explained_by(transitions, features, policy, w, 0.95) for w in
                                      (maximum_entropy(transitions, features, policy, 0.95), weights))])
    return np.array(shares)


def print_comparison(domains):
    """test_infer.py compare [DOMAINS]"""
    print("noise  domains  kith           maximum entropy  true weights   kith better by")
    for noise in (0.01, 0.05, 0.2):
        shares = 100 * compared(np.random.default_rng(41), noise, domains)
        columns = np.column_stack([shares, shares[:, 0] - shares[:, 1]])
        means, errors = columns.mean(axis=0), columns.std(axis=0, ddof=1) / len(columns) ** 0.5
        print(f"{noise:4.0%} {len(columns):8}  " + "  ".join(f"{m:5.1f} +- {e:4.2f} %" for m, e in zip(means, errors)))


class Policies(unittest.TestCase):
    def setUp(self):
        self.random = np.random.default_rng(20_240_424)

    def weights(self):
        return random_weights(self.random)

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
        for _ in range(20):
            transitions, features = grid(self.random, 4)
            robot = kith.Domain.from_arrays(transitions, features, self.weights())
            policy = [None if action is None else robot.action_names.index(action) for action in robot.policy[0]]
            found = kith.explain_policy(transitions, features, policy, prior=robot.prior.facets)
            self.assertEqual(found.region, robot.region)
            self.assertEqual(found.clashes, [])

    def test_odd_states_are_named(self):
        shares = []
        for odd in (1, 2, 5):
            transitions, features = grid(self.random, 6, 0.1)
            policy = optimal(transitions, features, self.weights(), 0.95)
            for s in self.random.choice(35, odd, replace=False):
                policy[s] = (policy[s] + 2) % 4
            found = kith.explain_policy(transitions, features, policy, discount=0.95)
            for states in found.clashes:
                self.assertIn(states[0], found.unexplained)
            shares.append(found.share)
            self.assertEqual(round((1 - found.share) * 35), len(found.unexplained))
            self.assertGreater(found.loss, 0)
        self.assertGreater(min(shares), 0.5)

    def test_more_is_explained_than_by_maximum_entropy(self):
        for noise in (0.01, 0.05, 0.2):
            ours, theirs, truth = compared(self.random, noise, 6).T
            self.assertGreater(len(ours), 3)
            self.assertTrue((ours >= truth - 1e-9).all())  # in every domain
            self.assertTrue((ours >= theirs - 1e-9).all())

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
        with self.assertRaises(kith.Error):  # goes on for ever
            kith.explain_policy(transitions, features, np.zeros(16, int))


if __name__ == "__main__" and sys.argv[1:2] == ["compare"]:
    print_comparison(int(sys.argv[2]) if len(sys.argv) > 2 else 60)
elif __name__ == "__main__":
    unittest.main()
