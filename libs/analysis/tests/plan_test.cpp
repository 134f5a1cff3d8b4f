#include "kith/analysis/plan.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

namespace kith {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;

std::vector<std::string> ids_of(const std::vector<PlannedAnalysis>& plan) {
  std::vector<std::string> ids;
  for (const auto& analysis : plan) ids.push_back(analysis.id);
  return ids;
}

bool uses(const PlannedAnalysis& analysis, const std::string& method) {
  return std::any_of(analysis.methods.begin(), analysis.methods.end(),
                     [&](const Method& one) { return one.text == method; });
}

TEST(PlannedAnalyses, AreThoseOfTheDesign) {
  const PlannedDesign design{.strategies = {"baseline", "individual-low", "joint"},
                             .compositions = {"NNN", "PPP"},
                             .same_people = true,
                             .contrasts = {parse_contrast("mine: joint - individual-low")}};
  const auto plan = planned_analyses(design, AnalysisOptions{});
  EXPECT_THAT(ids_of(plan),
              ElementsAre("periods", "knowledge", "periods-within-composition", "knowledge-within-composition",
                          "periods-beliefs", "knowledge-beliefs", "periods-variation", "knowledge-variation",
                          "periods-paired", "knowledge-paired", "periods-baseline", "knowledge-baseline"));
  EXPECT_EQ(plan.at(1).model, "knowledge ~ strategy + composition + strategy:composition + (1|people)");
  ASSERT_EQ(plan.at(1).contrasts.size(), 1u);
  EXPECT_EQ(plan.at(1).contrasts.front().name, "mine");
  EXPECT_TRUE(uses(plan.at(1), "linear mixed model (REML) with Satterthwaite's degrees of freedom"));
  EXPECT_TRUE(uses(plan.back(), "a paired t test of the same people"));
}

TEST(PlannedAnalyses, BeginWithThePrimaryContrasts) {
  PlannedDesign design{.strategies = {"individual-low", "joint"}, .compositions = {"NNN", "PPP"}};
  design.contrasts = {parse_contrast("mine: joint - individual-low"), parse_contrast("other: NNN - PPP")};
  EXPECT_TRUE(primary_hypotheses(design).empty());
  design.contrasts.front().primary = true;
  const auto hypotheses = primary_hypotheses(design);
  ASSERT_EQ(hypotheses.size(), 2u);
  EXPECT_EQ(hypotheses[0].response, "periods");
  EXPECT_EQ(hypotheses[1].response, "knowledge");
  const auto plan = planned_analyses(design, AnalysisOptions{});
  EXPECT_EQ(plan.front().id, "primary");
  EXPECT_EQ(plan.front().contrasts, hypotheses);
  EXPECT_TRUE(uses(plan.front(), "planned contrasts of estimated marginal means (Holm correction for 2 hypotheses)"));
  ASSERT_EQ(plan.at(1).contrasts.size(), 1u);
  EXPECT_EQ(plan.at(1).contrasts.front().name, "other");
}

TEST(PlannedAnalyses, IncludeTheExam) {
  const PlannedDesign design{.strategies = {"plan", "joint"}, .compositions = {"NNN"}, .has_exam = true};
  const auto plan = planned_analyses(design, AnalysisOptions{});
  EXPECT_THAT(ids_of(plan), ::testing::IsSupersetOf(
                                {"exam_share_right", "exam_regret", "exam_worst_share_right", "exam_regret-paired"}));
}

TEST(PlannedAnalyses, DependOnWhetherPeopleAreTheSame) {
  const PlannedDesign design{
      .strategies = {"baseline", "joint", "common"}, .compositions = {"NNN", "PPP"}, .same_people = false};
  const auto plan = planned_analyses(design, AnalysisOptions{});
  EXPECT_EQ(plan.front().model, "periods ~ strategy + composition + strategy:composition");
  EXPECT_TRUE(uses(plan.back(), "Welch's t test"));
  const auto ids = ids_of(plan);
  EXPECT_THAT(ids, ::testing::Not(Contains("periods-paired")));
}

TEST(PlannedAnalyses, OfOneGroupStrategyAreComparisonsWithTheBaseline) {
  const PlannedDesign design{.strategies = {"baseline", "joint"}, .compositions = {"NP"}};
  EXPECT_THAT(ids_of(planned_analyses(design, AnalysisOptions{})),
              ElementsAre("periods-baseline", "knowledge-baseline"));
  EXPECT_THROW((void)planned_analyses({}, AnalysisOptions{}), std::invalid_argument);
}

}  // namespace
}  // namespace kith
