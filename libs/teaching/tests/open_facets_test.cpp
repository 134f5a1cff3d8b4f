// What was said to be taught was shown, and nothing that could be shown is left out.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "domain_texts.hpp"
#include "kith/domains/domain_file.hpp"
#include "kith/teaching/session.hpp"
#include "robots_answers.hpp"

namespace kith {
namespace {

Domain domain_of(const std::string& name) {
  if (name != "hospital" && name != "open") return load_domain(name);
  return *parse_domain(name == "hospital" ? testing::kHospital : testing::kToAndFro, name).domain;
}

const Atlas& atlas_of(const std::string& name) {
  static std::map<std::string, Atlas> made;
  const auto found = made.find(name);
  return found != made.end() ? found->second : made.emplace(name, Atlas{domain_of(name)}).first->second;
}

TeachingOptions options_with(std::size_t counterfactuals) {
  TeachingOptions options;
  options.filter.particles = 200;
  options.counterfactuals = counterfactuals;
  return options;
}

Session session_of(TeachingCache& cache, std::string_view strategy, const TeachingOptions& options,
                   std::uint64_t seed) {
  const RandomStream root{seed};
  std::vector<RandomStream> persons{root.split("first")};
  if (strategy != kBaseline) persons.push_back(root.split("second"));
  return {cache, options, strategy_named(strategy), std::move(persons), root.split("teacher")};
}

// Teaches people who answer as the robot would.
void teach_right(Session& session, TeachingCache& cache) {
  while (session.propose(cache)) {
    const std::vector<std::vector<Answer>> answers(session.num_members(), testing::robots_answers(session));
    session.submit(answers);
  }
}

// Whether a constraint still cuts anything worth mentioning off a region; see Regions::effect().
bool cuts(TeachingCache& cache, const ConstraintSet& region, const HalfSpace& constraint) {
  const std::vector<HalfSpace> one{constraint};
  return cache.regions().effect(cache.regions().minimal(region), cache.numbers_of(one)).gain > 1.0 + 1e-6;
}

// The prior and all that demonstrations of a session showed.
ConstraintSet all_shown(const Session& session, TeachingCache& cache) {
  auto shown = cache.atlas().prior();
  for (const auto& period : session.history()) {
    for (const auto& one : period.lesson.demonstrations) shown |= cache.numbers_of(one.half_spaces);
  }
  return shown;
}

// Those that choose demonstrations with UnitSelector::for_belief().
constexpr const char* kForBeliefs[] = {"baseline", "individual-low", "individual-high", "common", "joint"};

// Whatever is examined, demonstrations have shown before, with however few counterfactuals; and nothing is skipped that
// could be shown.
void expect_what_is_examined_was_shown(const std::string& domain, std::size_t counterfactuals, std::uint64_t seed) {
  const Atlas& atlas = atlas_of(domain);
  for (const auto* strategy : kForBeliefs) {
    TeachingCache cache{atlas};
    auto session = session_of(cache, strategy, options_with(counterfactuals), seed);
    teach_right(session, cache);
    const auto where = domain + ", " + strategy + ", seed " + std::to_string(seed);
    auto shown = atlas.prior();
    for (const auto& period : session.history()) {
      for (const auto& one : period.lesson.demonstrations) shown |= cache.numbers_of(one.half_spaces);
      for (const auto& test : period.lesson.tests) {
        for (const auto& facet : test.covered) {
          EXPECT_FALSE(cuts(cache, shown, facet)) << where << ": " << to_string(facet.normal());
        }
      }
    }
    EXPECT_EQ(session.status(), SessionStatus::kComplete) << where;  // what was skipped is implied by the lessons
    for (std::size_t k = 0; k < session.components().size(); ++k) {
      ASSERT_NE(session.components()[k], ComponentStatus::kOpen) << where;
      if (session.components()[k] == ComponentStatus::kLearned && atlas.find_tables()) continue;
      for (const auto& facet : atlas.constraints().half_spaces(atlas.knowledge_components()[k].constraints)) {
        EXPECT_FALSE(cuts(cache, shown, facet)) << where << ", component " << k << ": " << to_string(facet.normal());
      }
    }
  }
}

TEST(OpenFacets, WhatIsExaminedWasShown) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    for (const std::size_t n : {1u, 2u, 8u}) expect_what_is_examined_was_shown("item-delivery", n, seed);
  }
}

TEST(OpenFacets, WhatIsExaminedWasShownWithoutTables) {
  for (const std::uint64_t seed : {1u, 2u}) {
    for (const std::size_t n : {1u, 8u}) expect_what_is_examined_was_shown("hospital", n, seed);
  }
}

