#include "kith/fit/answer_regions.hpp"

#include <gtest/gtest.h>

#include "kith/fit/log_likelihood.hpp"
#include "simulated_people.hpp"

namespace kith {
namespace {

// The same people, for whom the possible answers are not tabulated.
ResponseLogs without_tables(ResponseLogs logs) {
  const auto planned = std::make_shared<const Atlas>(logs.models.front().atlas->domain(), BehaviourSource::kOnDemand);
  for (auto& model : logs.models) model.atlas = planned;
  for (auto& person : logs.people) {
    for (auto& period : person.periods) {
      period.answers.clear();
      period.possible.clear();
      period.chance = 1.0;
    }
  }
  return logs;
}

ResponseLogs some_people(AnswerDetail detail) {
  return testing::simulate(testing::study_text("N", 4,
                                               "[stop]\nconsecutive_correct = 2\n[learner.N]\nability = { mean = 0.75, "
                                               "sd = 0.05 }\nconfirm_gain = { half_normal = 0.02 }\ncorrect_gain = { "
                                               "half_normal = 0.05 }\nparticles = 200\n"),
                           detail)
      .logs;
}

LikelihoodTable likelihoods(const ResponseLogs& logs) {
  return log_likelihoods(logs, make_grid(0.55, 0.9, 3, 0.1, 2), {.replicates = 2});
}

// Where tables say which paths are best for somebody, paths that are sampled must say the same: the same particles then
// lie in the region of an answer, but for those whose path was not met.
TEST(AnswerRegions, GiveTheLikelihoodsOfTables) {
  const auto tabulated = some_people(AnswerDetail::kPath);
  auto sampled = without_tables(tabulated);
  EXPECT_THROW((void)likelihoods(sampled), std::invalid_argument);
  ASSERT_TRUE(find_answer_regions(sampled, {.rounds = 4}));
  ASSERT_TRUE(sampled.sample.has_value());
  EXPECT_GT(sampled.sample->weights, 0u);
  EXPECT_LE(sampled.sample->missed * 100, sampled.sample->checked);
  const auto expected = likelihoods(tabulated);
  const auto found = likelihoods(sampled);
  for (std::size_t i = 0; i < expected.log_likelihood.size(); ++i) {
    for (std::size_t k = 0; k < expected.grid.size(); ++k) {
      // Weights whose path was not met, a hundredth at most, make p larger in each of some ten periods.
      EXPECT_NEAR(found.log_likelihood[i][k], expected.log_likelihood[i][k], 0.15) << i << " " << k;
    }
  }
}

TEST(AnswerRegions, LeaveLogsWithTablesAsTheyAre) {
  auto logs = some_people(AnswerDetail::kVerdict);
  const auto before = logs.people.front().periods.front().answers.size();
  ASSERT_TRUE(find_answer_regions(logs, {.detail = AnswerDetail::kVerdict}));
  EXPECT_FALSE(logs.sample.has_value());
  EXPECT_EQ(logs.people.front().periods.front().answers.size(), before);
}

TEST(AnswerRegions, StopWhenTold) {
  auto logs = without_tables(some_people(AnswerDetail::kPath));
  EXPECT_FALSE(find_answer_regions(logs, {.parallel = {.on_progress = [](auto, auto) { return false; }}}));
  EXPECT_FALSE(logs.sample.has_value());
}

}  // namespace
}  // namespace kith
