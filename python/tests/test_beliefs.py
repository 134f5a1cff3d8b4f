"""Cones and beliefs without a session."""

import copy
import gc
import unittest

import kith
import numpy as np


class Cones(unittest.TestCase):
    def test_an_octant_is_an_eighth(self):
        octant = kith.Cone([(1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 0)])
        self.assertAlmostEqual(octant.solid_angle, np.pi / 2, places=12)
        self.assertEqual(octant.facets, [(0, 0, 1), (0, 1, 0), (1, 0, 0)])
        self.assertTrue(octant.contains([1, 1, 1]))
        self.assertIsNone(octant.clipped([(-1, -1, -1)]))
        self.assertTrue(octant.implies((1, 1, 1)))
        self.assertEqual(octant, kith.Cone(np.eye(3, dtype=int)))

    def test_samples_lie_inside(self):
        cone = kith.Cone([(1, 0, 0, 0), (0, 1, 1, 0)])
        points = cone.sample(500, seed=4)
        self.assertEqual(points.shape, (500, 4))
        np.testing.assert_allclose(np.linalg.norm(points, axis=1), 1, atol=1e-12)
        self.assertTrue((points @ np.array(cone.facets).T >= -1e-12).all())
        np.testing.assert_array_equal(points, cone.sample(500, seed=4))
        self.assertEqual(cone.cover(64).shape, (64, 4))

    def test_what_is_no_cone_is_refused(self):
        for wrong in ([(1, 0), (-1, 0)], [(0.5, 1.0)], [(np.nan, 1)], [(2**40, 1)], [(1,)], [[[1, 2]]], "ab", [(1, 0), (1, 0, 0)]):
            with self.assertRaises((ValueError, TypeError), msg=str(wrong)):
                kith.Cone(wrong)
        with self.assertRaises(ValueError):
            kith.Cone(dimension=9)
        with self.assertRaises(ValueError):
            kith.Cone()


class Beliefs(unittest.TestCase):
    def setUp(self):
        self.belief = kith.ParticleBelief(kith.Cone([(0, 0, -1)]), 500, seed=7)

    def test_arrays_share_its_memory(self):
        belief = self.belief
        self.assertEqual(belief.points.shape, (500, 3))
        self.assertTrue(np.shares_memory(belief.points, belief.points))
        self.assertFalse(belief.points.flags.owndata)
        self.assertFalse(belief.points.flags.writeable)
        self.assertAlmostEqual(float(belief.weights.sum()), 1.0, places=12)

    def test_arrays_stay_what_they_are(self):
        points, weights = self.belief.points, self.belief.weights
        before = points.copy(), weights.copy()
        self.belief.observe([(1, 0, 0)], ability=0.9)
        np.testing.assert_array_equal(points, before[0])
        np.testing.assert_array_equal(weights, before[1])
        self.assertFalse(np.array_equal(weights, self.belief.weights))
        del self.belief
        gc.collect()
        np.testing.assert_array_equal(points, before[0])

    def test_mass_is_the_sum_of_weights(self):
        self.belief.observe([(1, 2, 0), (-1, 3, 0)], ability=0.85)
        points, weights = self.belief.points, self.belief.weights
        inside = points @ np.array([1, -2, 5]) >= 0
        self.assertAlmostEqual(self.belief.mass_in([(1, -2, 5)]), float(weights[inside].sum()), places=12)
        self.assertAlmostEqual(self.belief.effective_sample_size, float(1 / (weights**2).sum()), places=6)

    def test_copies_are_independent_and_alike(self):
        other = copy.deepcopy(self.belief)
        self.assertEqual(other, self.belief)
        other.observe([(1, 0, 0)])
        self.assertNotEqual(other, self.belief)
        self.belief.observe([(1, 0, 0)])
        self.assertEqual(other, self.belief)

    def test_what_is_impossible_changes_nothing(self):
        before = copy.copy(self.belief)
        with self.assertRaises(kith.Error):
            self.belief.observe([(0, 0, 1)], ability=1.0)
        self.assertEqual(before, self.belief)
        for wrong in ({"ability": 0.3}, {"form": "round"}):
            with self.assertRaises(ValueError):
                self.belief.observe([(1, 0, 0)], **wrong)
        with self.assertRaises(ValueError):
            self.belief.observe([(1, 0)])


if __name__ == "__main__":
    unittest.main()
