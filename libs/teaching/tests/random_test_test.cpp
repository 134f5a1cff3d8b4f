#include "kith/teaching/random_test.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "item_delivery.hpp"
#include "kith/teaching/cache.hpp"

namespace kith {
namespace {

using People = std::vector<std::vector<double>>;
using testing::item_delivery;

class RandomTestTest : public ::testing::Test {
 protected:
  [[nodiscard]] ParticleBelief prior() {
    const FilterOptions filter{.particles = 300};
    return {cache_.cover(item_delivery().prior_cone(), filter.particles), filter};
  }
  TeachingCache cache_{item_delivery()};
};

TEST_F(RandomTestTest, OfOnePersonIsTheShareOfTestsAnsweredCorrectly) {
  const auto belief = prior();
  const auto& table = cache_.exam().table();
  for (std::size_t k = 0; k < table.num_components(); ++k) {
    double expected = 0.0;
    for (std::size_t i = 0; i < belief.size(); ++i) {
      expected += belief.weights()[i] * table.tests_right(item_delivery().cells().locate(belief.point(i)), k);
    }
    const RandomTest test{item_delivery(), cache_.exam(), k};
    EXPECT_NEAR(test.all_right(People{test.right(belief)}), expected, 1e-12);
  }
}

TEST_F(RandomTestTest, IsHarderForSeveralPeopleInWhateverOrder) {
  const RandomTest test{item_delivery(), cache_.exam(), 2};
  auto taught = prior();
  taught.observe(item_delivery().constraints().half_spaces(item_delivery().knowledge_components()[2].constraints),
                 HalfSpaceLikelihood{0.9, LikelihoodForm::kDiscontinuous, 3}, RandomStream{1});
  const auto novice = test.right(prior()), expert = test.right(taught);
  EXPECT_LT(test.all_right(People{novice, expert}), test.all_right(People{novice}));
  EXPECT_EQ(test.all_right(People{novice, expert}), test.all_right(People{expert, novice}));
}

}  // namespace
}  // namespace kith