class OpenFacetsSlow : public ::testing::TestWithParam<const char*> {};
TEST_P(OpenFacetsSlow, WhatIsExaminedWasShown) {
  for (const std::size_t n : {1u, 8u}) expect_what_is_examined_was_shown(GetParam(), n, 1);
}
INSTANTIATE_TEST_SUITE_P(BuiltIn, OpenFacetsSlow,
                         ::testing::Values("colored-tiles", "skateboard", "two-goals", "cookie-crumb", "icy-crossing",
                                           "rescue-floor", "navigation", "warehouse"),
                         [](const auto& domain) {
                           std::string name{domain.param};
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

// With any seed: people count for the robot, and somebody is shown that.
TEST(OpenFacets, PeopleInTheHospitalAreTaughtWithEverySeed) {
  const Atlas& atlas = atlas_of("hospital");
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    TeachingCache cache{atlas};
    auto session = session_of(cache, "common", options_with(8), seed);
    teach_right(session, cache);
    EXPECT_EQ(session.status(), SessionStatus::kComplete) << seed;
    bool about_people = false;
    for (const auto& period : session.history()) {
      for (const auto& one : period.lesson.demonstrations) {
        for (const auto& shown : one.half_spaces) about_people = about_people || shown.normal()[2] != 0;
      }
    }
    EXPECT_TRUE(about_people) << seed;
  }
}

// Every strategy of the registry: a component is skipped only if nothing that could be shown cuts the region any
// further.
TEST(OpenFacets, NoStrategySkipsWhatCouldBeShown) {
  for (const auto* domain : {"item-delivery", "hospital"}) {
    for (const auto& kind : strategy_kinds()) {
      for (const std::uint64_t seed : {1u, 2u}) {
        TeachingCache cache{atlas_of(domain)};
        auto options = options_with(1);
        options.filter.particles = 50;
        options.scaffold = Scaffold::kFeatures;
        auto session = session_of(cache, kind.name, options, seed);
        teach_right(session, cache);
        const auto shown = all_shown(session, cache);
        for (std::size_t k = 0; k < session.components().size(); ++k) {
          if (session.components()[k] != ComponentStatus::kSkipped) continue;
          const auto& component = cache.atlas().knowledge_components()[k];
          for (const auto& facet : cache.atlas().constraints().half_spaces(component.constraints)) {
            EXPECT_FALSE(cuts(cache, shown, facet)) << domain << ", " << kind.name << ", component " << k;
          }
        }
      }
    }
  }
}

// What a demonstration is said to convey, its path conveys to those for whom it was chosen.
TEST(OpenFacets, DemonstrationsShowWhatTheyAreSaidTo) {
  for (const auto* domain : {"item-delivery", "hospital"}) {
    for (const auto& kind : strategy_kinds()) {
      TeachingCache cache{atlas_of(domain)};
      auto session = session_of(cache, kind.name, options_with(1), 3);
      teach_right(session, cache);
      for (const auto& period : session.history()) {
        for (const auto& one : period.lesson.demonstrations) {
          std::vector<PolicyCellIndex> cells;
          for (const auto& weights : one.counterfactuals) cells.push_back(cache.behaviours().locate(weights));
          std::sort(cells.begin(), cells.end());
          auto conveyed = cache.behaviours().conveyed(one.start, cells);
          conveyed |= cache.atlas().one_step(one.start);  // to people who expect no end
          for (const auto& shown : one.half_spaces) {
            EXPECT_FALSE(cuts(cache, conveyed | cache.atlas().prior(), shown)) << domain << ", " << kind.name;
          }
        }
      }
    }
  }
}

TEST(OpenFacets, ALimitOfDemonstrationsHolds) {
  TeachingCache cache{atlas_of("item-delivery")};
  auto options = options_with(1);
  options.max_demonstrations = 1;
  auto session = session_of(cache, "common", options, 1);
  teach_right(session, cache);
  for (const auto& period : session.history()) EXPECT_EQ(period.lesson.demonstrations.size(), 1u);
}

// Whoever misses the only facet expects the robot to go round for ever.
TEST(OpenFacets, PeopleWhoExpectNoEndAreShownASingleDeviation) {
  TeachingCache cache{atlas_of("open")};
  auto session = session_of(cache, "common", options_with(8), 1);
  teach_right(session, cache);
  EXPECT_EQ(session.status(), SessionStatus::kComplete);
  ASSERT_EQ(session.periods(), 1u);
  const auto& shown = session.history().begin()->lesson.demonstrations;
  ASSERT_EQ(shown.size(), 1u);
  EXPECT_TRUE(shown.front().completes);
  EXPECT_EQ(shown.front().half_spaces, (std::vector<HalfSpace>{HalfSpace{IntegerVector{-1, -2}}}));
}

// Nothing shows in the worlds without the goal that riding costs something: whoever learns from other lessons that it
// does has learned everything, whoever is right before that has not.
TEST(SessionStatus, SaysWhetherLessonsImplyWhatWasSkipped) {
  const Atlas& atlas = atlas_of(KITH_SOURCE_DIR "/domains/lee2021_skateboard.toml");
  std::map<SessionStatus, int> times;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    TeachingCache cache{atlas};
    auto session = session_of(cache, kBaseline, options_with(8), seed);
    teach_right(session, cache);
    ASSERT_EQ(session.components().front(), ComponentStatus::kSkipped);
    bool is_open = false;
    auto taught = atlas.prior();
    for (const auto& period : session.history()) taught |= cache.numbers_of(period.lesson.taught);
    for (const auto& facet : atlas.constraints().half_spaces(atlas.knowledge_components().front().constraints)) {
      is_open = is_open || cuts(cache, taught, facet);
    }
    EXPECT_EQ(session.status(), is_open ? SessionStatus::kSkipped : SessionStatus::kComplete) << seed;
    ++times[session.status()];
  }
  EXPECT_GE(times[SessionStatus::kSkipped], 1);
  EXPECT_GE(times[SessionStatus::kComplete], 1);
}

TEST(SessionStatus, LeavesOutWhatIsNotTaughtByDesign) {
  EXPECT_EQ(name_of(SessionStatus::kSkipped), "skipped");
  auto alone = options_with(8);
  alone.scaffold = Scaffold::kNone;
  TeachingCache delivery{atlas_of("item-delivery")};
  auto last = session_of(delivery, "common", alone, 1);
  teach_right(last, delivery);
  EXPECT_EQ(last.components().front(), ComponentStatus::kSkipped);
  EXPECT_EQ(last.status(), SessionStatus::kComplete);
}

}  // namespace
}  // namespace kith
