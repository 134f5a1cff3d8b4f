#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "discounted_domains.hpp"
#include "kith/core/error.hpp"
#include "kith/explain/curriculum.hpp"
#include "kith/explain/question.hpp"
#include "kith/explain/runs.hpp"
#include "kith/explain/target.hpp"
#include "kith/explain/words.hpp"

namespace kith {
namespace {

using testing::discounted_domain;
using ::testing::HasSubstr;
using testing::kDiscounts;
using ::testing::StartsWith;

// What somebody can look at: at least one action, and an end or a round.
void expect_shown(const Domain& domain, MdpIndex world, const Trajectory& path) {
  ASSERT_GE(path.actions.size(), 1U);
  ASSERT_NE(path.repeats_from.has_value(), domain.mdp(world).is_terminal(path.states.back()));
  const auto text = actions_text(domain, world, path);
  EXPECT_EQ(text.find(", and so on: it ") != std::string::npos, path.repeats_from.has_value()) << text;
}

void expect_contrast(const Atlas& atlas, const Contrast& contrast) {
  const auto world = atlas.id(contrast.start).mdp;
  expect_shown(atlas.domain(), world, contrast.robot);
  expect_shown(atlas.domain(), world, contrast.alternative);
  EXPECT_FALSE(first_difference(contrast.robot, atlas.trajectory(contrast.start)));
  ASSERT_LT(contrast.decisive, contrast.robot.actions.size());
  if (!atlas.domain().mdp(world).is_deterministic()) return;  // there both may take the same actions
  ASSERT_LT(contrast.decisive, contrast.alternative.actions.size());
  if (const auto parting = first_difference(contrast.robot, contrast.alternative)) {
    EXPECT_EQ(contrast.decisive, *parting);
  }
}

// Whatever is refused is refused with a reason.
template <typename Action>
bool is_done(const Action& action) {
  try {
    action();
    return true;
  } catch (const Error& error) {
    EXPECT_FALSE(error.diagnostics().empty()) << error.what();
    return false;
  }
}

void expect_taught_and_found(const std::string& name, std::span<const double> discounts) {
  std::size_t taught = 0, answered = 0;
  for (const double discount : discounts) {
    SCOPED_TRACE(discount);
    const Atlas atlas{discounted_domain(name, discount)};
    taught += is_done([&] {
      const auto curriculum = make_curriculum(atlas);
      for (const auto& component : curriculum.components) {
        for (const auto& shown : component.demonstrations) expect_contrast(atlas, shown.contrast);
        for (const auto& test : component.tests)
          expect_shown(atlas.domain(), atlas.id(test.start).mdp, atlas.trajectory(test.start));
      }
    });
    for (const auto& isolated : isolated_constraints(atlas)) {
      for (const auto purpose : {Purpose::kTeach, Purpose::kTest}) {
        const auto start = simplest_isolating(atlas, isolated.constraint, purpose);
        if (!start) continue;
        if (const auto contrast = contrast_for(atlas, *start, isolated.constraint)) expect_contrast(atlas, *contrast);
      }
    }
    std::vector<std::string> questions{"what does it do", "what does it do in world 0"};
    for (const auto& feature : atlas.domain().feature_names()) {
      for (const char* form : {"when ", "where ", "why ", "how much ", "why no "}) questions.push_back(form + feature);
    }
    for (const auto& question : questions) {
      answered += is_done([&] {
        for (const auto& example : answer_question(atlas, question).examples)
          expect_shown(atlas.domain(), atlas.id(example.start).mdp, example.path);
      });
    }
    if (::testing::Test::HasFatalFailure()) return;
  }
  EXPECT_GE(taught, 1U);
  EXPECT_GE(answered, 8U);
}

class EndlessRobots : public ::testing::TestWithParam<std::string> {};

TEST_P(EndlessRobots, AreTaughtAskedAboutAndFound) { expect_taught_and_found(GetParam(), kDiscounts); }

// The night has the others: all questions about one of them take up to ten seconds.
INSTANTIATE_TEST_SUITE_P(BuiltIn, EndlessRobots, ::testing::ValuesIn(testing::small_domain_names()),
                         [](const auto& tested) { return testing::test_name(tested.param); });

TEST(EndlessRobotsSlow, InLargeDomainsAreTaughtAskedAboutAndFound) {
  for (const auto name : testing::kLargeDomains) {
    SCOPED_TRACE(name);
    expect_taught_and_found(std::string{name}, kDiscounts);
  }
}

TEST(EndlessRobot, AreSaidToMissWhatWouldEndTheirPath) {
  const std::vector<std::pair<std::string, std::string>> kEnds{{"item-delivery", "never delivers the parcel"},
                                                               {"rescue-floor", "never delivers everything"},
                                                               {"colored-tiles", "never reaches the goal"}};
  for (const auto& [name, end] : kEnds) {
    const Atlas atlas{discounted_domain(name, 0.3)};
    std::size_t endless = 0;
    for (std::size_t i = 0; i < atlas.num_states() && endless < 100; ++i) {
      const auto world = atlas.id(StartIndex{i}).mdp;
      const auto path = atlas.trajectory(StartIndex{i});
      if (!path.repeats_from) {
        EXPECT_EQ(never_in_words(atlas.domain(), world, path), "");
        continue;
      }
      ++endless;
      const auto map = *atlas.domain().map();
      bool moves = false;
      for (auto t = *path.repeats_from; t < path.actions.size(); ++t)
        moves = moves || map.state(world, path.states[t]).robot != map.state(world, path.states.back()).robot;
      const std::string start = moves ? "it " : "it stays where it is and ";
      EXPECT_EQ(never_in_words(atlas.domain(), world, path), start + end);
    }
    EXPECT_GE(endless, 1U) << name;
  }
}

TEST(EndlessRobot, HaveTheirCycleWrittenOnce) {
  const Atlas atlas{discounted_domain("item-delivery", 0.7)};
  const auto& domain = atlas.domain();
  for (std::size_t i = 0; i < atlas.num_states(); ++i) {
    const auto path = atlas.trajectory(StartIndex{i});
    if (!path.repeats_from || *path.repeats_from == 0) continue;
    auto way_in = path.actions, cycle = path.actions;
    way_in.resize(*path.repeats_from);
    cycle.erase(cycle.begin(), cycle.begin() + static_cast<std::ptrdiff_t>(*path.repeats_from));
    const auto world = atlas.id(StartIndex{i}).mdp;
    EXPECT_EQ(actions_text(domain, world, path), actions_text(domain, way_in) + ", " + actions_text(domain, cycle) +
                                                     ", and so on: " + never_in_words(domain, world, path));
    return;
  }
  FAIL() << "no way in";
}

}  // namespace
}  // namespace kith
