#include "kith/analysis/survival.hpp"

#include <gtest/gtest.h>
#include <limits>
#include <stdexcept>

#include "reference.hpp"

namespace kith {
namespace {

using nlohmann::json;
using testing::kRounding;
using testing::read_factor;
using testing::relative_error;

const json& survival_cases() {
  static const json reference = testing::read_reference("models.json").at("survival");
  return reference;
}

std::vector<bool> events_of(const json& one) { return one.at("event").get<std::vector<bool>>(); }

// R has no interval where nobody is left; ours is the curve itself.
double or_zero(const json& value) { return value.is_null() ? 0.0 : value.get<double>(); }

TEST(KaplanMeier, AgreesWithRsSurvfit) {
  for (const auto& reference : survival_cases()) {
    SCOPED_TRACE(reference.at("name").get<std::string>());
    const auto times = reference.at("time").get<std::vector<double>>();
    const auto curve = kaplan_meier(times, events_of(reference));
    const auto wide = kaplan_meier(times, events_of(reference), 0.8);
    const auto& expected = reference.at("curve");
    ASSERT_EQ(curve.steps.size(), expected.at("time").size());
    for (std::size_t i = 0; i < curve.steps.size(); ++i) {
      const auto& step = curve.steps[i];
      EXPECT_EQ(step.time, expected.at("time")[i]);
      EXPECT_EQ(step.at_risk, expected.at("at_risk")[i]);
      EXPECT_EQ(step.events, expected.at("events")[i]);
      EXPECT_LE(relative_error(step.survival, expected.at("survival")[i]), kRounding);
      EXPECT_LE(relative_error(step.low, or_zero(expected.at("low")[i])), kRounding);
      EXPECT_LE(relative_error(step.high, or_zero(expected.at("high")[i])), kRounding);
      EXPECT_LE(relative_error(wide.steps[i].low, or_zero(expected.at("low80")[i])), kRounding);
      EXPECT_LE(relative_error(wide.steps[i].high, or_zero(expected.at("high80")[i])), kRounding);
    }
    ASSERT_EQ(curve.median.has_value(), !expected.at("median").is_null());
    if (curve.median) {
      EXPECT_LE(relative_error(*curve.median, expected.at("median")), kRounding);
    }
  }
}

void expect_equal(const Estimable<TestResult>& test, const json& expected) {
  ASSERT_TRUE(test) << test.reason();
  EXPECT_EQ(test->statistic_name, "chi-squared");
  EXPECT_EQ(test->df, std::vector<double>{expected.at("df").get<double>()});
  EXPECT_LE(relative_error(test->statistic, expected.at("statistic")), kRounding);
  EXPECT_LE(relative_error(test->p, expected.at("p")), kRounding);
}

TEST(LogRank, AgreesWithRsSurvdiff) {
  int compared = 0;
  for (const auto& reference : survival_cases()) {
    SCOPED_TRACE(reference.at("name").get<std::string>());
    if (!reference.contains("log_rank")) continue;
    const auto times = reference.at("time").get<std::vector<double>>();
    const auto groups = read_factor(reference.at("groups"));
    expect_equal(log_rank(times, events_of(reference), groups), reference.at("log_rank"));
    ++compared;
    if (!reference.contains("stratified")) continue;
    expect_equal(log_rank(times, events_of(reference), groups, read_factor(reference.at("strata"))),
                 reference.at("stratified"));
    ++compared;
  }
  EXPECT_EQ(compared, 10);
}

TEST(KaplanMeier, MultipliesTheSharesThatStay) {
  const auto curve = kaplan_meier(std::vector<double>{4, 2, 2, 1}, {true, true, false, true});
  ASSERT_EQ(curve.steps.size(), 3U);
  EXPECT_EQ(curve.observations, 4U);
  EXPECT_EQ(curve.events, 3U);
  EXPECT_DOUBLE_EQ(curve.steps[0].survival, 3.0 / 4.0);
  EXPECT_DOUBLE_EQ(curve.steps[1].survival, 3.0 / 4.0 * 2.0 / 3.0);
  EXPECT_EQ(curve.steps[2].at_risk, 1U);
  EXPECT_EQ(curve.steps[2].survival, 0.0);
  EXPECT_EQ(curve.steps[2].low, 0.0);
  EXPECT_EQ(curve.steps[2].high, 0.0);
  EXPECT_EQ(curve.median, 3.0);  // 1/2 from 2 to 4
}

TEST(KaplanMeier, OfNobodyIsEmpty) {
  const auto curve = kaplan_meier({}, {});
  EXPECT_TRUE(curve.steps.empty());
  EXPECT_FALSE(curve.median.has_value());
}

TEST(KaplanMeier, NamesWhatItCannotTake) {
  const std::vector<double> times{1, 2};
  EXPECT_THROW((void)kaplan_meier(times, {true}), std::invalid_argument);
  EXPECT_THROW((void)kaplan_meier(times, {true, true}, 1.0), std::invalid_argument);
  EXPECT_THROW((void)kaplan_meier(std::vector<double>{1, 0}, {true, true}), std::invalid_argument);
  EXPECT_THROW((void)kaplan_meier(std::vector<double>{1, std::nan("")}, {true, true}), std::invalid_argument);
  EXPECT_THROW((void)kaplan_meier(std::vector<double>{1, std::numeric_limits<double>::infinity()}, {true, true}),
               std::invalid_argument);
}

const Factor kTwoGroups{"group", {"a", "b"}, {0, 1, 0, 1}};

TEST(LogRank, IsSymmetricInTheGroups) {
  const std::vector<double> times{1, 2, 3, 4};
  const std::vector<bool> observed{true, true, true, true};
  const Factor swapped{"group", {"b", "a"}, {1, 0, 1, 0}};
  const auto test = log_rank(times, observed, kTwoGroups);
  ASSERT_TRUE(test);
  EXPECT_DOUBLE_EQ(test->statistic, log_rank(times, observed, swapped)->statistic);
}

TEST(LogRank, WithOneStratumIsTheTestWithout) {
  const std::vector<double> times{1, 2, 3, 4};
  const std::vector<bool> observed{true, false, true, true};
  const Factor stratum{"stratum", {"unused", "all"}, {1, 1, 1, 1}};
  EXPECT_EQ(log_rank(times, observed, kTwoGroups, stratum)->statistic,
            log_rank(times, observed, kTwoGroups)->statistic);
}

TEST(LogRank, DoesNotCountALevelThatNobodyHas) {
  const std::vector<double> times{1, 2, 3, 4};
  const std::vector<bool> observed(4, true);
  const Factor groups{"group", {"a", "nobody", "b"}, {0, 2, 0, 2}};
  EXPECT_EQ(log_rank(times, observed, groups)->df, std::vector<double>{1.0});
  EXPECT_DOUBLE_EQ(log_rank(times, observed, groups)->statistic, log_rank(times, observed, kTwoGroups)->statistic);
}

TEST(LogRank, SaysWhyThereIsNothingToCompare) {
  const std::vector<double> times{1, 2, 3, 4};
  const std::vector<bool> observed(4, true);
  EXPECT_EQ(log_rank(times, std::vector<bool>(4, false), kTwoGroups).reason(), "no event was observed");
  EXPECT_EQ(log_rank({}, {}, Factor{"group", {}, {}}).reason(), "no event was observed");
  const Factor alone{"group", {"a"}, {0, 0, 0, 0}};
  EXPECT_EQ(log_rank(times, observed, alone).reason(), "fewer than two groups were at risk when events happened");
  EXPECT_EQ(log_rank(std::vector<double>(4, 7.0), observed, kTwoGroups).reason(),
            "no event compares some of the groups");
  const Factor same_strata{"stratum", {"s", "t"}, kTwoGroups.codes};
  EXPECT_EQ(log_rank(times, observed, kTwoGroups, same_strata).reason(), "no event compares some of the groups");
}

TEST(LogRank, NamesWhatItCannotTake) {
  const std::vector<double> times{1, 2, 3};
  EXPECT_THROW((void)log_rank(times, {true, true, true}, kTwoGroups), std::invalid_argument);
  EXPECT_THROW((void)log_rank(times, {true}, Factor{"group", {"a"}, {0, 0, 0}}), std::invalid_argument);
  EXPECT_THROW((void)log_rank(times, {true, true, true}, Factor{"group", {"a"}, {0, 0, 1}}), std::invalid_argument);
}

}  // namespace
}  // namespace kith
