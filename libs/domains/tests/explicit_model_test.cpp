// Explicit models in all layouts: what is read, what is left out, what it is called.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <random>
#include <regex>
#include <set>
#include <stdexcept>

#include "kith/core/error.hpp"
#include "kith/mdp/planner.hpp"
#include "models_under_test.hpp"
#include "scratch_folder.hpp"
#include "value_iteration.hpp"

namespace kith {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(ExplicitModel, IsReadFromTables) {
  const Domain domain = sound_model(kIceCsv);
  EXPECT_FALSE(domain.map().has_value());
  EXPECT_EQ(domain.num_mdps(), 1u);
  EXPECT_THAT(domain.action_names(), ElementsAre("go", "creep"));
  EXPECT_THAT(domain.feature_names(), ElementsAre("slip", "step"));
  const Mdp& mdp = domain.mdp(kFirst);
  EXPECT_EQ(mdp.num_states(), 2u);
  EXPECT_EQ(mdp.num_terminals(), 1u);
  EXPECT_FALSE(mdp.is_deterministic());
  EXPECT_FALSE(domain.is_exact());
  EXPECT_THAT(domain.starts(kFirst), ElementsAre(StateIndex{0}, StateIndex{1}));
  EXPECT_EQ(domain.initial_state(kFirst), StateIndex{0});
  EXPECT_EQ(domain.state_name(kFirst, StateIndex{1}), "on the ice");
  EXPECT_EQ(domain.state_name(kFirst, StateIndex{2}), "ashore");
  EXPECT_THROW((void)domain.state_name(kFirst, StateIndex{3}), std::invalid_argument);
}

TEST(ExplicitModel, HasNoActionThatSurelyChangesNothing) {
  const Domain domain = sound_model(kIceCsv);
  EXPECT_EQ(domain.mdp(kFirst).choices(StateIndex{0}).size(), 1u);  // creeping on the bank stays there
  const auto on_ice = domain.mdp(kFirst).choices(StateIndex{1});
  ASSERT_EQ(on_ice.size(), 2u);  // creeping on the ice may
  EXPECT_EQ(domain.mdp(kFirst).outcomes(on_ice[1])[0].next, StateIndex{1});
}

TEST(ExplicitModel, HasTheValuesWorkedOutByHand) {
  // Creeping: V(ice) = -1 + V(ice) / 2, so -2; going: -1 - 0.25 * 2 + 0.25 * V(bank), V(bank) = -1 + V(ice):
  // V(ice) = -1.75 + V(ice) / 4, so -7/3. Creeping is better.
  const Domain domain = sound_model(kIceCsv);
  const auto result = testing::value_iteration(domain.mdp(kFirst), domain.weights().raw);
  ASSERT_TRUE(result.converged);
  EXPECT_NEAR(result.values[1], -2.0, 1e-9);
  EXPECT_NEAR(result.values[0], -3.0, 1e-9);
}

TEST(ExplicitModel, NamesStatesByTheirValuesWithoutANameOfTheirOwn) {
  auto texts = kIceCsv;
  texts["states.csv"] = "state,terminal,x\n0,false,0\n1,false,1\n2,true,2\n";
  for (const auto& [from, to] : {std::pair{"bank", "0"}, {"ice", "1"}, {"shore", "2"}})
    texts["transitions.csv"] = std::regex_replace(texts["transitions.csv"], std::regex{from}, to);
  EXPECT_EQ(sound_model(texts).state_name(kFirst, StateIndex{1}), "x 1");
  texts["states.csv"] = "state,terminal\n0,false\n1,false\n2,true\n";
  EXPECT_EQ(sound_model(texts).state_name(kFirst, StateIndex{1}), "state 1");
}

// Two things may happen that lead to the same state.
TEST(ExplicitModel, KeepsOutcomesApartThatDifferInTheirFeatures) {
  const Domain domain = sound_model(
      edited(kIceCsv, "transitions.csv", "ice,go,shore,0.75,0,1\n", "ice,go,shore,0.5,0,1\nice,go,shore,0.25,1,1\n"));
  EXPECT_EQ(domain.mdp(kFirst).outcomes(domain.mdp(kFirst).choices(StateIndex{1})[0]).size(), 3u);
}

const char* const kTwoMdps = R"(mdp,state,action,next,probability,slip,step
dry,bank,go,ice,1,0,1
dry,ice,go,shore,1,0,1
wet,bank,go,ice,1,0,1
wet,ice,go,shore,0.5,0,1
wet,ice,go,bank,0.5,1,1
)";

TEST(ExplicitModel, HoldsSeveralMdpsThatShareStates) {
  auto texts = kIceCsv;
  texts["transitions.csv"] = kTwoMdps;
  const Domain domain = sound_model(texts);
  ASSERT_EQ(domain.num_mdps(), 2u);
  EXPECT_EQ(domain.describe_world(kFirst), "dry");
  EXPECT_EQ(domain.describe_world(MdpIndex{1}), "wet");
  EXPECT_TRUE(domain.present_things(kFirst).empty());
  EXPECT_EQ(domain.num_starts(), 4u);
  EXPECT_TRUE(domain.mdp(kFirst).is_deterministic());
  EXPECT_FALSE(domain.mdp(kFirst).has_feature(0));
  EXPECT_TRUE(domain.mdp(MdpIndex{1}).has_feature(0));
}

