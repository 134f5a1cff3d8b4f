// What the teacher can tell about people, as tables have it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "item_delivery.hpp"
#include "kith/learners/presumed_kinds.hpp"
#include "kith/study/study.hpp"
#include "kith/study/tables.hpp"

namespace kith {
namespace {

using ::testing::HasSubstr;
using testing::item_delivery;
using ::testing::Not;

LearnerType learner_of_ability(char letter, double ability) {
  LearnerType type{.letter = letter, .label = {}};
  type.parameters.set("ability.mean", ability);
  type.parameters.set("ability.sd", 0.0);
  return type;
}

StudySpec estimated_spec() {
  StudySpec spec;
  spec.id = "estimated";
  spec.seed = 4;
  spec.replicates = 3;
  spec.strategies = {strategy_named("joint")};
  spec.compositions = {"LH"};
  spec.learner_types = {learner_of_ability('L', 0.62), learner_of_ability('H', 0.92)};
  spec.teaching.mastery = stop_rule_named("fixed");
  spec.teaching.periods_per_component = 3;
  spec.estimates = true;
  return spec;
}

std::vector<TeamRecord> estimated_teams(const StudySpec& spec) {
  const Study study{{spec}};
  return run_teams(item_delivery(), study, team_addresses(study), {.threads = 1, .on_progress = {}}).teams;
}

std::string estimated_table(const StudySpec& spec, const std::string& file) {
  std::string text;
  write_study_tables({{spec}}, estimated_teams(spec), [&](std::string_view name, std::string_view piece) {
    if (name == file) text += piece;
  });
  return text;
}

TEST(TeamEstimates, TellAbilitiesApart) {
  double low = 0.0, high = 0.0;
  for (const auto& team : estimated_teams(estimated_spec())) {
    // Before the first of 9 periods and after each: 2 members, themselves and 3 components.
    ASSERT_EQ(team.estimates.size(), 10u * 2u * 4u);
    EXPECT_EQ(team.estimates.front().period, 0u);
    EXPECT_NEAR(*team.estimates.front().ability_mean, 0.77, 1e-9);  // of the bank, before any answer
    for (const auto& estimate : team.estimates) {
      if (estimate.component > 0) {
        EXPECT_FALSE(estimate.ability || estimate.ability_mean || estimate.p_knew);
        EXPECT_GE(*estimate.p_right, 0.0);
        EXPECT_LE(*estimate.right, 1.0 + 1e-9);
        continue;
      }
      EXPECT_NEAR(*estimate.ability, estimate.type == 'L' ? 0.62 : 0.92, 1e-9);
      EXPECT_LE(*estimate.ability_low, *estimate.ability_mean);
      EXPECT_GE(*estimate.ability_high, *estimate.ability_mean);
      if (estimate.period == 9) (estimate.type == 'L' ? low : high) += *estimate.ability_mean / 3.0;
    }
  }
  EXPECT_LT(low, high - 0.05);
}

TEST(TeamEstimates, PredictMastery) {
  double predicted = 0.0, actual = 0.0, n = 0.0;
  for (const auto& team : estimated_teams(estimated_spec())) {
    for (const auto& period : team.period_records) {
      ASSERT_TRUE(period.mastery && period.mastery->actual);
      predicted += period.mastery->predicted;
      actual += *period.mastery->actual;
      ++n;
    }
  }
  EXPECT_NEAR(predicted / n, actual / n, 0.15);
}

TEST(TeamEstimates, AreOfTheEndIfOnlyTeamsAreRecorded) {
  auto spec = estimated_spec();
  spec.record = RecordLevel::kTeam;
  const auto all = estimated_teams(estimated_spec()), end = estimated_teams(spec);
  for (std::size_t i = 0; i < end.size(); ++i) {
    ASSERT_EQ(end[i].estimates.size(), 2u * 4u);
    EXPECT_EQ(end[i].estimates.front(), all[i].estimates[9 * 2 * 4]);
  }
}

TEST(TeamEstimates, SayWhoKnewWhat) {
  auto spec = estimated_spec();
  spec.teaching.hypotheses_about = HypothesesAbout::kKnownComponents;
  for (auto& type : spec.learner_types) type.parameters.set("known", 0.5);
  for (const auto& team : estimated_teams(spec)) {
    for (const auto& estimate : team.estimates) {
      EXPECT_FALSE(estimate.ability_mean || estimate.p_proficient);
      EXPECT_EQ(estimate.p_knew.has_value(), estimate.component == 1 || estimate.component == 2);
      if (estimate.component == 1 && estimate.period == 0) {
        EXPECT_NEAR(*estimate.p_knew, 0.5, 1e-9);
      }
    }
  }
}

TEST(TeamEstimates, SayWhatKindOfLearner) {
  auto spec = estimated_spec();
  spec.teaching.hypotheses_about = HypothesesAbout::kKinds;
  spec.teaching.kinds = hypotheses_about_kinds({"bayesian", "imitating"});
  spec.replicates = 1;
  const auto teams = estimated_teams(spec);
  for (const auto& estimate : teams.front().estimates) {
    EXPECT_EQ(estimate.p_kinds.size(), estimate.component == 0 ? 2u : 0u);
    EXPECT_EQ(estimate.kind.has_value(), estimate.component == 0);
    if (estimate.component == 0) {
      EXPECT_NEAR(estimate.p_kinds[0] + estimate.p_kinds[1], 1.0, 1e-9);
    }
  }
  const auto table = estimated_table(spec, "estimates.csv");
  EXPECT_THAT(table, HasSubstr(",right,p_kind_bayesian,p_kind_imitating,kind\n"));
  EXPECT_THAT(table, HasSubstr(",0.5,0.5,cannot tell yet\n"));
}

TEST(TeamEstimates, ChangeNothingElse) {
  auto plain = estimated_spec();
  plain.estimates = false;
  const auto with = estimated_teams(estimated_spec()), without = estimated_teams(plain);
  for (std::size_t i = 0; i < with.size(); ++i) {
    EXPECT_EQ(with[i].knowledge, without[i].knowledge);
    EXPECT_TRUE(without[i].estimates.empty());
    EXPECT_FALSE(without[i].period_records.front().mastery);
  }
}

TEST(TeamEstimates, HaveColumnsOnlyIfTheyAreAskedFor) {
  auto plain = estimated_spec();
  plain.estimates = false;
  EXPECT_EQ(estimated_table(plain, "estimates.csv"), "");
  EXPECT_THAT(estimated_table(plain, "periods.csv"), Not(HasSubstr("mastery")));
  EXPECT_THAT(estimated_table(estimated_spec(), "periods.csv"), HasSubstr(",gain,p_mastery,mastery,p_bec_common,"));
  const auto table = estimated_table(estimated_spec(), "estimates.csv");
  EXPECT_THAT(table, HasSubstr(",period,kc,member,type,ability,ability_mean,ability_low,ability_high,p_proficient,"
                               "proficiency,p_knew,knew,p_right,right\n"));
  EXPECT_THAT(table, HasSubstr(",cannot tell yet,"));
}

TEST(TeamEstimates, HaveAWordForProficiency) {
  EXPECT_EQ(proficiency_word(0.8), "proficient");
  EXPECT_EQ(proficiency_word(0.5), "cannot tell yet");
  EXPECT_EQ(proficiency_word(0.1), "not proficient");
}

}  // namespace
}  // namespace kith
