#include "kith/domains/judgement.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "domains_under_test.hpp"
#include "kith/core/distributions.hpp"

namespace kith {
namespace {

using Actions = std::vector<std::string>;

// Two equally good ways round the mud in the middle; the exit is two steps from the start's corner.
const std::string kTwoWays = R"(
schema = "kith.domain/1"
id = "two-ways"
[mdp]
actions = ["up", "down", "left", "right", "exit"]
[map]
rows = ["..G",
        ".m.",
        "S.."]
[map.legend]
"." = "floor"
"m" = { terrain = "mud" }
"S" = { start = true }
"G" = { goal = true }
[[feature]]
name = "goal"
when = "goal"
[[feature]]
name = "mud"
when = "enter:mud"
[[feature]]
name = "step"
when = "action"
[reward]
weights = { goal = 6, mud = -2.5, step = -0.5 }
normalize = "l1"
)";

ActionsJudgement judged(const Domain& domain, const Actions& actions) {
  return judge_actions(domain, MdpIndex{0}, actions);
}

TEST(Judgement, CallsEveryBestPathOptimalWhateverItsActions) {
  const Domain domain = sound_domain(kTwoWays);
  for (const Actions& actions : {Actions{"up", "up", "right", "right"}, Actions{"right", "right", "up", "up"}}) {
    const auto judgement = judged(domain, actions);
    EXPECT_EQ(judgement.outcome, ActionsOutcome::kFinished);
    EXPECT_TRUE(judgement.optimal);
    EXPECT_EQ(judgement.regret, 0.0);
    EXPECT_DOUBLE_EQ(judgement.earned, 4.0 / 9.0);
    EXPECT_EQ(judgement.feature_counts, (IntegerVector{1, 0, 4}));
    EXPECT_EQ(judgement.ignored, 0u);
  }
}

TEST(Judgement, MeasuresWhatAWorsePathLoses) {
  const Domain domain = sound_domain(kTwoWays);
  const auto mud = judged(domain, {"up", "right", "right", "up"});
  EXPECT_EQ(mud.outcome, ActionsOutcome::kFinished);
  EXPECT_FALSE(mud.optimal);
  EXPECT_DOUBLE_EQ(mud.regret, 2.5 / 9.0);
  const auto gone = judged(domain, {"exit"});
  EXPECT_EQ(gone.outcome, ActionsOutcome::kFinished);
  EXPECT_DOUBLE_EQ(gone.earned, -0.5 / 9.0);
  EXPECT_DOUBLE_EQ(gone.regret, 4.5 / 9.0);
}

TEST(Judgement, DoesNotTakeStoppingShortForAnAnswer) {
  const Domain domain = sound_domain(kTwoWays);
  const auto nothing = judged(domain, {});
  EXPECT_EQ(nothing.outcome, ActionsOutcome::kStoppedShort);
  EXPECT_FALSE(nothing.optimal);
  EXPECT_EQ(nothing.regret, 0.0);  // nothing is lost yet
  const auto detour = judged(domain, {"up", "down", "up"});
  EXPECT_EQ(detour.outcome, ActionsOutcome::kStoppedShort);
  EXPECT_DOUBLE_EQ(detour.regret, 1.0 / 9.0);
}

TEST(Judgement, StopsAtAnActionThatIsNotPossible) {
  const Domain domain = sound_domain(kTwoWays);
  for (const std::string illegal : {"left", "pickup", "fly", ""}) {
    const auto judgement = judged(domain, {"up", illegal, "up", "right", "right"});
    EXPECT_EQ(judgement.outcome, ActionsOutcome::kIllegal) << illegal;
    EXPECT_FALSE(judgement.optimal) << illegal;
    EXPECT_EQ(judgement.counted, 1u) << illegal;
    EXPECT_EQ(judgement.ignored, 4u) << illegal;
    EXPECT_EQ(judgement.feature_counts, (IntegerVector{0, 0, 1})) << illegal;
  }
}

TEST(Judgement, IgnoresWhatComesAfterTheEnd) {
  const Domain domain = sound_domain(kTwoWays);
  const auto judgement = judged(domain, {"up", "up", "right", "right", "left", "nonsense"});
  EXPECT_TRUE(judgement.optimal);
  EXPECT_EQ(judgement.counted, 4u);
  EXPECT_EQ(judgement.ignored, 2u);
}

TEST(Judgement, AgreesWithThePlanForTheRobotsOwnPathFromEveryStart) {
  const Domain domain = load_domain("item-delivery");
  for (const std::size_t m : {0u, 21u, 63u}) {
    const MdpIndex mdp{m};
    const ActionsJudge judge{domain, mdp};
    const auto plan = plan_exactly(domain.mdp(mdp), domain.weights().integer);
    for (std::size_t s = 0; s < domain.mdp(mdp).num_states(); ++s) {
      Actions actions;
      for (const auto a : canonical_trajectory(domain.mdp(mdp), plan.solution->canonical_choice, StateIndex{s}).actions)
        actions.push_back(domain.action_names()[a.value()]);
      const auto judgement = judge.judge(StateIndex{s}, actions);
      EXPECT_TRUE(judgement.optimal);
      EXPECT_EQ(judgement.earned, judge.best_return(StateIndex{s}));
    }
  }
}

TEST(Judgement, FindsNoRegretBelowZeroInRandomWalks) {
  const Domain domain = load_domain("item-delivery");
  const ActionsJudge judge{domain, MdpIndex{63}};
  RandomStream random{5};
  for (int walk = 0; walk < 300; ++walk) {
    Actions actions;
    const auto length = uniform_index(30, random);
    for (std::size_t i = 0; i < length; ++i) {
      actions.push_back(domain.action_names()[uniform_index(domain.action_names().size(), random)]);
    }
    const auto judgement = judge.judge(StateIndex{0}, actions);
    EXPECT_GE(judgement.regret, 0.0);
    EXPECT_EQ(judgement.counted + judgement.ignored, actions.size());
    EXPECT_LE(judgement.optimal, judgement.regret == 0.0);
  }
}

TEST(Judgement, RefusesWhatDoesNotExist) {
  const Domain domain = sound_domain(kTwoWays);
  EXPECT_THROW((ActionsJudge{domain, MdpIndex{1}}), std::invalid_argument);
  const ActionsJudge judge{domain, MdpIndex{0}};
  EXPECT_THROW(static_cast<void>(judge.judge(StateIndex{1000}, {})), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(judge.best_return(StateIndex{1000})), std::invalid_argument);
  const auto at_the_end = judge.judge(StateIndex{domain.mdp(MdpIndex{0}).num_states()}, {});
  EXPECT_TRUE(at_the_end.optimal);
  EXPECT_STREQ(name_of(at_the_end.outcome), "finished");
  EXPECT_STREQ(name_of(ActionsOutcome::kIllegal), "illegal");
  EXPECT_STREQ(name_of(ActionsOutcome::kStoppedShort), "stopped-short");
}

}  // namespace
}  // namespace kith
