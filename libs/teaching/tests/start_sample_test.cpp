#include "kith/teaching/start_sample.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <span>
#include <vector>

#include "item_delivery.hpp"
#include "kith/domains/domain_file.hpp"
#include "kith/teaching/cache.hpp"

namespace kith {
namespace {

using testing::item_delivery;

constexpr double kNothingPromised = -1.0;

const Atlas& planned_on_demand() {
  static const Atlas atlas{load_domain("item-delivery"), BehaviourSource::kOnDemand};
  return atlas;
}

// Near a point of the cover, some of which are on boundaries, where two paths are equally good.
Direction near_point(const PriorCover& cover, std::size_t i) {
  const Direction offset{{1e-3, 2e-3, -1.5e-3}};
  return (cover.point(i) + offset).normalized();
}

// Per point of the prior's cover the share of the sampled starts that people predict right, from their paths; -1 for
// those without an optimum somewhere, about whom the sample promises nothing.
std::vector<double> graded(TeachingCache& cache, const StartSample& sample, const PriorCover& cover) {
  std::vector<double> shares(cover.size(), 0.0);
  for (std::size_t i = 0; i < cover.size(); ++i) {
    const auto cell = cache.behaviours().locate(near_point(cover, i));
    bool has_optimum = true;
    for (std::size_t s = 0; s < sample.size(); ++s) {
      const auto answer = cache.behaviours().answer(sample.start(s), cell);
      if (!answer) has_optimum = false;
      shares[i] += sample.weight(s) * grade_answer(cache.atlas(), sample.start(s), answer).share_right;
    }
    if (!has_optimum) shares[i] = kNothingPromised;
  }
  return shares;
}

std::vector<double> estimated(const StartSample& sample, const PriorCover& cover) {
  std::vector<std::vector<double>> axes(3);
  for (std::size_t i = 0; i < cover.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) axes[k].push_back(near_point(cover, i)[static_cast<Eigen::Index>(k)]);
  }
  const std::vector<std::span<const double>> views(axes.begin(), axes.end());
  return sample.share_right(views);
}

TEST(StartSample, GradesAsThePathsOfPeopleDoWhereBehavioursAreTabulated) {
  TeachingCache cache{item_delivery()};
  const auto& cover = cache.cover(item_delivery().prior_cone(), 200);
  for (std::size_t k = 0; k < 3; ++k) {
    const auto sample = StartSample::spread_over_starts(item_delivery(), k);
    EXPECT_LE(sample.size(), 60u);
    const auto truth = graded(cache, sample, cover), estimate = estimated(sample, cover);
    for (std::size_t i = 0; i < cover.size(); ++i) {
      if (truth[i] == kNothingPromised) continue;
      EXPECT_NEAR(estimate[i], truth[i], 1e-9) << k << " " << i;
    }
  }
}

TEST(StartSample, IsAnUpperBoundCloseToTheTruthElsewhere) {
  TeachingCache cache{planned_on_demand()};
  const auto& cover = cache.cover(planned_on_demand().prior_cone(), 100);
  for (std::size_t k = 0; k < 3; ++k) {
    for (const auto& sample : {StartSample::spread_over_starts(planned_on_demand(), k),
                               StartSample::spread_over_facets(planned_on_demand(), k)}) {
      const auto truth = graded(cache, sample, cover), estimate = estimated(sample, cover);
      double excess = 0.0;
      for (std::size_t i = 0; i < cover.size(); ++i) {
        if (truth[i] == kNothingPromised) continue;
        EXPECT_GE(estimate[i], truth[i] - 1e-9);
        excess += (estimate[i] - truth[i]) / static_cast<double>(cover.size());
      }
      EXPECT_LT(excess, 0.08) << k;
    }
  }
}

TEST(StartSample, GivesEveryFacetTheSameWeight) {
  for (std::size_t k = 0; k < 3; ++k) {
    const auto sample = StartSample::spread_over_facets(item_delivery(), k);
    double sum = 0.0;
    for (std::size_t s = 0; s < sample.size(); ++s) sum += sample.weight(s);
    EXPECT_NEAR(sum, 1.0, 1e-12);
    const auto facets = item_delivery().knowledge_components()[k].constraints.count();
    EXPECT_GE(sample.size(), 1u);
    EXPECT_LE(sample.size(), 6 * facets);
  }
}

}  // namespace
}  // namespace kith
