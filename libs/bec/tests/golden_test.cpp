// The one-step constraints of item delivery against those of an independent
// program, start by start.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "golden.hpp"
#include "item_delivery.hpp"

namespace kith {
namespace {

using nlohmann::json;
using testing::item_delivery;

json read(const std::filesystem::path& path) {
  std::ifstream file{path};
  return json::parse(file);
}

// The reference describes a state as {agent, passenger, hotswap_station}.
GridState grid_state(const json& state) {
  const auto cell = [](const json& thing) { return Cell{thing.at("x"), thing.at("y")}; };
  const auto& agent = state.at("agent").at(0);
  GridState result;
  result.robot = cell(agent);
  result.items = {cell(state.at("passenger").at(0))};
  result.carried = {agent.at("has_passenger") == 1};
  if (state.contains("hotswap_station")) {
    for (const auto& station : state.at("hotswap_station")) result.stations.push_back(cell(station));
  }
  return result;
}

std::vector<HalfSpace> half_spaces_of(const json& rows) {
  std::vector<HalfSpace> result;
  for (const auto& row : rows) {
    result.emplace_back(
        IntegerVector{row[0].get<std::int64_t>(), row[1].get<std::int64_t>(), row[2].get<std::int64_t>()});
  }
  std::sort(result.begin(), result.end());
  return result;
}

std::string describe_start(std::size_t world, const GridState& state) {
  std::ostringstream text;
  text << "world " << world << ": robot (" << state.robot.x << ',' << state.robot.y << "), item (" << state.items[0].x
       << ',' << state.items[0].y << ')';
  return text.str();
}

TEST(GoldenItemDelivery, OneStepMinimalSetsAgreeWhereTheOptimumIsUnique) {
  KITH_REQUIRE_GOLDEN(domain_path, "domain_item_delivery.json");
  KITH_REQUIRE_GOLDEN(bec_path, "bec_item_delivery.json");
  const auto domain = read(*domain_path);
  const auto bec = read(*bec_path);
  const auto& atlas = item_delivery();
  std::size_t unique = 0;
  std::size_t others = 0;
  std::vector<std::string> different;
  for (std::size_t m = 0; m < atlas.domain().num_mdps(); ++m) {
    const auto& starts = domain.at("mdps").at(m).at("starts");
    const auto& sets = bec.at("mdps").at(m).at("starts");
    ASSERT_EQ(starts.size(), sets.size());
    for (std::size_t i = 0; i < starts.size(); ++i) {
      ASSERT_EQ(starts[i].at("traj_idx"), sets[i].at("traj_idx"));
      const auto s = atlas.domain().map()->find_state(MdpIndex{m}, grid_state(starts[i].at("state")));
      ASSERT_TRUE(s.has_value());
      const auto start = atlas.index({MdpIndex{m}, *s});
      const auto& counts = starts[i].at("features");
      ASSERT_EQ(
          atlas.feature_counts(start),
          (IntegerVector{counts[0].get<std::int64_t>(), counts[1].get<std::int64_t>(), counts[2].get<std::int64_t>()}));
      ASSERT_NEAR(atlas.domain().weights().return_of(atlas.feature_counts(start)), starts[i].at("return").get<double>(),
                  1e-12);
      const auto ours = atlas.constraints().half_spaces(atlas.one_step(start));
      const auto theirs = half_spaces_of(sets[i].at("trajectory_min_constraints"));
      if (atlas.is_unique(start)) {
        ++unique;
        ASSERT_EQ(ours, theirs) << "world " << m << ", start " << starts[i].at("state").dump();
      } else {
        ++others;
        if (ours != theirs) {
          different.push_back(describe_start(m, atlas.domain().map()->state(MdpIndex{m}, *s)));
        }
      }
    }
  }
  EXPECT_EQ(unique, 6182u);
  EXPECT_EQ(others, 3130u);
  // With several optimal paths the set depends on which one is taken; only these four starts show it.
  EXPECT_THAT(different,
              ::testing::ElementsAre("world 25: robot (1,1), item (2,3)", "world 25: robot (2,1), item (2,3)",
                                     "world 51: robot (3,1), item (3,3)", "world 51: robot (3,2), item (3,3)"));
}

TEST(GoldenItemDelivery, PolicyBecAgrees) {
  KITH_REQUIRE_GOLDEN(bec_path, "bec_item_delivery.json");
  const auto bec = read(*bec_path);
  const auto& atlas = item_delivery();
  EXPECT_EQ(atlas.policy_bec_half_spaces(), half_spaces_of(bec.at("min_BEC_constraints")));
  EXPECT_NEAR(atlas.policy_bec_area_sr(), bec.at("min_BEC_solid_angle").get<double>(), 1e-9);
}

}  // namespace
}  // namespace kith
