// Families of which only some worlds, and only some starts, are built.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <queue>
#include <set>

#include "domain_texts.hpp"
#include "domains_under_test.hpp"

namespace kith {
namespace {

using ::testing::ElementsAre;

// Two kinds of optional terrain, three cells each, and one more charger.
std::string with_family(const std::string& family) {
  return testing::map_domain("thin", "\"S.r.g.C\", \"..r.g..\", \"..r.g.G\"",
                             "\"r\" = { terrain = \"rubble\", optional = true }\n"
                             "\"g\" = { terrain = \"grass\", optional = true }\n"
                             "\"C\" = { station = \"charger\", optional = true }\n",
                             {{"rubble", "leave:rubble"}, {"charge", "leave:charger"}, {"step", "action"}},
                             "rubble = -2.5, charge = 1.5, step = -1", "", family + "\n");
}

std::vector<std::string> worlds_of(const Domain& domain) {
  std::vector<std::string> texts;
  for (MdpIndex m{0}; m.value() < domain.num_mdps(); ++m) {
    std::string text;
    for (const bool bit : domain.present_things(m)) text += bit ? '1' : '0';
    texts.push_back(text);
  }
  return texts;
}

TEST(Thinning, BeginsWithKindsAndPairsOfKindsAndEndsWithEverything) {
  const Domain domain = sound_domain(with_family("[family]\nworlds = 8\nseed = 3"));
  const auto masks = worlds_of(domain);
  ASSERT_EQ(masks.size(), 8u);
  EXPECT_THAT(std::vector(masks.begin(), masks.begin() + 7),
              ElementsAre("0000000", "1110000", "0001110", "0000001", "1111110", "1110001", "0001111"));
  EXPECT_EQ(masks[7], "1111111");
}

TEST(Thinning, DrawsEveryFurtherWorldOnceAndAlwaysTheSame) {
  const auto few = worlds_of(sound_domain(with_family("[family]\nworlds = 20\nseed = 3")));
  const auto more = worlds_of(sound_domain(with_family("[family]\nworlds = 40\nseed = 3")));
  const auto others = worlds_of(sound_domain(with_family("[family]\nworlds = 40\nseed = 4")));
  EXPECT_EQ(std::set(more.begin(), more.end()).size(), 40u);
  EXPECT_TRUE(std::equal(few.begin(), few.end() - 1, more.begin()));
  EXPECT_EQ(more.back(), "1111111");
  EXPECT_NE(more, others);
  EXPECT_THAT(std::vector(few.begin() + 7, few.end() - 1),
              ElementsAre("1011111", "1011110", "0110010", "0010110", "1001000", "1000000", "1000100", "1100011",
                          "0101000", "1010010", "0100101", "1010110"));
}

TEST(Thinning, BuildsEveryWorldWhereAllAreAskedFor) {
  const auto masks = worlds_of(sound_domain(with_family("[family]\nworlds = 128")));
  EXPECT_EQ(std::set(masks.begin(), masks.end()).size(), 128u);
  EXPECT_EQ(worlds_of(sound_domain(with_family("[family]\nworlds = 1"))), std::vector<std::string>{"0000000"});
}

TEST(Thinning, KeepsWhatAWorldIs) {
  const Domain all = sound_domain(with_family(""));
  const Domain some = sound_domain(with_family("[family]\nworlds = 24"));
  for (MdpIndex m{0}; m.value() < some.num_mdps(); ++m) {
    std::size_t index = 0;
    for (const bool bit : some.present_things(m)) index = 2 * index + (bit ? 1 : 0);
    const MdpIndex same{index};
    ASSERT_EQ(some.present_things(m), all.present_things(same));
    EXPECT_EQ(some.describe_world(m), all.describe_world(same));
    EXPECT_EQ(some.map()->draw(m, std::nullopt), all.map()->draw(same, std::nullopt));
    ASSERT_EQ(some.mdp(m).num_states(), all.mdp(same).num_states());
    for (StateIndex s{0}; s.value() < some.mdp(m).num_states(); ++s) {
      ASSERT_EQ(some.map()->state(m, s), all.map()->state(same, s));
      ASSERT_EQ(some.map()->find_state(m, some.map()->state(m, s)), s);
      ASSERT_EQ(some.complexity({m, s}), all.complexity({same, s}));
    }
    const StartId here{m, StateIndex{0}};
    const StartId there{MdpIndex{some.num_mdps() - 1}, StateIndex{3}};
    EXPECT_EQ(some.dissimilarity(here, there),
              all.dissimilarity({same, StateIndex{0}}, {MdpIndex{all.num_mdps() - 1}, StateIndex{3}}));
    EXPECT_EQ(some.map()->content(m, {3, 1}).terrain, all.map()->content(same, {3, 1}).terrain);
  }
}

TEST(Thinning, TellsSixtyFourThingsApart) {
  std::string rows;
  for (int y = 0; y < 8; ++y)
    rows += (y == 0 ? "\"" : ",\n\"") + std::string(8, 'r') + (y == 0 ? "S\"" : y == 7 ? "G\"" : ".\"");
  std::string text = with_family("[family]\nworlds = 100");
  const auto begin = text.find("rows = [") + 8;
  text.replace(begin, text.find("]", begin) - begin, rows);
  const Domain domain = sound_domain(text);
  EXPECT_EQ(domain.num_mdps(), 100u);
  const auto masks = worlds_of(domain);
  EXPECT_EQ(std::set(masks.begin(), masks.end()).size(), 100u);
  EXPECT_EQ(masks.front(), std::string(64, '0'));
  EXPECT_EQ(masks.back(), std::string(64, '1'));
  EXPECT_EQ(domain.dissimilarity({MdpIndex{0}, StateIndex{0}}, {MdpIndex{99}, StateIndex{0}}), 64);
}

// Steps from each state to the nearest of some, in transitions taken either way; by searching all pairs.
std::vector<int> steps_to(const Mdp& mdp, const std::vector<StateIndex>& from) {
  std::vector<int> steps(mdp.num_states(), -1);
  std::queue<std::size_t> queue;
  for (const StateIndex s : from) {
    steps[s.value()] = 0;
    queue.push(s.value());
  }
  for (; !queue.empty(); queue.pop()) {
    for (std::size_t s = 0; s < mdp.num_states(); ++s) {
      bool is_next = false;
      for (const auto& [a, b] : {std::pair{s, queue.front()}, std::pair{queue.front(), s}}) {
        for (const Choice& choice : mdp.choices(StateIndex{a})) {
          is_next = is_next || mdp.outcomes(choice).front().next == StateIndex{b};
        }
      }
      if (!is_next || steps[s] >= 0) continue;
      steps[s] = steps[queue.front()] + 1;
      queue.push(s);
    }
  }
  return steps;
}

TEST(Thinning, SpreadsStartsFarthestFirst) {
  const Domain domain = sound_domain(with_family("[family]\nstarts = 6"));
  EXPECT_EQ(domain.num_mdps(), 128u);
  EXPECT_EQ(domain.num_starts(), 6 * 128u);
  for (const std::size_t number : {0u, 77u, 127u}) {
    const MdpIndex m{number};
    std::vector<StateIndex> chosen{domain.initial_state(m)};
    while (chosen.size() < 6) {
      const auto steps = steps_to(domain.mdp(m), chosen);
      chosen.push_back(StateIndex{static_cast<std::size_t>(std::ranges::max_element(steps) - steps.begin())});
    }
    std::ranges::sort(chosen);
    EXPECT_EQ(domain.starts(m), chosen);
    EXPECT_EQ(domain.starts(m).front(), domain.initial_state(m));
  }
}

TEST(Thinning, StartsEverywhereWhereThereAreFewStates) {
  const Domain domain = sound_domain(with_family("[family]\nworlds = 2\nstarts = 1000"));
  for (MdpIndex m{0}; m.value() < 2; ++m) EXPECT_EQ(domain.starts(m).size(), domain.mdp(m).num_states());
  EXPECT_EQ(sound_domain(with_family("[family]\nstarts = 1")).starts(MdpIndex{5}), std::vector{StateIndex{0}});
}

}  // namespace
}  // namespace kith
