// Facts of the domains with more than three features, and of a large grid.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <map>
#include <set>

#include "domain_texts.hpp"
#include "domains_under_test.hpp"
#include "kith/mdp/behaviour.hpp"
#include "kith/mdp/planner.hpp"

namespace kith {
namespace {

Domain from_file(const std::string& name) { return load_domain(KITH_SOURCE_DIR "/domains/" + name + ".toml"); }

// What single deviations on the way from any start say about weights w with w_step = -1.
struct Said {
  std::set<IntegerVector> normals;
  std::size_t longest = 0;  // steps of an optimal path

  void look_at(const Mdp& mdp, const Behaviour& behaviour, StateIndex s) {
    std::size_t steps = 0;
    for (; !mdp.is_terminal(s); ++steps) {
      for (const Choice& choice : mdp.choices(s)) {
        const Outcome& outcome = mdp.outcomes(choice).front();
        const IntegerVector other = mdp.integer_features(outcome) + behaviour.counts[outcome.next.value()];
        const IntegerVector normal = behaviour.counts[s.value()] - other;
        if (!normal.is_zero()) normals.insert(primitive(normal));
      }
      s = mdp.outcomes(mdp.choices(s)[behaviour.choice[s.value()]]).front().next;
    }
    longest = std::max(longest, steps);
  }

