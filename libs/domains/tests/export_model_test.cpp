// Exports are read again, by kith and by an independent program that solves what it reads.
#include "kith/domains/export_model.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "domains_under_test.hpp"
#include "error_ids.hpp"
#include "kith/mdp/behaviour.hpp"
#include "models_under_test.hpp"

namespace kith {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class Exports : public ::testing::Test {
 protected:
  Exports() { fs::create_directories(folder_); }
  ~Exports() override {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }
  Exports(const Exports&) = delete;
  Exports& operator=(const Exports&) = delete;

  std::vector<ExportedFile> write(const Domain& domain, MdpIndex m, ModelFormat format, const std::string& name) {
    auto files = export_mdp(domain, m, format, name);
    for (const auto& file : files) std::ofstream{folder_ / file.name, std::ios::binary} << file.text;
    return files;
  }

  // What the independent program makes of a file; nothing where there is no Python.
  std::optional<std::vector<double>> solve(const std::string& arguments) const {
    const std::string script = std::string{KITH_SOURCE_DIR} + "/tests/models/solve_mdp.py";
    const std::string command = "cd '" + folder_.string() + "' && python3 '" + script + "' " + arguments;
    FILE* pipe = popen(command.c_str(), "r");
    if (pipe == nullptr) return std::nullopt;
    std::vector<double> values;
    std::array<char, 256> line{};
    while (std::fgets(line.data(), line.size(), pipe) != nullptr) values.push_back(std::strtod(line.data(), nullptr));
    return pclose(pipe) == 0 ? std::optional{values} : std::nullopt;
  }

  static bool has_python() { return std::system("python3 -c 'import json' > /dev/null 2>&1") == 0; }

  // Both exports, solved elsewhere.
  void expect_equal_values(const Domain& domain, MdpIndex m) {
    const auto behaviour = behave(domain.mdp(m), domain.weights().raw, {.scale = domain.count_scale()});
    ASSERT_TRUE(behaviour);
    const std::string discount = " " + std::to_string(domain.mdp(m).discount());
    write(domain, m, ModelFormat::kGymJson, "m.json");
    const auto prism = write(domain, m, ModelFormat::kPrism, "m");
    std::string rewards;
    for (std::size_t k = 0; k < domain.num_features(); ++k) {
      rewards += " '" + prism[3 + k].name + "=" + std::to_string(domain.weights().raw[k]) + "'";
    }
    for (const std::string& arguments : {"gym-json m.json" + discount, "prism m.tra" + discount + rewards}) {
      const auto values = solve(arguments);
      ASSERT_TRUE(values) << arguments;
      ASSERT_EQ(values->size(), behaviour->values.size()) << arguments;
      for (std::size_t s = 0; s < values->size(); ++s) {
        ASSERT_NEAR((*values)[s], behaviour->values[s], 1e-9) << arguments << ", state " << s;
      }
    }
  }

