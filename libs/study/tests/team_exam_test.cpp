// Studies with an exam: what is written down, and that asking changes nothing.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <string>

#include "item_delivery.hpp"
#include "kith/study/study.hpp"
#include "kith/study/summary.hpp"
#include "kith/study/tables.hpp"

namespace kith {
namespace {

using ::testing::HasSubstr;
using testing::item_delivery;
using ::testing::Not;

Study examined_study(ExamLevel exam, std::size_t questions = 0, std::string_view strategy = "joint") {
  StudySpec spec;
  spec.id = "examined";
  spec.seed = 4;
  spec.replicates = 2;
  spec.strategies = {strategy_named(strategy)};
  spec.compositions = {"NN"};
  spec.learner_types = {LearnerType{.letter = 'N', .label = {}}};
  spec.learner_types.front().parameters.set("ability.sd", 0.02);
  spec.teaching.mastery = stop_rule_named("fixed");
  spec.teaching.periods_per_component = 1;
  spec.exam = exam;
  spec.exam_questions = questions;
  return {{spec}};
}

std::vector<TeamRecord> teams_of(const Study& study) {
  return run_teams(item_delivery(), study, team_addresses(study), {.threads = 1, .on_progress = {}}).teams;
}

std::map<std::string, std::string> tables_of(const Study& study) {
  std::map<std::string, std::string> tables;
  write_study_tables(study, teams_of(study),
                     [&](std::string_view file, std::string_view piece) { tables[std::string{file}] += piece; });
  return tables;
}

TEST(TeamExam, IsTakenBeforeTheFirstPeriodAndAfterEvery) {
  const auto team = teams_of(examined_study(ExamLevel::kPeriod)).front();
  ASSERT_TRUE(team.exam);
  EXPECT_GT(team.exam->share_right, 0.5);
  EXPECT_LE(team.exam->worst_share_right, team.exam->share_right);
  EXPECT_GT(team.exam->regret, 0.0);
  // Before the first of 3 periods and after each, 2 members; all starts and those of 3 components.
  ASSERT_EQ(team.exams.size(), 4u * 2u * 4u);
  EXPECT_EQ(team.exams.front().period, 0u);
  EXPECT_FALSE(team.exams[1].p_bec);
  const auto& last = team.exams[3 * 2 * 4];
  EXPECT_GT(last.share_right, team.exams.front().share_right);
  EXPECT_EQ(last.p_bec, team.learners.front().p_bec);
  EXPECT_EQ(last.period, 3u);
  EXPECT_EQ(last.component, 0u);
  EXPECT_EQ(last.share_right, team.learners.front().exam_share_right);
  EXPECT_EQ(last.regret, team.learners.front().exam_regret);
}

TEST(TeamExam, AsksQuestionsIfTheStudySaysSo) {
  const auto team = teams_of(examined_study(ExamLevel::kEnd, 6)).front();
  for (const auto& learner : team.learners) {
    EXPECT_EQ(learner.exam_questions, 6u);
    EXPECT_LE(learner.exam_correct, 6u);
  }
  EXPECT_EQ(team.exams.size(), 2u * 4u);
}

// Of 24 teams that are stopped with a probability of a half, about 16 know enough, and fewer than 12 if the rule went
// by some of the starts only (.32 instead of .72 of 50 teams).
TEST(TeamExam, ConfirmsTheStopRuleThatExpectsIt) {
  auto study = examined_study(ExamLevel::kEnd, 0, "plan");
  auto& spec = study.variants.front();
  spec.replicates = 24;
  spec.compositions = {"NNN"};
  spec.teaching.mastery = stop_rule_named("exam");
  spec.teaching.probability = 0.5;
  std::size_t stopped = 0, know = 0;
  for (const auto& team : teams_of(study)) {
    if (!team.completed()) continue;
    ++stopped;
    if (team.exam->worst_share_right >= spec.teaching.share_right) ++know;
  }
  EXPECT_EQ(stopped, spec.replicates);
  EXPECT_GE(2 * know, stopped);
}

TEST(TeamExam, ChangesNothingElse) {
  const auto with = teams_of(examined_study(ExamLevel::kPeriod, 6));
  const auto without = teams_of(examined_study(ExamLevel::kNone));
  ASSERT_EQ(with.size(), without.size());
  for (std::size_t i = 0; i < with.size(); ++i) {
    EXPECT_EQ(with[i].knowledge, without[i].knowledge);
    EXPECT_EQ(with[i].tests, without[i].tests);
    EXPECT_FALSE(without[i].exam);
  }
}

TEST(TeamExam, HasColumnsOnlyIfItIsAskedFor) {
  const auto without = tables_of(examined_study(ExamLevel::kNone));
  EXPECT_THAT(without.at("teams.csv"), Not(HasSubstr("exam")));
  EXPECT_EQ(without.count("exam.csv"), 0u);
  const auto with = tables_of(examined_study(ExamLevel::kEnd));
  EXPECT_THAT(
      with.at("teams.csv"),
      HasSubstr(
          ",area_sr,person_periods,minutes,person_minutes,exam_share_right,exam_regret,exam_worst_share_right\n"));
  EXPECT_THAT(with.at("learners.csv"),
              HasSubstr(",correct,exam_share_right,exam_regret,exam_questions,exam_correct\n"));
  EXPECT_THAT(with.at("exam.csv"), HasSubstr(",period,kc,member,type,share_right,regret,p_bec\n"));
  EXPECT_THAT(with.at("periods.csv"), HasSubstr(",gain,members,"));
}

TEST(TeamExam, IsSummarized) {
  const auto study = examined_study(ExamLevel::kEnd);
  const auto teams = teams_of(study);
  const auto summary = summarize(teams);
  ASSERT_TRUE(summary.cells.front().regret);
  EXPECT_NEAR(summary.cells.front().regret->mean, (teams[0].exam->regret + teams[1].exam->regret) / 2.0, 1e-12);
  EXPECT_TRUE(summary.group->regret);
  EXPECT_FALSE(summarize(teams_of(examined_study(ExamLevel::kNone))).group->regret);
  EXPECT_FALSE(summary.group->regret_before);
}

TEST(TeamExam, SummaryHasTheRegretBeforeTheFirstLesson) {
  const auto teams = teams_of(examined_study(ExamLevel::kPeriod));
  double before = 0.0;
  for (const auto& team : teams) {
    for (const auto& row : team.exams) {
      if (row.period == 0 && row.component == 0) before += row.regret / 4.0;  // two teams of two
    }
  }
  const auto exam = *summarize(teams).group;
  ASSERT_TRUE(exam.regret_before);
  EXPECT_NEAR(exam.regret_before->mean, before, 1e-12);
  EXPECT_GT(exam.regret_before->mean, exam.regret->mean);
}

// Strategies that look ahead leave people better prepared than those of the paper.
TEST(TeamExam, FindsPlannedLessonsBetter) {
  const auto regret = [](std::string_view strategy) {
    return summarize(teams_of(examined_study(ExamLevel::kEnd, 0, strategy))).group->regret->mean;
  };
  const double joint = regret("joint");
  EXPECT_LT(regret("plan"), joint);
  EXPECT_LT(regret("oracle"), joint);
}

// Kinds that are told apart by nothing but parameters that change nothing are the same people, and the exam says so.
TEST(TeamExam, IsTheSameForTheSamePeopleOfAllKinds) {
  const auto study_of = [](const LearnerModel& model, const std::vector<std::pair<std::string, double>>& neutral) {
    auto study = examined_study(ExamLevel::kPeriod);
    auto& type = study.variants.front().learner_types.front();
    type.model = &model;
    type.parameters = ParameterValues{model.parameters};
    type.parameters.set("ability.sd", 0.02);
    for (const auto& [name, value] : neutral) type.parameters.set(name, value);
    return teams_of(study).front();
  };
  const auto usual = study_of(bayesian_model(), {});
  const auto expect_same = [&](const TeamRecord& team, std::size_t rows, double share, double regret) {
    ASSERT_EQ(team.exams.size(), usual.exams.size());
    for (std::size_t i = 0; i < rows; ++i) {
      SCOPED_TRACE(i);
      EXPECT_EQ(team.exams[i].component, usual.exams[i].component);
      EXPECT_NEAR(team.exams[i].share_right, usual.exams[i].share_right, share);
      EXPECT_NEAR(team.exams[i].regret, usual.exams[i].regret, regret);
    }
  };
  expect_same(study_of(slipping_model(), {{"slip", 0.0}, {"guess", 0.0}}), usual.exams.size(), 1e-12, 1e-12);
  expect_same(study_of(imitating_model(), {{"reward", 1.0}}), usual.exams.size(), 1e-12, 1e-12);
  // Before teaching: afterwards these people have seen other things. Two paths can be worth nearly the same to
  // somebody.
  const std::size_t before = usual.exams.size() / 4;
  expect_same(study_of(decaying_model(), {}), before, 1e-12, 1e-12);
  expect_same(study_of(noisy_rational_model(), {{"rationality", 1000.0}}), before, 0.02, 0.02);
}

}  // namespace
}  // namespace kith