TEST(ExplicitModel, HoldsMdpsWithStatesOfTheirOwn) {
  auto texts = kIceCsv;
  texts["states.csv"] =
      "mdp,state,terminal\ndry,bank,false\ndry,ice,false\ndry,shore,true\nwet,bank,false\nwet,ice,false\nwet,shore,"
      "true\n";
  texts["transitions.csv"] = kTwoMdps;
  const Domain domain = sound_model(texts);
  ASSERT_EQ(domain.num_mdps(), 2u);
  EXPECT_EQ(domain.dissimilarity({kFirst, StateIndex{0}}, {MdpIndex{1}, StateIndex{0}}), 1);
  EXPECT_EQ(domain.dissimilarity({kFirst, StateIndex{0}}, {MdpIndex{1}, StateIndex{1}}), 3);
}

TEST(ExplicitModel, ComparesStatesByTheirVariables) {
  const Domain domain = sound_model(edited(kIceCsv, "states.csv", "true,1", "true,5"));
  EXPECT_EQ(domain.dissimilarity({kFirst, StateIndex{0}}, {kFirst, StateIndex{1}}), 10);
  EXPECT_EQ(domain.dissimilarity({kFirst, StateIndex{1}}, {kFirst, StateIndex{1}}), 0);
  EXPECT_EQ(domain.complexity({kFirst, StateIndex{1}}), 0);
  EXPECT_THROW((void)domain.complexity({kFirst, StateIndex{2}}), std::invalid_argument);
}

TEST(ExplicitModel, HasNoMap) {
  const Domain domain = sound_model(kIceCsv);
  EXPECT_FALSE(domain.map().has_value());
  EXPECT_TRUE(domain.optional_groups().empty());
}

// A hole in the ice that the robot never gets out of, unless it is the end.
ModelTexts with_hole(const std::string& terminal) {
  auto texts = edited(kIceCsv, "states.csv", "shore,", "hole,in the hole," + terminal + ",false,9\nshore,");
  return edited(texts, "transitions.csv", "ice,go,bank,0.25,1,1\n",
                "ice,go,hole,0.25,1,1\n" + std::string{terminal == "true" ? "" : "hole,go,hole,1,0,1\n"});
}

TEST(ExplicitModel, LeavesOutStatesWithoutAnEndAndWhatMayLeadThere) {
  const DomainReading reading = read_model_texts(with_hole("false"));
  ASSERT_TRUE(reading.domain);
  EXPECT_THAT(reading.diagnostics, ::testing::Contains(::testing::Field(&Diagnostic::id, "W0205")));
  EXPECT_EQ(reading.domain->mdp(kFirst).choices(StateIndex{1}).size(), 1u);  // creeping
  EXPECT_EQ(sound_model(with_hole("true")).mdp(kFirst).choices(StateIndex{1}).size(), 2u);
}

// A random process as sets: per state and action the states that may come next. The last state is terminal.
using Sets = std::vector<std::vector<std::set<std::size_t>>>;

Sets random_sets(std::mt19937& random) {
  Sets sets(2 + random() % 6);
  for (std::size_t s = 0; s + 1 < sets.size(); ++s) {
    sets[s].resize(1 + random() % 3);
    for (auto& next : sets[s])
      for (std::size_t k = 0; k < 1 + random() % 2; ++k) next.insert(random() % sets.size());
  }
  return sets;
}

bool is_within(const std::set<std::size_t>& part, const std::set<std::size_t>& whole) {
  return std::includes(whole.begin(), whole.end(), part.begin(), part.end());
}

// Slowly, by the definition: the largest set of states from which an end can be reached inside the set, by actions
// that never leave it. The end is in it.
std::set<std::size_t> states_that_can_surely_end(const Sets& sets) {
  const std::size_t end = sets.size() - 1;
  std::set<std::size_t> all;
  for (std::size_t s = 0; s <= end; ++s) all.insert(s);
  while (true) {
    std::set<std::size_t> reach{end};
    for (std::size_t round = 0; round < sets.size(); ++round) {
      for (std::size_t s = 0; s < end; ++s) {
        for (const auto& next : sets[s]) {
          const bool helps = std::any_of(next.begin(), next.end(), [&](std::size_t t) { return reach.contains(t); });
          if (all.contains(s) && is_within(next, all) && helps) reach.insert(s);
        }
      }
    }
    if (reach == all) return all;
    all = reach;
  }
}