  // Between what feature k is worth, in steps, by what concerns it and steps alone.
  [[nodiscard]] std::pair<double, double> bounds(std::size_t k) const {
    std::pair bounds{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
    for (const IntegerVector& normal : normals) {
      const std::size_t last = normal.size() - 1;
      IntegerVector rest = normal;
      rest[k] = rest[last] = 0;
      if (!rest.is_zero() || normal[k] == 0) continue;
      const double bound = static_cast<double>(normal[last]) / static_cast<double>(normal[k]);
      if (normal[k] > 0) bounds.first = std::max(bounds.first, bound);
      if (normal[k] < 0) bounds.second = std::min(bounds.second, bound);
    }
    return bounds;
  }
};

Said what_is_said(const Domain& domain) {
  Said said;
  for (MdpIndex m{0}; m.value() < domain.num_mdps(); ++m) {
    const auto behaviour = behave(domain.mdp(m), domain.weights().raw);
    EXPECT_TRUE(behaviour) << "MDP " << m.value();
    if (!behaviour) continue;
    for (const StateIndex s : domain.starts(m)) said.look_at(domain.mdp(m), *behaviour, s);
  }
  for (const IntegerVector& normal : said.normals) EXPECT_GE(dot(normal, domain.weights().integer), 0);
  return said;
}

std::map<std::size_t, int> sizes_of(const Domain& domain) {
  std::map<std::size_t, int> sizes;
  for (MdpIndex m{0}; m.value() < domain.num_mdps(); ++m) ++sizes[domain.mdp(m).num_states()];
  return sizes;
}

// Every feature by itself has a price between two bounds, and neither is met with equality.
void expect_every_feature_is_bounded(const Domain& domain, const Said& said) {
  for (std::size_t k = 0; k + 1 < domain.num_features(); ++k) {
    const auto [low, high] = said.bounds(k);
    EXPECT_LT(low, domain.weights().raw[k]) << domain.feature_names()[k];
    EXPECT_GT(high, domain.weights().raw[k]) << domain.feature_names()[k];
  }
}

TEST(Navigation, HasSixGroupsAndSevenFeatures) {
  const Domain domain = from_file("navigation");
  EXPECT_EQ(domain.num_mdps(), 64u);
  EXPECT_THAT(domain.feature_names(),
              ::testing::ElementsAre("gravel", "grass", "road", "recharge", "board", "car", "step"));
  // 24 cells; twice as many with the charger, three times with both vehicles, less where one cannot go everywhere.
  const auto sizes = sizes_of(domain);
  EXPECT_EQ(sizes.at(24), 8);
  EXPECT_EQ(sizes.begin()->first, 24u);
  EXPECT_EQ(sizes.rbegin()->first, 144u);
  EXPECT_EQ(domain.num_starts(), 4384u);
  EXPECT_TRUE(domain.is_exact());
}

TEST(Navigation, TeachesEveryFeature) {
  const Domain domain = from_file("navigation");
  const Said said = what_is_said(domain);
  EXPECT_EQ(said.longest, 15u);
  expect_every_feature_is_bounded(domain, said);
}

TEST(RescueFloor, HasSixteenWorldsOfAFewThousandStates) {
  const Domain domain = from_file("rescue_floor");
  EXPECT_EQ(domain.map()->width(), 24);
  EXPECT_EQ(domain.map()->height(), 16);
  EXPECT_EQ(domain.num_mdps(), 16u);
  EXPECT_EQ(domain.num_starts(), 480u);
  EXPECT_THAT(domain.map()->item_names(), ::testing::ElementsAre("medkit", "casualty"));
  EXPECT_EQ(domain.present_things(MdpIndex{0}).size(), 17u);
  std::size_t sum = 0;
  for (const auto& [size, number] : sizes_of(domain)) {
    EXPECT_GT(size, 1000u);
    EXPECT_LT(size, 5000u);
    sum += size * static_cast<std::size_t>(number);
  }
  EXPECT_EQ(sum, 44'636u);
}

TEST(RescueFloor, TeachesEveryFeature) {
  const Domain domain = from_file("rescue_floor");
  expect_every_feature_is_bounded(domain, what_is_said(domain));
}

TEST(Warehouse, ComesFromAnOccupancyGrid) {
  const Domain domain = load_domain("warehouse");
  EXPECT_EQ(domain.map()->width(), 60);
  EXPECT_EQ(domain.map()->height(), 40);
  EXPECT_EQ(domain.num_mdps(), 7u);
  EXPECT_EQ(domain.num_starts(), 84u);
  EXPECT_TRUE(domain.is_exact());
  const auto rows = domain.map()->draw(MdpIndex{0}, std::nullopt);
  EXPECT_EQ(rows[2].substr(0, 10), "########..") << "the office was never mapped";
  EXPECT_EQ(rows[37][2], 'S');
  const auto first = domain.map()->state(MdpIndex{0}, domain.initial_state(MdpIndex{0}));
  EXPECT_THAT(first.carried, ::testing::ElementsAre(true));
  EXPECT_EQ(from_file("warehouse").mdp(MdpIndex{6}).num_states(), domain.mdp(MdpIndex{6}).num_states());
}

TEST(Warehouse, TeachesEveryFeature) {
  const Domain domain = from_file("warehouse");
  expect_every_feature_is_bounded(domain, what_is_said(domain));
}

TEST(Warehouse, ConsistsOfThreeFiles) {
  EXPECT_EQ(read_domain(KITH_SOURCE_DIR "/domains/warehouse.toml").files.size(), 3u);
}

TEST(LargerDomains, AreReadWithoutWarnings) {
  for (const std::string name : {"navigation", "rescue_floor", "warehouse"}) {
    for (const Diagnostic& d : read_domain(KITH_SOURCE_DIR "/domains/" + name + ".toml").diagnostics) {
      ADD_FAILURE() << to_text(d);
    }
  }
}

TEST(IcyCrossing, IsBuiltInWithItsFiles) {
  const Domain domain = load_domain("icy-crossing");
  EXPECT_EQ(domain.num_mdps(), 3u);
  EXPECT_EQ(domain.num_starts(), from_file("icy_crossing").num_starts());
}

TEST(RescueFloor, PutsThingsDownOnlyWhereTheyBelong) {
  const Domain domain = from_file("rescue_floor");
  const MdpIndex m{15};
  std::size_t num_drops = 0;
  for (StateIndex s{0}; s.value() < domain.mdp(m).num_states(); ++s) {
    const GridState before = domain.map()->state(m, s);
    for (const Choice& choice : domain.mdp(m).choices(s)) {
      if (domain.action_names()[choice.action.value()] != "dropoff") continue;
      const GridState after = domain.map()->state(m, domain.mdp(m).outcomes(choice).front().next);
      for (std::size_t i = 0; i < 2; ++i) {
        if (!before.carried[i] || after.carried[i]) continue;
        EXPECT_EQ(domain.map()->content(m, after.items[i]).destination_of, domain.map()->item_names()[i]);
        ++num_drops;
      }
    }
  }
  EXPECT_GT(num_drops, 8u);
}

// side x side cells of rubble, mud and floor in stripes, from the lower left to the upper right corner.
std::string striped_grid(std::size_t side) {
  return testing::terrain_grid(side,
                               [](std::size_t x, std::size_t y) { return "..r.m.."[(3 * x + 5 * y + x * y) % 7]; });
}

// Validation plans in integers, behave() by label setting: neither knows of the other.
void expect_planned_right(std::size_t side) {
  const Domain domain = sound_domain(striped_grid(side));
  const Mdp& mdp = domain.mdp(MdpIndex{0});
  ASSERT_EQ(mdp.num_states(), side * side - 1);
  const auto behaviour = behave(mdp, domain.weights().raw);
  const ExactPlan plan = plan_exactly(mdp, domain.weights().integer);
  ASSERT_TRUE(behaviour && plan.solution);
  EXPECT_EQ(behaviour->choice, plan.solution->canonical_choice);
  EXPECT_EQ(behaviour->counts, plan.solution->feature_counts);
}

TEST(LargeGrid, IsPlannedAsInIntegers) { expect_planned_right(40); }
TEST(LargeGridSlow, IsPlannedAsInIntegers) { expect_planned_right(200); }

}  // namespace
}  // namespace kith
