// Particle beliefs above three dimensions beside the exact posterior: whether truths that were drawn from the prior are
// among the particles as one of them [talts2018], and whether regions have the mass that a long chain gives them. The
// fast tests are a short form of the slow ones.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "kith/belief/particle_belief.hpp"
#include "observed_truth.hpp"

namespace kith {
namespace {

using testing::chain_masses;
using testing::draw_observations;
using testing::draw_truth;
using testing::Estimate;
using testing::estimate_from;
using testing::log_product;
using testing::negative_last;
using testing::observe_all;
using testing::SimulatedObservation;
using testing::some_likelihoods;

constexpr std::size_t kMostUpdates = 50;
constexpr std::size_t kDrawn = 99;  // particles among which a truth is ranked
constexpr std::size_t kBins = 20;

// What truth and particles are ranked by.
constexpr std::size_t kQuantities = 4;
std::array<double, kQuantities> quantities(const Direction& w, std::span<const SimulatedObservation> observations) {
  double sum = 0.0, alternating = 0.0;
  for (Eigen::Index k = 0; k < w.size(); ++k) {
    sum += w[k];
    alternating += k % 2 == 0 ? w[k] : -w[k];
  }
  // The last one depends on the data and shows a belief that is too narrow or too wide in any direction.
  return {w[0], sum, alternating, log_product(observations, w)};
}

// Counts in bins of the ranks of the truths of many simulations, per quantity.
using Histogram = std::array<double, kBins>;
std::array<Histogram, kQuantities> ranks_of_truths(std::size_t d, std::size_t simulations, std::size_t most_updates) {
  std::array<Histogram, kQuantities> counts{};
  const PriorCover cover{negative_last(d), 1000};
  const auto likelihoods = some_likelihoods(d);
  for (std::size_t s = 0; s < simulations; ++s) {
    RandomStream random = RandomStream{20261123}.split(d).split(s);
    const Direction truth = draw_truth(d, random);
    const std::size_t updates = 1 + uniform_index(most_updates, random);
    const auto observations = draw_observations(truth, updates, likelihoods, random);
    ParticleBelief belief{cover, {}};
    observe_all(belief, observations, random.split("belief"));
    const auto of_truth = quantities(truth, observations);
    std::array<std::size_t, kQuantities> ranks{};
    for (const auto& [index, count] : belief.systematic_draws(kDrawn, random.split("draws"))) {
      const auto of_particle = quantities(belief.point(index), observations);
      for (std::size_t q = 0; q < kQuantities; ++q) ranks[q] += of_particle[q] < of_truth[q] ? count : 0;
    }
    for (std::size_t q = 0; q < kQuantities; ++q) ++counts[q][ranks[q] * kBins / (kDrawn + 1)];
  }
  return counts;
}

double chi_square(const Histogram& counts) {
  const double expected = std::accumulate(counts.begin(), counts.end(), 0.0) / kBins;
  double sum = 0.0;
  for (const double count : counts) sum += (count - expected) * (count - expected) / expected;
  return sum;
}

// Of 19 degrees of freedom, exceeded with probability .001.
constexpr double kMostChiSquare = 43.82;

// Regions of some mass: half-spaces through the truth's neighbourhood, and wedges.
std::vector<std::vector<HalfSpace>> regions_near(const Direction& truth, RandomStream& random) {
  const std::size_t d = static_cast<std::size_t>(truth.size());
  const auto near_truth = [&] {
    Direction normal(truth.size());
    fill_standard_normal({normal.data(), d}, random);
    normal -= (normal.dot(truth) - 0.1 * standard_normal(random)) * truth;
    normal.normalize();
    IntegerVector rounded(d);
    for (std::size_t k = 0; k < d; ++k) rounded[k] = std::llround(100.0 * normal[static_cast<Eigen::Index>(k)]);
    return HalfSpace{rounded};
  };
  std::vector<std::vector<HalfSpace>> regions;
  for (std::size_t r = 0; r < 3; ++r) regions.push_back({near_truth()});
  for (std::size_t r = 0; r < 2; ++r) regions.push_back({near_truth(), near_truth()});
  return regions;
}

struct Comparison {
  Estimate belief, chain;
  double efficiency = 0.0;  // independent draws that would estimate the mass as well as the belief does
  [[nodiscard]] double standard_errors() const {
    return (belief.mean - chain.mean) / std::hypot(belief.standard_error, chain.standard_error);
  }
};

// The mass of five regions after 50 updates in many beliefs beside that in a chain. @param change  of truth after half
// of the updates.
std::vector<Comparison> compare_masses(std::size_t d, std::size_t beliefs, std::size_t steps, bool change) {
  RandomStream random = RandomStream{4}.split(d).split(change ? 1 : 0);
  const auto likelihoods = some_likelihoods(d);
  const Direction truth = draw_truth(d, random);
  auto observations = draw_observations(truth, change ? kMostUpdates / 2 : kMostUpdates, likelihoods, random);
  if (change) {
    const Direction other = draw_truth(d, random);
    for (auto& draw_observation : draw_observations(other, kMostUpdates / 2, likelihoods, random))
      observations.push_back(draw_observation);
  }
  const auto regions = regions_near(truth, random);
  const auto chain = chain_masses(truth, observations, regions, steps, random.split("chain"));
  const PriorCover cover{negative_last(d), 1000};
  std::vector<std::vector<double>> masses(regions.size());
  for (std::size_t i = 0; i < beliefs; ++i) {
    ParticleBelief belief{cover, {}};
    observe_all(belief, observations, RandomStream{5}.split(i));
    for (std::size_t r = 0; r < regions.size(); ++r) masses[r].push_back(belief.mass_in(regions[r]));
  }
  std::vector<Comparison> result;
  for (std::size_t r = 0; r < regions.size(); ++r) {
    Comparison one{estimate_from(masses[r]), chain[r]};
    const double variance = one.belief.standard_error * one.belief.standard_error * static_cast<double>(beliefs);
    one.efficiency = one.chain.mean * (1.0 - one.chain.mean) / variance;
    result.push_back(one);
  }
  return result;
}

std::string described(const Comparison& one) {
  return "belief " + std::to_string(one.belief.mean) + " (" + std::to_string(one.belief.standard_error) + "), chain " +
         std::to_string(one.chain.mean) + " (" + std::to_string(one.chain.standard_error) + "), worth " +
         std::to_string(one.efficiency) + " independent draws";
}

std::string name_of(const ::testing::TestParamInfo<std::size_t>& dimension) {
  return "d" + std::to_string(dimension.param);
}

// --- short form ---------------------------------------------------------------

TEST(BeliefCalibration, RanksATruthAsOneOfItsParticles) {
  for (const auto& counts : ranks_of_truths(6, 100, 30)) EXPECT_LT(chi_square(counts), kMostChiSquare);
}

// Four standard errors: five comparisons, 3e-4 together.
TEST(BeliefCalibration, GivesRegionsTheMassOfALongChain) {
  for (const auto& compare_masse : compare_masses(5, 10, 200'000, false)) {
    EXPECT_LT(std::abs(compare_masse.standard_errors()), 4.0) << described(compare_masse);
  }
}

// --- full form ----------------------------------------------------------------

class BeliefCalibrationSlow : public ::testing::TestWithParam<std::size_t> {};

TEST_P(BeliefCalibrationSlow, RanksATruthAsOneOfItsParticles) {
  const auto all = ranks_of_truths(GetParam(), 1000, kMostUpdates);
  for (std::size_t q = 0; q < kQuantities; ++q) {
    EXPECT_LT(chi_square(all[q]), kMostChiSquare) << "quantity " << q;
    RecordProperty("chi_square_" + std::to_string(q), std::to_string(chi_square(all[q])));
  }
}

// Three standard errors, of the chain and of the mean over 40 beliefs together. One belief of 1 000 particles is worth
// at least 50 independent draws.
TEST_P(BeliefCalibrationSlow, GivesRegionsTheMassOfALongChain) {
  for (const bool change : {false, true}) {
    for (const auto& compare_masse : compare_masses(GetParam(), 40, 4'000'000, change)) {
      EXPECT_LT(std::abs(compare_masse.standard_errors()), 3.0) << described(compare_masse);
      EXPECT_GT(compare_masse.efficiency, 50.0) << described(compare_masse);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, BeliefCalibrationSlow, ::testing::Values(4, 6, 8), name_of);

}  // namespace
}  // namespace kith