ModelTexts texts_of(const Sets& sets) {
  auto texts = kIceCsv;
  texts["states.csv"] = "state,terminal\n";
  texts["transitions.csv"] = "state,action,next,probability,slip,step\n";
  for (std::size_t s = 0; s < sets.size(); ++s) {
    texts["states.csv"] += std::to_string(s) + (s + 1 == sets.size() ? ",true\n" : ",false\n");
    for (std::size_t a = 0; a < sets[s].size(); ++a) {
      for (const std::size_t next : sets[s][a]) {
        texts["transitions.csv"] += std::to_string(s) + ",a" + std::to_string(a) + "," + std::to_string(next) + "," +
                                    std::to_string(1.0 / static_cast<double>(sets[s][a].size())) + ",0,1\n";
      }
    }
  }
  return texts;
}

TEST(ExplicitModel, KeepsExactlyTheStatesThatCanSurelyEnd) {
  std::mt19937 random{7};
  std::size_t left_out = 0;
  for (int i = 0; i < 400; ++i) {
    const Sets sets = random_sets(random);
    const auto kept = states_that_can_surely_end(sets);
    const auto reading = read_model_texts(texts_of(sets));
    left_out += sets.size() - kept.size();
    ASSERT_EQ(reading.domain.has_value(), kept.size() > 1) << texts_of(sets)["transitions.csv"];
    if (!reading.domain) continue;
    const Mdp& mdp = reading.domain->mdp(kFirst);
    ASSERT_EQ(mdp.num_states() + 1, kept.size()) << texts_of(sets)["transitions.csv"];
    auto s = kept.begin();
    for (std::size_t number = 0; number < mdp.num_states(); ++number, ++s) {
      const auto& actions = sets[*s];
      const auto expected = std::count_if(actions.begin(), actions.end(), [&](const auto& next) {
        return is_within(next, kept) && next != std::set<std::size_t>{*s};
      });
      ASSERT_EQ(mdp.choices(StateIndex{number}).size(), static_cast<std::size_t>(expected));
    }
  }
  EXPECT_GT(left_out, 100u);
}

TEST(ExplicitModel, LeavesOutWhatCannotBeReachedFromAStart) {
  auto texts = edited(kIceCsv, "states.csv", "shore,", "island,on an island,false,false,9\nshore,");
  texts["transitions.csv"] += "island,go,bank,1,0,1\n";
  const DomainReading reading = read_model_texts(texts);
  ASSERT_TRUE(reading.domain);
  EXPECT_EQ(reading.diagnostics.at(0).id, "W0204");
  EXPECT_EQ(reading.domain->mdp(kFirst).num_states(), 2u);
}

TEST(ExplicitModel, ScalesProbabilitiesThatWereRounded) {
  auto texts = edited(kIceCsv, "transitions.csv", "0.75", "0.7500001");
  const Domain domain = sound_model(texts);
  const auto outcomes = domain.mdp(kFirst).outcomes(domain.mdp(kFirst).choices(StateIndex{1})[0]);
  EXPECT_NEAR(outcomes[0].probability + outcomes[1].probability, 1.0, 1e-15);
}

TEST(ExplicitModel, IsFoundBesideItsDomainFile) {
  const testing::ScratchFolder folder;
  for (const auto& [name, text] : kIceCsv) std::ofstream{folder / name} << text;
  EXPECT_EQ(load_domain((folder / "domain.toml").string()).num_starts(), 2u);
  const auto reading = read_domain(folder / "domain.toml");
  ASSERT_EQ(reading.files.size(), 2u);
  EXPECT_EQ(reading.files[0].name, "states.csv");
  EXPECT_EQ(reading.files[1].text, kIceCsv.at("transitions.csv"));
  std::ofstream{folder / "states.csv"} << "state,terminal\nbank,maybe\n";
  try {
    (void)load_domain((folder / "domain.toml").string());
    FAIL() << "'maybe' is no boolean";
  } catch (const Error& error) {
    EXPECT_EQ(error.diagnostics().at(0).file, (folder / "states.csv").string());
    EXPECT_EQ(error.diagnostics().at(0).line, 2u);
    EXPECT_EQ(error.diagnostics().at(0).column, 6u);
  }
}

// As on a map: from s two steps count as much as one that slips once.
TEST(ExplicitModel, WarnsOfEquallyGoodPaths) {
  for (const std::string slip : {"1", "2"}) {
    ModelTexts texts = kIceCsv;
    auto& domain = texts.at("domain.toml");
    domain.replace(domain.find("slip = -2"), 9, "slip = -1");
    texts["transitions.csv"] = "state,action,next,probability,slip,step\nbank,go,ice,1,0,1\nbank,jump,shore,1," + slip +
                               ",1\nice,go,shore,1,0,1\n";
    std::vector<DomainFile> files;
    for (const auto& [name, text] : texts) files.push_back({name, text});
    const auto reading = parse_domain(domain, "domain.toml", {}, {.known = files});
    ASSERT_TRUE(reading.domain);
    ASSERT_EQ(reading.diagnostics.size(), slip == "1" ? 1u : 0u);
    if (slip == "1") {
      EXPECT_EQ(reading.diagnostics.front().id, "W0302");
    }
  }
}

}  // namespace
}  // namespace kith
