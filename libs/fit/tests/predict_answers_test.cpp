#include "kith/fit/predict_answers.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "human_data.hpp"
#include "kith/core/error.hpp"

namespace kith {
namespace {

const AnswerPrediction& model_of(const PredictionReport& report, const std::string& name) {
  return *std::find_if(report.models.begin(), report.models.end(), [&](const auto& one) { return one.model == name; });
}

// What real people say about the models, whatever is published about them. Each statement is one of docs/fitting.md.
TEST(PredictAnswersSlow, ComparesModelsOnRecordedPeople) {
  KITH_REQUIRE_HUMAN_DATA(mdps, "lee2021_test_mdps.jsonl");
  KITH_REQUIRE_HUMAN_DATA(path, "lee2021_test_responses.csv");
  const auto report = predict_answers(read_lee2021_worlds(*mdps), read_lee2021_responses(*path));
  EXPECT_EQ(report.people, 162u);
  EXPECT_EQ(report.answers, 2916u);
  std::size_t best_for = 0;
  for (const auto& model : report.models) {
    best_for += model.best_for;
    std::size_t answers = 0;
    for (const auto& bin : model.calibration) answers += bin.answers;
    EXPECT_EQ(answers, report.answers) << model.model;
    EXPECT_GE(model.log_loss, model_of(report, "Rasch").log_loss) << model.model;
  }
  EXPECT_EQ(best_for, report.people);
  EXPECT_EQ(model_of(report, "bayesian").difference, 0.0);
  const auto& slipping = model_of(report, "slipping");
  EXPECT_LT(slipping.difference, -3.0 * slipping.difference_se);
  EXPECT_LT(slipping.log_loss, 0.9 * model_of(report, "bayesian").log_loss);
}

TEST(PredictAnswers, RefusesUnknownWorldsAndTooFewPeople) {
  const auto fault = [](const std::vector<RecordedResponse>& responses) -> std::string {
    try {
      (void)predict_answers({}, responses);
    } catch (const Error& error) {
      return error.diagnostics().front().id;
    }
    return "none";
  };
  EXPECT_EQ(fault({}), "E0710");
  RecordedResponse response;
  response.world = "nowhere";
  EXPECT_EQ(fault({response}), "E0702");
}

}  // namespace
}  // namespace kith
