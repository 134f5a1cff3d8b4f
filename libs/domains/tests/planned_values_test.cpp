// What is planned for a domain has the values that an independent program finds for it.
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "domains_under_test.hpp"
#include "kith/mdp/behaviour.hpp"
#include "models_under_test.hpp"
#include "scratch_folder.hpp"

namespace kith {
namespace {

// A line for every outcome: state, action, probability, next state, reward.
std::string outcomes_of(const Domain& domain, MdpIndex m) {
  const Mdp& mdp = domain.mdp(m);
  std::ostringstream lines;
  lines.precision(17);
  for (StateIndex s{0}; s.value() < mdp.num_states(); ++s) {
    for (const Choice& choice : mdp.choices(s)) {
      for (const Outcome& outcome : mdp.outcomes(choice)) {
        double reward = 0.0;
        for (std::size_t k = 0; k < domain.num_features(); ++k)
          reward += domain.weights().raw[k] * mdp.features(outcome)[k];
        lines << s.value() << " " << choice.action.value() << " " << outcome.probability << " " << outcome.next.value()
              << " " << reward << "\n";
      }
    }
  }
  return lines.str();
}

// What the independent program makes of it; nothing where that fails.
std::optional<std::vector<double>> solved(const Domain& domain, MdpIndex m) {
  const testing::ScratchFolder folder;
  const auto file = (folder.path() / "mdp.txt").string();
  std::ofstream{file} << outcomes_of(domain, m);
  const Mdp& mdp = domain.mdp(m);
  const auto command = std::string{"python3 '"} + KITH_SOURCE_DIR + "/tests/models/solve_mdp.py' '" + file + "' " +
                       std::to_string(mdp.num_states() + mdp.num_terminals()) + " " + std::to_string(mdp.discount());
  FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return std::nullopt;
  std::vector<double> values;
  std::array<char, 256> line{};
  while (std::fgets(line.data(), line.size(), pipe) != nullptr) values.push_back(std::strtod(line.data(), nullptr));
  return pclose(pipe) == 0 ? std::optional{values} : std::nullopt;
}

void expect_equal_values(const Domain& domain, MdpIndex m) {
  const auto behaviour = behave(domain.mdp(m), domain.weights().raw, {.scale = domain.count_scale()});
  ASSERT_TRUE(behaviour);
  const auto values = solved(domain, m);
  ASSERT_TRUE(values);
  ASSERT_EQ(values->size(), behaviour->values.size());
  for (std::size_t s = 0; s < values->size(); ++s) ASSERT_NEAR((*values)[s], behaviour->values[s], 1e-9) << s;
}

TEST(PlannedValues, AreThoseOfAnIndependentSolver) {
  if (std::system("python3 -c 'import sys' > /dev/null 2>&1") != 0) GTEST_SKIP() << "there is no Python here";
  expect_equal_values(sound_model(kIceCsv), kFirst);
  expect_equal_values(sound_model(edited(kIceCsv, "domain.toml", "discount = 1.0", "discount = 0.9")), kFirst);
  expect_equal_values(load_domain("icy-crossing"), MdpIndex{1});
  expect_equal_values(load_domain("item-delivery"), MdpIndex{63});
  const Domain tiles = sound_domain(kColoredTiles);
  expect_equal_values(tiles, MdpIndex{tiles.num_mdps() - 1});
  expect_equal_values(sound_domain(kSkateboard), MdpIndex{5});
}

}  // namespace
}  // namespace kith