  fs::path folder_ = fs::temp_directory_path() / ("kith_export_test_" + std::to_string(getpid()));
};

Domain discounted_ice() { return sound_model(edited(kIceCsv, "domain.toml", "discount = 1.0", "discount = 0.9")); }

TEST_F(Exports, HaveTheSameValuesInAnIndependentSolver) {
  if (!has_python()) GTEST_SKIP() << "there is no Python here";
  expect_equal_values(sound_model(kIceCsv), kFirst);
  expect_equal_values(discounted_ice(), kFirst);
  expect_equal_values(sound_model(kIceGym), kFirst);
  const Domain grid = load_domain("item-delivery");
  expect_equal_values(grid, MdpIndex{63});
  const Domain tiles = sound_domain(kColoredTiles);
  expect_equal_values(tiles, MdpIndex{tiles.num_mdps() - 1});
  const Domain boards = sound_domain(kSkateboard);
  expect_equal_values(boards, MdpIndex{5});
}

// Two domains with one MDP each that are the same for planning and teaching.
void expect_equal(const Domain& a, MdpIndex m, const Domain& b) {
  const Mdp& one = a.mdp(m);
  const Mdp& two = b.mdp(kFirst);
  ASSERT_EQ(one.num_states(), two.num_states());
  ASSERT_EQ(one.num_terminals(), two.num_terminals());
  EXPECT_EQ(one.discount(), two.discount());
  EXPECT_EQ(a.weights().raw, b.weights().raw);
  EXPECT_EQ(a.feature_names(), b.feature_names());
  EXPECT_EQ(a.action_names(), b.action_names());
  EXPECT_EQ(a.prior(), b.prior());
  EXPECT_EQ(a.max_steps(), b.max_steps());
  EXPECT_EQ(a.starts(m), b.starts(kFirst));
  EXPECT_EQ(a.initial_state(m), b.initial_state(kFirst));
  for (std::size_t s = 0; s < one.num_states(); ++s) {
    const auto left = one.choices(StateIndex{s});
    const auto right = two.choices(StateIndex{s});
    ASSERT_EQ(left.size(), right.size());
    for (std::size_t c = 0; c < left.size(); ++c) {
      EXPECT_EQ(left[c].action, right[c].action);
      const auto from = one.outcomes(left[c]);
      const auto to = two.outcomes(right[c]);
      ASSERT_EQ(from.size(), to.size());
      for (std::size_t o = 0; o < from.size(); ++o) {
        EXPECT_EQ(from[o].next, to[o].next);
        EXPECT_DOUBLE_EQ(from[o].probability, to[o].probability);
        EXPECT_TRUE(std::ranges::equal(one.features(from[o]), two.features(to[o])));
      }
    }
  }
}

TEST_F(Exports, AreReadAgainAsTheSame) {
  const Domain grid = load_domain("item-delivery");
  const Domain boards = sound_domain(kSkateboard);
  const Domain ice = discounted_ice();
  const std::vector<std::pair<const Domain*, MdpIndex>> all{
      {&grid, MdpIndex{37}}, {&boards, MdpIndex{5}}, {&ice, kFirst}};
  for (const auto& [domain, m] : all) {
    write(*domain, m, ModelFormat::kPrism, "m");
    expect_equal(*domain, m, load_domain((folder_ / "m.toml").string()));
    write(*domain, m, ModelFormat::kGymJson, "g.json");
    const Domain again = load_domain((folder_ / "g.toml").string());
    expect_equal(*domain, m, again);
    EXPECT_EQ(again.state_name(kFirst, StateIndex{1}), domain->state_name(m, StateIndex{1}));
  }
}

TEST_F(Exports, SayWhatTheyAre) {
  const Domain ice = discounted_ice();
  const auto prism = export_mdp(ice, kFirst, ModelFormat::kPrism, "ice");
  ASSERT_EQ(prism.size(), 6u);
  EXPECT_EQ(prism[0].name, "ice.tra");
  EXPECT_THAT(prism[0].text, HasSubstr("3 4 6\n0 0 1 1 go\n"));
  EXPECT_EQ(prism[2].text, "0=\"init\" 1=\"deadlock\" 2=\"goal\" 3=\"start\"\n0: 0 3\n1: 3\n2: 2\n");
  EXPECT_EQ(prism[3].text, "# Reward structure \"slip\"\n# Transition rewards\n3 4 1\n1 0 0 1\n");
  const auto gym = export_mdp(ice, kFirst, ModelFormat::kGymJson, "ice.json")[0].text;
  EXPECT_THAT(gym, HasSubstr("\"1\":[[1.0,0,-7.0,false]]"));  // creeping on the bank: no action of the robot
  EXPECT_THROW((void)export_mdp(ice, MdpIndex{1}, ModelFormat::kPrism, "x"), std::invalid_argument);
}

}  // namespace
}  // namespace kith
