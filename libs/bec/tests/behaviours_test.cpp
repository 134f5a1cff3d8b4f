#include "kith/bec/behaviours.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "item_delivery.hpp"
#include "kith/bec/comparison.hpp"
#include "kith/core/distributions.hpp"
#include "kith/domains/domain_file.hpp"

namespace kith {
namespace {

using testing::item_delivery;

Direction random_weights(RandomStream& random, std::size_t d) {
  Direction weights(static_cast<Eigen::Index>(d));
  for (double& w : weights) w = standard_normal(random);
  return weights.normalized();
}

std::string text_of(const std::string& name) {
  for (const auto& domain : built_in_domains()) {
    if (domain.name == name) return std::string{domain.text};
  }
  return {};
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

Domain domain_from(const std::string& text) {
  auto reading = parse_domain(text, "test.toml");
  for (const auto& diagnostic : reading.diagnostics) ADD_FAILURE() << diagnostic.id << ' ' << diagnostic.message;
  return *std::move(reading.domain);
}

const Atlas& on_demand() {
  static const Atlas atlas{item_delivery().domain(), BehaviourSource::kOnDemand};
  return atlas;
}

TEST(Behaviours, AtlasWithoutTablesKnowsTheSamePolicy) {
  const auto& tables = item_delivery();
  EXPECT_TRUE(tables.find_tables());
  EXPECT_FALSE(on_demand().find_tables());
  EXPECT_EQ(on_demand().policy_bec_half_spaces(), tables.policy_bec_half_spaces());
  EXPECT_EQ(on_demand().policy_bec_area_sr(), tables.policy_bec_area_sr());
  ASSERT_EQ(on_demand().num_states(), tables.num_states());
  for (StartIndex start{0}; start.value() < tables.num_states(); ++start) {
    ASSERT_EQ(on_demand().feature_counts(start), tables.feature_counts(start));
    ASSERT_EQ(on_demand().constraints().half_spaces(on_demand().one_step(start)),
              tables.constraints().half_spaces(tables.one_step(start)));
    ASSERT_EQ(on_demand().mean_dissimilarity(start), tables.mean_dissimilarity(start));
    ASSERT_TRUE(on_demand().is_candidate(start));
  }
}

TEST(Behaviours, PlansWhatTheTablesSay) {
  Behaviours tables{item_delivery()};
  Behaviours plans{on_demand()};
  auto random = RandomStream{5}.split("weights");
  const auto& all = item_delivery().knowledge_components().back();
  const auto& all_planned = on_demand().knowledge_components().back();
  std::size_t with_optimum = 0;
  for (int round = 0; round < 6; ++round) {
    std::vector<PolicyCellIndex> in_tables;
    std::vector<PolicyCellIndex> in_plans;
    for (int i = 0; i < 4; ++i) {
      const auto weights = random_weights(random, 3);
      in_tables.push_back(tables.locate(weights));
      in_plans.push_back(plans.locate(weights));
      EXPECT_EQ(plans.locate(weights), in_plans.back());
    }
    const auto from_tables = tables.conveyed_by_class(all, in_tables);
    const auto from_plans = plans.conveyed_by_class(all_planned, in_plans);
    for (StartIndex start{0}; start.value() < item_delivery().num_states(); start = StartIndex{start.value() + 7}) {
      ASSERT_EQ(plans.constraints().half_spaces(from_plans.set(on_demand().start_class(start))),
                tables.constraints().half_spaces(from_tables.set(item_delivery().start_class(start))));
      for (std::size_t i = 0; i < in_plans.size(); ++i) {
        const auto answer = plans.answer(start, in_plans[i]);
        ASSERT_EQ(answer, tables.answer(start, in_tables[i]));
        with_optimum += answer.has_value() ? 1u : 0u;
      }
    }
  }
  EXPECT_GT(with_optimum, 1000u);
}

TEST(Behaviours, ForgetsAndPlansAgain) {
  Behaviours plenty{on_demand()};
  Behaviours few{on_demand(), 2, 0};
  auto random = RandomStream{6}.split("weights");
  std::vector<Direction> weights;
  for (int i = 0; i < 5; ++i) weights.push_back(random_weights(random, 3));
  for (int round = 0; round < 2; ++round) {
    for (const auto& w : weights) {
      for (const StartIndex start : {StartIndex{17}, StartIndex{4000}, StartIndex{9000}}) {
        EXPECT_EQ(few.answer(start, few.locate(w)), plenty.answer(start, plenty.locate(w)));
        const auto cell = few.locate(w);
        const auto other = plenty.locate(w);
        EXPECT_EQ(few.constraints().half_spaces(few.conveyed(start, {&cell, 1})),
                  plenty.constraints().half_spaces(plenty.conveyed(start, {&other, 1})));
      }
    }
  }
}

// With room for so little that everybody begins anew again and again.
TEST(PartitionStore, KeepsNoMoreThanItMayAndAnswersAllTheSame) {
  constexpr std::size_t kMost = 40'000;
  constexpr std::size_t kOneLookup = 20'000;
  const auto store = std::make_shared<PartitionStore>(on_demand(), kMost);
  Behaviours plenty{on_demand()};
  std::vector<std::shared_ptr<PolicyPartitions>> views;
  for (int i = 0; i < 3; ++i) views.push_back(std::make_shared<PolicyPartitions>(store));
  auto random = RandomStream{9}.split("weights");
  std::size_t num_renewed = 0;
  for (int round = 0; round < 40; ++round) {
    const auto weights = random_weights(random, 3);
    // The last one never begins anew, and so prevents that the partitions that it uses are freed.
    for (std::size_t i = 0; i < views.size(); ++i) {
      if (i + 1 < views.size() && views[i]->is_outdated()) {
        views[i]->renew();
        ++num_renewed;
      }
      Behaviours few{on_demand(), 2, 0, views[i]};
      for (const StartIndex start : {StartIndex{17}, StartIndex{4000}, StartIndex{9000}}) {
        ASSERT_EQ(few.answer(start, few.locate(weights)), plenty.answer(start, plenty.locate(weights)));
      }
      ASSERT_LE(store->memory(), kMost + kOneLookup);
    }
  }
  EXPECT_GT(num_renewed, 1u);
  views.clear();
  EXPECT_LE(store->memory(), kMost / 2 + kOneLookup);
}

TEST(PartitionStore, IsSharedByThreads) {
  constexpr std::size_t kThreads = 4;
  const auto store = std::make_shared<PartitionStore>(on_demand(), 400'000);
  auto random = RandomStream{10}.split("weights");
  std::vector<Direction> weights;
  std::vector<std::optional<IntegerVector>> expected;
  Behaviours alone{on_demand()};
  const StartIndex start{4000};
  for (int i = 0; i < 60; ++i) {
    weights.push_back(random_weights(random, 3));
    expected.push_back(alone.answer(start, alone.locate(weights.back())));
  }
  std::vector<std::size_t> num_wrong(kThreads, 0);
  std::vector<std::thread> threads;
  for (std::size_t t = 0; t < kThreads; ++t) {
    threads.emplace_back([&, t] {
      const auto view = std::make_shared<PolicyPartitions>(store);
      auto behaviours = std::make_unique<Behaviours>(on_demand(), 8, 0, view);
      for (std::size_t i = 0; i < weights.size(); ++i) {
        const std::size_t at = (i * (2 * t + 1) + 7 * t) % weights.size();
        num_wrong[t] += behaviours->answer(start, behaviours->locate(weights[at])) != expected[at] ? 1u : 0u;
        if (i % 8 != 0 || !view->is_outdated()) continue;
        behaviours.reset();
        view->renew();
        behaviours = std::make_unique<Behaviours>(on_demand(), 8, 0, view);
      }
    });
  }
  for (auto& thread : threads) thread.join();
  EXPECT_EQ(num_wrong, std::vector<std::size_t>(kThreads, 0));
}

TEST(Behaviours, DiscountedOnesAreComparedByExpectedCounts) {
  const Atlas atlas{domain_from(replaced(text_of("item-delivery"), "discount  = 1.0", "discount = 0.98"))};
  EXPECT_FALSE(atlas.find_tables());
  EXPECT_FALSE(atlas.domain().is_exact());
  EXPECT_GT(atlas.policy_bec_half_spaces().size(), 2u);
  const auto& robot = atlas.domain().weights();
  for (const auto& half_space : atlas.policy_bec_half_spaces()) {
    EXPECT_GT(sign_of_dot(half_space.normal(), robot.integer), 0);
  }
  // Counts of the path that is shown, discounted.
  const auto scale = static_cast<double>(atlas.domain().count_scale());
  for (StartIndex start{0}; start.value() < atlas.num_states(); start = StartIndex{start.value() + 101}) {
    const auto path = atlas.trajectory(start);
    const double steps = (1.0 - std::pow(0.98, static_cast<double>(path.actions.size()))) / 0.02;
    EXPECT_NEAR(static_cast<double>(atlas.feature_counts(start)[2]) / scale, steps, 1e-6);
  }
  // The robot's own weights expect what the robot does; nobody else's earn more.
  Behaviours behaviours{atlas};
  const auto own = behaviours.locate(robot.unit);
  auto random = RandomStream{8}.split("weights");
  const auto other = behaviours.locate(random_weights(random, 3));
  for (StartIndex start{0}; start.value() < atlas.num_states(); start = StartIndex{start.value() + 997}) {
    EXPECT_TRUE(behaviours.conveyed(start, {&own, 1}).empty());
    const auto answer = behaviours.answer(start, other);
    ASSERT_TRUE(answer.has_value());
    EXPECT_GT(robot.return_of(atlas.feature_counts(start) - *answer) / scale, -1e-6);
  }
}

TEST(Preference, IsExactForCounts) {
  EXPECT_EQ(preference(IntegerVector{-2, 0, 4}, 1), HalfSpace(IntegerVector{-1, 0, 2}));
  EXPECT_FALSE(preference(IntegerVector{0, 0, 0}, 1).has_value());
}

TEST(Preference, IsRoundedToLengthsThatConesTakeForExpectations) {
  const std::int64_t scale = std::int64_t{1} << 24;
  EXPECT_FALSE(preference(IntegerVector{100, -50, 3}, scale).has_value());  // less than 1e-4 of a count
  for (std::size_t d = 2; d <= 8; ++d) {
    IntegerVector difference(d);
    for (std::size_t k = 0; k < d; ++k)
      difference[k] = (k % 2 == 0 ? 1 : -1) * static_cast<std::int64_t>(k + 1) * scale * 3 + 12345;
    const auto rounded = preference(difference, scale);
    ASSERT_TRUE(rounded.has_value());
    double product = 0.0;
    double length = 0.0;
    double exact_length = 0.0;
    for (std::size_t k = 0; k < d; ++k) {
      const auto a = static_cast<double>(rounded->normal()[k]);
      const auto b = static_cast<double>(difference[k]);
      product += a * b;
      length += a * a;
      exact_length += b * b;
    }
    length = std::sqrt(length);
    EXPECT_LE(length, std::ldexp(1.0, d <= 3 ? 20 : 19) + 4.0);
    EXPECT_GE(product / (length * std::sqrt(exact_length)), d == 8 ? 0.99998 : 0.999999);
  }
}

}  // namespace
}  // namespace kith
