#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "kith/study/study_file.hpp"
#include "study_file_support.hpp"

namespace kith {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::ids;
using testing::kStudy;
using testing::parse;
using testing::study_with;

TEST(StudyLimits, RefusesMoreCombinationsThanAnybodyWants) {
  std::string vary = "vary = { ";
  for (const std::string key : {"counterfactuals", "particles", "process_noise", "response_noise", "resample_below"}) {
    vary += (key == "counterfactuals" ? "\"teacher." : ", \"teacher.") + key + "\" = [1, 2, 3, 4, 5, 6, 7]";
  }
  EXPECT_THAT(ids(parse(study_with("[learner.N]", vary + " }\n[learner.N]"))), ::testing::Contains("E0414"));
}

TEST(StudyLimits, HasAtMostTenMillionTeams) {
  const auto most = parse(kStudy, {"replicates=2500000"});  // of two strategies and two compositions
  ASSERT_TRUE(most.study);
  EXPECT_EQ(num_teams(*most.study), kMaxTeams);
  const auto more = parse(study_with("replicates = 2\n", "replicates = 2500001\n"));
  ASSERT_THAT(ids(more), ElementsAre("E0415"));
  EXPECT_FALSE(more.study);
  EXPECT_EQ(more.diagnostics[0].line, 5u);
  EXPECT_THAT(more.diagnostics[0].message, HasSubstr("the study has 10000004 teams (variants 1 x strategies 2 x "
                                                     "compositions 2 x replicates 2500001); at most 10000000"));
  EXPECT_THAT(ids(parse(kStudy, {"replicates=100000000"})), ElementsAre("E0110"));
  // Above 2^32, and every number alone small enough.
  const auto vary = std::string{
      "vary = { \"teacher.counterfactuals\" = [1,2,3,4,5,6,7,8,9,10], \"stop.max_periods\" = "
      "[1,2,3,4,5,6,7,8,9,10], \"stop.duplicate_sets\" = [1,2,3,4,5,6,7,8,9,10] }\n"};
  const auto product = parse(study_with("[learner.N]", vary + "[learner.N]"), {"replicates=2000000"});
  ASSERT_THAT(ids(product), ElementsAre("E0415"));
  EXPECT_EQ(product.diagnostics[0].line, 9u);
  EXPECT_THAT(product.diagnostics[0].message, HasSubstr("8000000000 teams (variants 1000 x"));
}

TEST(StudyLimits, HasAtMostAMillionCells) {
  std::string values = "0";
  for (int i = 1; i < 10'000; ++i) values += "," + std::to_string(i * 1e-4);
  std::string compositions;
  for (const int length : {3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 27})
    compositions += ", \"" + std::string(static_cast<std::size_t>(length), 'N') + '"';
  for (const int length : {3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 27})
    compositions += ", \"M" + std::string(static_cast<std::size_t>(length), 'N') + '"';
  const auto type =
      "[learner.M]\nability = { mean = 0.7, sd = 0.03 }\nconfirm_gain = { value = 0.03 }\n"
      "correct_gain = { value = 0.05 }\n";
  auto text = study_with(", \"N\"", ", \"N\"" + compositions) + type;
  const std::string place = "[learner.N]";
  text.replace(text.find(place), place.size(), "vary = { \"teacher.process_noise\" = [" + values + "] }\n" + place);
  const auto reading = parse(text);
  ASSERT_THAT(ids(reading), ElementsAre("E0416"));
  EXPECT_EQ(reading.diagnostics[0].line, 9u);
  EXPECT_THAT(reading.diagnostics[0].message,
              HasSubstr("1040000 cells (variants 10000 x strategies 2 x compositions 52); at most 1000000"));
}

// Comparing all of them with each other, these would take minutes.
TEST(StudyLimits, ReadsListsAsLongAsTheyLike) {
  std::string values = "0";
  for (int i = 1; i < 50'000; ++i) values += "," + std::to_string(i);
  const auto vary = "vary = { \"teacher.process_noise\" = [" + values + "] }\n";
  EXPECT_THAT(ids(parse(study_with("[learner.N]", vary + "[learner.N]"))), ElementsAre("E0414"));
  std::string compositions;
  for (int i = 0; i < 1 << 15; ++i) {
    compositions += ",\"";
    for (int bit = 0; bit < 15; ++bit) compositions += (i >> bit & 1) != 0 ? 'N' : 'P';
    compositions += '"';
  }
  EXPECT_THAT(ids(parse(study_with(", \"N\"", compositions))), ::testing::Each("E0405"));
}

}  // namespace
}  // namespace kith
