// Studies in which not everybody is taught all the time, people know something beforehand, or sessions are forecast.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <string>

#include "item_delivery.hpp"
#include "kith/study/session_forecasts.hpp"
#include "kith/study/study.hpp"
#include "kith/study/tables.hpp"
#include "kith/study/team_run.hpp"

namespace kith {
namespace {

using ::testing::HasSubstr;
using testing::item_delivery;
using ::testing::Not;

LearnerType crew_learner(char letter, double ability) {
  LearnerType type{.letter = letter, .label = {}};
  type.parameters.set("ability.mean", ability);
  type.parameters.set("ability.sd", 0.02);
  type.parameters.set("particles", std::int64_t{300});
  return type;
}

StudySpec crew_spec() {
  StudySpec spec;
  spec.id = "crews";
  spec.seed = 4;
  spec.replicates = 3;
  spec.strategies = {strategy_named("joint")};
  spec.compositions = {"NNP"};
  spec.learner_types = {crew_learner('N', 0.65), crew_learner('P', 0.9)};
  spec.teaching.filter.particles = 300;
  return spec;
}

std::vector<TeamRecord> run_crews(const Study& study) {
  return run_teams(item_delivery(), study, team_addresses(study), {.threads = 1, .on_progress = {}}).teams;
}

std::string crew_table(const Study& study, const std::string& file) {
  std::string text;
  write_study_tables(study, run_crews(study), [&](std::string_view name, std::string_view piece) {
    if (name == file) text += piece;
  });
  return text;
}

TEST(Cost, OfAWholeTeamIsThatOfEveryMember) {
  for (const auto& team : run_crews({{crew_spec()}})) {
    EXPECT_EQ(team.cost.person_periods, 3 * team.periods);
    EXPECT_NEAR(team.cost.minutes,
                (10.0 * static_cast<double>(team.demonstrations) + 25.0 * static_cast<double>(team.tests)) / 60.0,
                1e-9);
    EXPECT_NEAR(team.cost.person_minutes, 3.0 * team.cost.minutes, 1e-9);
    for (const auto& learner : team.learners) EXPECT_EQ(learner.periods, team.periods);
  }
  EXPECT_THAT(crew_table({{crew_spec()}}, "teams.csv"), Not(HasSubstr("person_periods")));
}

TEST(Release, SavesTheTimeOfThoseWhoAreDone) {
  auto spec = crew_spec();
  spec.teaching.release = stop_rule_named("all-right");
  std::size_t away = 0;
  for (const auto& team : run_crews({{spec}})) {
    std::size_t periods = 0;
    for (const auto& learner : team.learners) periods += learner.periods;
    EXPECT_EQ(team.cost.person_periods, periods);
    EXPECT_EQ(team.progress.size(), periods);
    away += 3 * team.periods - periods;
    // Who watched is named where not everybody did.
    for (const auto& shown : team.demonstration_records) {
      const auto& period = team.period_records.at(shown.period - 1);
      EXPECT_EQ(shown.member == 0, period.members == 3);
    }
  }
  EXPECT_GT(away, 0u);
  EXPECT_THAT(crew_table({{spec}}, "teams.csv"), HasSubstr(",area_sr,person_periods,minutes,person_minutes\n"));
}

TEST(KnownComponents, RaiseWhatPeopleBelieveAndNothingElse) {
  auto spec = crew_spec();
  spec.exam = ExamLevel::kPeriod;
  auto knowing = spec;
  for (auto& type : knowing.learner_types) type.parameters.set("known", 1.0);
  const auto without = run_crews({{spec}}), with = run_crews({{knowing}});
  for (std::size_t i = 0; i < with.size(); ++i) {
    EXPECT_GT(*with[i].exams.front().p_bec, *without[i].exams.front().p_bec + 0.1);  // the last component stays unknown
    EXPECT_EQ(with[i].learners.front().traits, without[i].learners.front().traits);
    EXPECT_LE(with[i].periods, without[i].periods);
  }
}

TEST(SessionForecasts, AreOfOtherPeopleOfTheSameCrew) {
  auto spec = crew_spec();
  spec.forecast_sessions = 12;
  const auto teams = run_crews({{spec}});
  TeachingCache cache{item_delivery()};
  const auto sessions = imagine_sessions(item_delivery(), cache, spec, "joint", "NNP", 12);
  ASSERT_EQ(sessions.size(), 12u);
  double mean = 0.0;
  for (const auto& session : sessions) mean += static_cast<double>(session.periods.size()) / 12.0;
  for (const auto& team : teams) {
    ASSERT_TRUE(team.forecast);
    EXPECT_NEAR(team.forecast->periods, mean, 1e-9);
    EXPECT_LE(team.forecast->minutes_low, team.forecast->minutes_high);
    for (const auto& period : team.period_records) {
      ASSERT_TRUE(period.forecast);
      EXPECT_LE(period.forecast->done_within[0], period.forecast->done_within[2]);
    }
    EXPECT_EQ(team.period_records.back().forecast->periods_left, 0.0);
  }
  // Forecasting changes nothing else.
  auto plain = spec;
  plain.forecast_sessions = 0;
  const auto others = run_crews({{plain}});
  for (std::size_t i = 0; i < teams.size(); ++i) EXPECT_EQ(teams[i].knowledge, others[i].knowledge);
  EXPECT_THAT(crew_table({{spec}}, "periods.csv"),
              HasSubstr(",members,forecast_periods_left,forecast_done_1,forecast_done_2,forecast_done_3,p_bec_common"));
  EXPECT_THAT(crew_table({{spec}}, "teams.csv"), HasSubstr(",forecast_periods,forecast_periods_low,"));
}

TEST(BeliefQuality, IsRecordedWhenAskedFor) {
  auto spec = crew_spec();
  EXPECT_THAT(crew_table({{spec}}, "teams.csv"), Not(HasSubstr("fewest_particles")));
  const auto plain = run_crews({{spec}});
  for (const auto& team : plain) EXPECT_FALSE(team.fewest_particles);
  spec.beliefs = true;
  const auto teams = run_crews({{spec}});
  ASSERT_EQ(teams.size(), plain.size());
  for (std::size_t i = 0; i < teams.size(); ++i) {
    ASSERT_TRUE(teams[i].fewest_particles);
    EXPECT_GT(*teams[i].fewest_particles, 0.0);
    EXPECT_LT(*teams[i].fewest_particles, 1000.0);
    EXPECT_EQ(teams[i].knowledge, plain[i].knowledge);  // recording changes nothing else
  }
  EXPECT_THAT(crew_table({{spec}}, "teams.csv"), HasSubstr(",fewest_particles"));

  auto others = teams;  // of learners of one's own, who need not have particles
  for (auto& team : others) team.fewest_particles.reset();
  EXPECT_NO_THROW(write_study_tables({{spec}}, others, [](std::string_view, std::string_view) {}));
}

}  // namespace
}  // namespace kith
