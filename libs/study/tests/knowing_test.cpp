// People who know the robot as it was before an update.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kith/domains/domain_file.hpp"
#include "kith/study/study.hpp"
#include "study_file_support.hpp"

namespace kith {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::ids;
using ::testing::IsEmpty;
using testing::kStudy;
using testing::study_with;

std::string update_file(const std::string& name) { return std::string{KITH_SOURCE_DIR} + "/tests/updates/" + name; }

// The tiny study with people who know this robot, and are taught about item delivery, or another one.
std::string study_of_knowing(const std::string& older, const std::string& newer = "item-delivery") {
  auto text = study_with("ability =", "knowing = \"" + older + "\"\nability =");
  return text.replace(text.find("item-delivery"), std::string{"item-delivery"}.size(), newer);
}

struct Taught {
  double regret_before = 0.0, regret_after = 0.0, periods = 0.0;
};

// What `teams` single people get wrong under `plan` before and after.
Taught taught(const StudyReading& reading, std::size_t teams, std::size_t max_periods) {
  auto study = *reading.study;
  auto& spec = study.variants.front();
  spec.replicates = teams;
  spec.strategies = {strategy_named("plan")};
  spec.compositions = {"N"};
  spec.exam = ExamLevel::kPeriod;
  spec.teaching.max_periods = max_periods;
  const auto ran = run_teams(Atlas{*reading.domain}, study, team_addresses(study), {.threads = 1, .on_progress = {}});
  Taught sum;
  for (const auto& team : ran.teams) {
    sum.regret_before += team.exams.front().regret / static_cast<double>(teams);
    sum.regret_after += team.exam->regret / static_cast<double>(teams);
    sum.periods += static_cast<double>(team.periods) / static_cast<double>(teams);
  }
  return sum;
}

StudyReading read(const std::string& text) {
  auto reading = testing::parse(text);
  EXPECT_TRUE(reading.study) << reading.diagnostics.front().message;
  return reading;
}

TEST(Knowing, IsReadFromAFileAndFrozenWithoutIt) {
  for (const auto& older : {std::string{"item-delivery"}, update_file("rubble_free.toml")}) {
    const auto reading = read(study_of_knowing(older));
    const auto& spec = reading.study->variants.front();
    const auto& known = spec.learner_types.front().knowing;
    ASSERT_TRUE(known);
    EXPECT_EQ(known->name, load_domain(older).id());
    EXPECT_EQ(*known, older_robot(Atlas{load_domain(older)}));
    ASSERT_TRUE(spec.teaching.known);
    EXPECT_TRUE(spec.teaching.known->contains(load_domain(older).weights().integer));

    const auto frozen = to_toml(*reading.study, *reading.domain);
    EXPECT_THAT(frozen, HasSubstr("[learner.N.knowing]"));
    const auto again = read(frozen);
    EXPECT_EQ(again.study->variants.front().learner_types.front().knowing, known);
    EXPECT_EQ(again.study->variants.front().teaching.known, spec.teaching.known);
    EXPECT_EQ(to_toml(*again.study, *again.domain), frozen);
  }
}

TEST(Knowing, IsNotWrittenWhereNobodyKnowsAnything) {
  const auto reading = read(kStudy);
  EXPECT_FALSE(reading.study->variants.front().teaching.known);
  EXPECT_EQ(to_toml(*reading.study, *reading.domain).find("knowing"), std::string::npos);
}

TEST(Knowing, SaysWhatCannotBeKnown) {
  EXPECT_THAT(ids(testing::parse(study_of_knowing("no-such-robot"))), ElementsAre("E0116"));
  const auto other = testing::parse(study_of_knowing("two-goals"));
  ASSERT_THAT(ids(other), ElementsAre("E0425"));
  EXPECT_EQ(other.diagnostics.front().line, 10u);
  EXPECT_THAT(other.diagnostics.front().message, HasSubstr("weighs other features"));
  EXPECT_THAT(other.diagnostics.front().hint, HasSubstr("same features"));
  // What everybody knows now, people who know the older robot may not be able to know.
  const auto clash = study_of_knowing("item-delivery") + "prior = [ { rubble = -1, step = 2 }, { step = -1 } ]\n";
  EXPECT_THAT(ids(testing::parse(clash)), IsEmpty());
  auto impossible = study_of_knowing(update_file("rubble_free.toml"));
  impossible += "prior = [ { rubble = -1, step = 2 }, { step = -1 } ]\n";
  EXPECT_THAT(ids(testing::parse(impossible)), ElementsAre("E0425"));
}

TEST(Knowing, DoesNotVary) {
  const auto text = study_with("[learner.N]", "vary = { \"learner.N.knowing\" = [\"item-delivery\"] }\n[learner.N]");
  EXPECT_THAT(ids(testing::parse(text)), ElementsAre("E0412"));
}

TEST(Knowing, IsWhatTheTeacherKnowsUnlessItIsToldOtherwise) {
  const auto told = read(study_of_knowing("item-delivery") + "[teacher]\nknowing = \"nothing\"\n");
  EXPECT_FALSE(told.study->variants.front().teaching.known);
  EXPECT_THAT(to_toml(*told.study, *told.domain), HasSubstr("knowing = \"nothing\""));

  std::string mixed = study_of_knowing("item-delivery");
  mixed.replace(mixed.find("\"NN\""), 4, "\"NM\"");
  mixed +=
      "[learner.M]\nability = { mean = 0.7, sd = 0.03 }\nconfirm_gain = { half_normal = 0.03 }\n"
      "correct_gain = { value = 0.05 }\n";
  const auto reading = read(mixed);
  EXPECT_THAT(ids(reading), Contains("W0409"));
  EXPECT_FALSE(reading.study->variants.front().teaching.known);
}

// Who knows the same robot gets next to nothing wrong, and is done after a few boards.
TEST(Knowing, TheSameRobotLeavesNextToNothingToLearn) {
  const auto nothing = taught(read(kStudy), 6, 20);
  const auto same = taught(read(study_of_knowing(update_file("unchanged.toml"))), 6, 20);
  EXPECT_LT(same.regret_before, 1.2 * kBeyondKnown * nothing.regret_before);
  EXPECT_LE(same.periods, 2.0);
}

// What people know that is no longer true costs them a stated share of the regret before teaching at most, beside
// people who know nothing and have as many lessons.
TEST(Knowing, TheOppositeIsHardlyWorseThanNothing) {
  constexpr double kWorse = 0.05;
  constexpr std::size_t kLessons = 12;  // mostly of a demonstration and a test
  auto opposite = read(study_of_knowing("item-delivery"));
  auto& spec = opposite.study->variants.front();
  const std::vector<HalfSpace> against{HalfSpace{IntegerVector{1, 0, 2}}, HalfSpace{IntegerVector{0, -1, 2}},
                                       HalfSpace{IntegerVector{0, 0, -1}}};
  spec.learner_types.front().knowing = OlderRobot{"opposite", against};
  spec.teaching.known = Cone::intersection(against);
  auto blank = read(kStudy);
  for (auto* reading : {&blank, &opposite}) {
    auto& teaching = reading->study->variants.front().teaching;
    teaching.mastery = stop_rule_named("fixed");
    teaching.periods_per_component = kLessons;
  }
  const auto nothing = taught(blank, 10, kLessons);
  const auto worse = taught(opposite, 10, kLessons);
  EXPECT_GT(worse.regret_before, nothing.regret_before);
  EXPECT_LT(worse.regret_after, nothing.regret_after + kWorse * nothing.regret_before);
}

}  // namespace
}  // namespace kith
