#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "golden.hpp"
#include "kith/core/error.hpp"
#include "kith/domains/domain_file.hpp"
#include "kith/mdp/planner.hpp"

namespace kith {
namespace {

// The built-in domain with its optimal plans.
struct ItemDelivery : ::testing::Test {
  ItemDelivery() {
    for (std::size_t m = 0; m < domain.num_mdps(); ++m) {
      plans.push_back(*plan_exactly(domain.mdp(MdpIndex{m}), domain.weights().integer).solution);
    }
  }

  // How many choices of the state are optimal.
  [[nodiscard]] int num_optimal(std::size_t m, StateIndex s) const {
    const Mdp& mdp = domain.mdp(MdpIndex{m});
    int n = 0;
    for (const Choice& choice : mdp.choices(s)) {
      const Outcome& outcome = mdp.outcomes(choice).front();
      const Int128 reward = dot(domain.weights().integer, mdp.integer_features(outcome));
      n += reward + plans[m].values[outcome.next.value()] == plans[m].values[s.value()] ? 1 : 0;
    }
    return n;
  }

  Domain domain = load_domain("item-delivery");
  std::vector<ExactSolution> plans;
};

TEST_F(ItemDelivery, HasTheStatesOfThePaper) {
  EXPECT_EQ(domain.num_mdps(), 64u);
  EXPECT_EQ(domain.num_starts(), 9'312u);
  for (std::size_t m = 0; m < 64; ++m) {
    EXPECT_EQ(domain.mdp(MdpIndex{m}).num_states(), m % 2 == 0 ? 100u : 191u);  // the last bit is the charger
    EXPECT_TRUE(domain.mdp(MdpIndex{m}).has_feature(2));
    EXPECT_EQ(domain.mdp(MdpIndex{m}).has_feature(1), m % 2 == 1);
    EXPECT_EQ(domain.mdp(MdpIndex{m}).has_feature(0), m > 1);
  }
}

TEST_F(ItemDelivery, HasTheWeightsAndWordsOfItsFile) {
  EXPECT_EQ(domain.weights().raw, (std::vector<double>{-3.0, 3.5, -1.0}));
  EXPECT_EQ(domain.weights().integer, (IntegerVector{-6, 7, -2}));
  EXPECT_NEAR(domain.weights().unit[1], 0.7420, 1e-4);
  ASSERT_EQ(domain.prior().size(), 1u);
  EXPECT_EQ(domain.prior()[0].normal(), (IntegerVector{0, 0, -1}));
  EXPECT_EQ(domain.feature_words(1), "stopping at the charger");
  EXPECT_EQ(domain.max_steps(), 60u);
  EXPECT_EQ(domain.action_names(), (std::vector<std::string>{"up", "down", "left", "right", "pickup", "dropoff"}));
  EXPECT_EQ(domain.map()->item_names(), (std::vector<std::string>{"parcel"}));
}

TEST_F(ItemDelivery, HasOptimalPathsOfOneToFourteenSteps) {
  std::size_t shortest = 1000;
  std::size_t longest = 0;
  for (std::size_t m = 0; m < 64; ++m) {
    for (std::size_t s = 0; s < domain.mdp(MdpIndex{m}).num_states(); ++s) {
      const auto path = canonical_trajectory(domain.mdp(MdpIndex{m}), plans[m].canonical_choice, StateIndex{s});
      shortest = std::min(shortest, path.actions.size());
      longest = std::max(longest, path.actions.size());
    }
  }
  EXPECT_EQ(shortest, 1u);
  EXPECT_EQ(longest, 14u);
}

TEST_F(ItemDelivery, HasTiesInSoManyStates) {
  int ties = 0;
  for (std::size_t m = 0; m < 64; ++m) {
    for (std::size_t s = 0; s < domain.mdp(MdpIndex{m}).num_states(); ++s) {
      ties += num_optimal(m, StateIndex{s}) > 1 ? 1 : 0;
    }
  }
  EXPECT_EQ(ties, 1'526);
}

TEST_F(ItemDelivery, ReadsWithoutAnyComplaint) {
  EXPECT_TRUE(parse_domain(built_in_domains().front().text, "built in").diagnostics.empty());
}

Cell cell_of(const nlohmann::json& thing) { return {thing.at("x").get<int>(), thing.at("y").get<int>()}; }

// The reference calls the robot a taxi, its parcel a passenger and the charger a hot-swap station.
GridState state_of(const nlohmann::json& reference) {
  GridState state;
  state.robot = cell_of(reference.at("agent").at(0));
  const auto& parcel = reference.at("passenger").at(0);
  state.items = {cell_of(parcel)};
  state.carried = {parcel.at("in_taxi").get<int>() != 0};
  if (reference.contains("hotswap_station")) {
    for (const auto& station : reference.at("hotswap_station")) state.stations.push_back(cell_of(station));
  }
  return state;
}

// How many starts of a list were compared, and how many of them with their actions.
struct Compared {
  std::size_t starts = 0;
  std::size_t unique = 0;
};

class ItemDeliveryReference : public ItemDelivery {
 protected:
  void compare(const nlohmann::json& reference, Compared& compared) {
    for (const auto& env : reference.at("mdps")) {
      const auto m = env.at("env_idx").get<std::size_t>();
      const Mdp& mdp = domain.mdp(MdpIndex{m});
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_EQ(mdp.has_feature(k), env.at("reward_features_present").at(k).get<bool>());
      }
      for (const auto& start : env.at("starts")) {
        const auto s = domain.map()->find_state(MdpIndex{m}, state_of(start.at("state")));
        ASSERT_TRUE(s.has_value() && s->value() < mdp.num_states()) << m << " " << start.at("state");
        ++compared.starts;
        const IntegerVector& counts = plans[m].feature_counts[s->value()];
        const auto expected = start.at("features").get<std::vector<std::int64_t>>();
        ASSERT_EQ(counts, IntegerVector{std::span<const std::int64_t>{expected}}) << m << " " << start.at("state");
        ASSERT_NEAR(domain.weights().return_of(counts), start.at("return").get<double>(), 1e-9);
        ASSERT_EQ(counts[2], start.at("len").get<std::int64_t>());

        const auto path_here = canonical_trajectory(mdp, plans[m].canonical_choice, *s);
        const bool unique = std::all_of(path_here.states.begin(), path_here.states.end() - 1,
                                        [&](StateIndex on_path) { return num_optimal(m, on_path) == 1; });
        if (!unique) continue;
        ++compared.unique;
        std::vector<std::string> actions;
        for (const ActionIndex a : path_here.actions) actions.push_back(domain.action_names()[a.value()]);
        ASSERT_EQ(actions, start.at("actions").get<std::vector<std::string>>()) << m << " " << start.at("state");
      }
    }
  }
};

TEST_F(ItemDeliveryReference, AgreesOnEveryStart) {
  KITH_REQUIRE_GOLDEN(path, "domain_item_delivery.json");
  std::ifstream in{*path};
  Compared compared;
  compare(nlohmann::json::parse(in), compared);
  EXPECT_EQ(compared.starts, 9'312u);
  EXPECT_GT(compared.unique, 4'000u);  // else the comparison of actions would say little
}

TEST_F(ItemDeliveryReference, AgreesOnTwoStartsOfEveryMdp) {
  KITH_REQUIRE_GOLDEN(path, "item_delivery_starts.json");
  std::ifstream in{*path};
  Compared compared;
  compare(nlohmann::json::parse(in), compared);
  EXPECT_EQ(compared.starts, 128u);
  EXPECT_GT(compared.unique, 50u);
}

}  // namespace
}  // namespace kith
