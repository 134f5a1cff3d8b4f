// A stop rule of one's own: this file and one row of a list. It works in a study, is written and read, keeps its
// bounds, is explained and reported.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "kith/core/error.hpp"
#include "kith/report/report.hpp"
#include "kith/runs/run_folder.hpp"
#include "kith/study/study.hpp"
#include "kith/study/study_file.hpp"
#include "kith/teaching/teaching_options.hpp"
#include "runs.hpp"

namespace kith {
namespace {

using ::testing::HasSubstr;
using namespace kith::testing;

// Enough once so many tests of the component were answered right, by everybody together or by a member.
class EnoughRightRule : public StopRule {
 public:
  explicit EnoughRightRule(std::size_t enough) : enough_{enough} {}
  [[nodiscard]] StopVerdict judge_team(const ClosedTests& closed) const override {
    std::size_t right = 0;
    for (std::size_t i = 0; i < closed.counted.size(); ++i) right += right_of(closed, i);
    return {right >= enough_, right >= enough_ ? 1.0 : 0.0};
  }
  [[nodiscard]] bool is_done(const ClosedTests& closed, std::size_t member) const override {
    return right_of(closed, member) >= enough_;
  }

 private:
  static std::size_t right_of(const ClosedTests& closed, std::size_t member) {
    const auto right = [&](const Feedback& feedback) {
      const auto& verdicts = feedback.verdicts[member];
      return static_cast<std::size_t>(
          std::count_if(verdicts.begin(), verdicts.end(), [](const auto& verdict) { return verdict.correct; }));
    };
    auto sum = right(closed.feedback);
    for (const auto& past : closed.view.history) {
      if (past.lesson.component == closed.lesson.component) sum += right(past.feedback);
    }
    return sum;
  }
  std::size_t enough_;
};

std::vector<StopRuleKind> with_enough_right() {
  static const std::array parameters{Parameter{.name = "right_answers",
                                               .default_value = std::int64_t{5},
                                               .description = "right answers that are enough",
                                               .min = 1,
                                               .max = 100}};
  std::vector<StopRuleKind> kinds{stop_rule_kinds().begin(), stop_rule_kinds().end()};
  kinds.push_back({.name = "enough-right",
                   .description = "when right_answers answers were right",
                   .make = [](const ParameterValues& values, TeachingCache&) -> std::unique_ptr<const StopRule> {
                     return std::make_unique<EnoughRightRule>(values.count("right_answers"));
                   },
                   .until =
                       [](const TeachingOptions&, const ParameterValues& values) {
                         return "until " + std::to_string(values.count("right_answers")) + " answers were right";
                       },
                   .released =
                       [](const TeachingOptions&, const ParameterValues& values) {
                         return "had given " + std::to_string(values.count("right_answers")) + " right answers";
                       },
                   .parameters = parameters});
  return kinds;
}

std::string study_with(const std::string& stop) {
  return "schema = \"kith.study/1\"\nid = \"own\"\ndomain = \"item-delivery\"\nseed = 3\nreplicates = 2\n[design]\n"
         "strategies = [\"joint\"]\ncompositions = [\"NN\"]\n[learner.N]\nability = { mean = 0.75, sd = 0.02 }\n"
         "confirm_gain = { value = 0.0 }\ncorrect_gain = { value = 0.02 }\nparticles = 100\n[stop]\n" +
         stop;
}

TEST(OwnStopRule, TeachesUntilItIsEnough) {
  const auto kinds = with_enough_right();
  const StudyKinds known{.stop_rules = kinds};
  const auto text = study_with("mastery = \"enough-right\"\nright_answers = 3\nrelease = \"enough-right\"\n");
  const auto reading = parse_study(text, "study.toml", {.kinds = known});
  ASSERT_TRUE(reading.study) << reading.diagnostics.front().message;
  EXPECT_FALSE(parse_study(text, "study.toml").study) << "only who asks for it gets it";

  const Atlas atlas{*reading.domain};
  const auto run = run_teams(atlas, *reading.study, team_addresses(*reading.study));
  for (const auto& team : run.teams) {
    for (const auto& last : team.responses) {
      const auto right = std::count_if(team.responses.begin(), team.responses.end(), [&](const auto& one) {
        return one.component == last.component && one.period < last.period && one.correct;
      });
      EXPECT_LT(right, 3) << "taught although it was enough";
    }
  }

  const auto again = parse_study(to_toml(*reading.study, *reading.domain), "again.toml", {.kinds = known});
  ASSERT_TRUE(again.study) << again.diagnostics.front().message;
  EXPECT_EQ(again.study->variants.front().teaching.mastery, reading.study->variants.front().teaching.mastery);
  EXPECT_EQ(again.study->variants.front().teaching.release, reading.study->variants.front().teaching.release);

  const ScratchFolder scratch;
  RunFolder{scratch / "run", freeze(reading), true}.publish(*reading.study, run.teams, {});
  const auto report = build_report(scratch / "run", {.kinds = known});
  EXPECT_THAT(report, HasSubstr("A knowledge component was taught until 3 answers were right;"));
  EXPECT_THAT(report, HasSubstr("Members who had given 3 right answers had no part in the remaining periods"));
  EXPECT_THAT(report, HasSubstr(R"(["stop","right_answers","3","right answers that are enough"])"));
}

TEST(OwnStopRule, KeepsItsBounds) {
  const auto kinds = with_enough_right();
  const auto reading = parse_study(study_with("mastery = \"enough-right\"\nright_answers = 0\n"), "study.toml",
                                   {.kinds = {.stop_rules = kinds}});
  ASSERT_FALSE(reading.study);
  EXPECT_EQ(reading.diagnostics.front().id, "E0110");
}

// A key of a rule that is not chosen is not known.
TEST(OwnStopRule, BringsItsKeysOnlyWhereItIsChosen) {
  const auto kinds = with_enough_right();
  const auto reading = parse_study(study_with("right_answers = 3\n"), "study.toml", {.kinds = {.stop_rules = kinds}});
  ASSERT_FALSE(reading.study);
  EXPECT_EQ(reading.diagnostics.front().id, "E0107");
}

}  // namespace
}  // namespace kith
