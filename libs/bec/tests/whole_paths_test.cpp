// What starts show where the robot's paths do not meet every state: comparisons with whole paths.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "kith/bec/atlas.hpp"
#include "kith/bec/behaviours.hpp"
#include "kith/domains/domain_file.hpp"
#include "kith/geometry/cone_sampler.hpp"

namespace kith {
namespace {

// Going around costs two steps more than going through three cells of mud. Who enters the mud and leaves it again as
// the robot would only finds out that mud costs something.
constexpr const char* kMud = R"(schema = "kith.domain/1"
id = "mud"
title = "Around the mud"

[mdp]
discount  = 1.0
max_steps = 20

[map]
rows = [".......",
        "S.mmm.G"]

[map.legend]
"." = "floor"
"S" = { start = true }
"G" = { goal = true }
"m" = { terrain = "mud" }

[[feature]]
name = "mud"
when = "enter:mud"

[[feature]]
name = "step"
when = "action"

[reward]
weights = { mud = -1.5, step = -1 }

[prior]
halfspaces = [ { step = -1 } ]
)";

Domain muddy_domain(const std::string& text) {
  auto reading = parse_domain(text, "mud.toml");
  for (const auto& diagnostic : reading.diagnostics) ADD_FAILURE() << diagnostic.id << ' ' << diagnostic.message;
  return *std::move(reading.domain);
}

const Atlas& mud() {
  static const Atlas atlas{muddy_domain(std::string{kMud} + "\n[family]\nstarts = 1\n")};
  return atlas;
}

// Of the starts those that people who cover a region predict right, and their regret; means over people with an
// optimum.
struct Predictions {
  double share_right = 0.0;
  double regret = 0.0;
};

Predictions predictions_within(const Atlas& atlas, const ConstraintSet& set, std::size_t n) {
  Behaviours behaviours{atlas};
  const auto cone = Cone::intersection(atlas.constraints().half_spaces(set | atlas.prior()));
  const Eigen::MatrixXd people = ConeSampler{cone.value()}.cover(n);
  Predictions sum;
  double total = 0.0;
  for (Eigen::Index i = 0; i < people.cols(); ++i) {
    const auto cell = behaviours.locate(people.col(i));
    for (StartIndex start{0}; start.value() < atlas.num_states(); ++start) {
      if (!atlas.is_candidate(start)) continue;
      const auto answer = behaviours.answer(start, cell);
      if (!answer) continue;
      const double regret = atlas.domain().weights().return_of(atlas.feature_counts(start) - *answer);
      sum.share_right += regret <= 0.0 ? 1.0 : 0.0;
      sum.regret += regret;
      total += 1.0;
    }
  }
  return {sum.share_right / total, sum.regret / total};
}

TEST(WholePaths, TellWhatNoSingleDeviationDoes) {
  const auto& facets = mud().policy_bec_half_spaces();
  const HalfSpace around{IntegerVector{-3, 2}};
  EXPECT_NE(std::find(facets.begin(), facets.end(), around), facets.end());
  const auto number = mud().constraints().find(around);
  ASSERT_TRUE(number.has_value());
  ASSERT_EQ(mud().tests_for(*number).size(), 1u);
  EXPECT_TRUE(mud().one_step(mud().tests_for(*number).front()).contains(*number));
  EXPECT_TRUE(mud().knowledge_components().back().constraints.contains(*number));
}

TEST(WholePaths, AreNotComparedWherePathsMeetEveryState) {
  const Atlas everywhere{muddy_domain(kMud), BehaviourSource::kOnDemand};
  const auto& facets = everywhere.policy_bec_half_spaces();
  EXPECT_EQ(std::find(facets.begin(), facets.end(), HalfSpace{IntegerVector{-3, 2}}), facets.end());
  EXPECT_EQ(predictions_within(everywhere, everywhere.policy_bec(), 50).share_right, 1.0);
}

TEST(WholePaths, LeaveARegionWithinWhichNobodyErrs) {
  EXPECT_LT(predictions_within(mud(), mud().no_constraints(), 50).share_right, 1.0);
  EXPECT_EQ(predictions_within(mud(), mud().policy_bec(), 50).share_right, 1.0);
}

// Six features, 84 of 15 000 states as starts: by single deviations alone nearly a third of the regret would remain.
TEST(WholePaths, LeaveHardlyAnyRegretInTheWarehouse) {
  const Atlas warehouse{load_domain("warehouse")};
  const auto before = predictions_within(warehouse, warehouse.no_constraints(), 40);
  const auto after = predictions_within(warehouse, warehouse.policy_bec(), 40);
  EXPECT_LT(after.regret, 0.02 * before.regret);
  EXPECT_GT(after.share_right, 0.95);
  ASSERT_TRUE(warehouse.regret_left().has_value());
  EXPECT_LT(*warehouse.regret_left(), 0.02);
}

TEST(WholePaths, AreSaidToBeAnEstimateWithItsSize) {
  EXPECT_EQ(mud().regret_left(), 0.0);
  EXPECT_FALSE((Atlas{muddy_domain(kMud), BehaviourSource::kOnDemand}.regret_left().has_value()));
  EXPECT_FALSE(Atlas{load_domain("item-delivery")}.regret_left().has_value());
}

}  // namespace
}  // namespace kith
