#include "kith/teaching/forecast.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "kith/core/distributions.hpp"

namespace kith {
namespace {

// So many periods of each of two stages, of one minute in the first and two in the second.
PastSession session(std::size_t first, std::size_t second, bool completed = true) {
  PastSession result{{}, completed};
  for (std::size_t i = 0; i < first; ++i) result.periods.push_back({0, 1.0});
  for (std::size_t i = 0; i < second; ++i) result.periods.push_back({1, 2.0});
  return result;
}

TEST(Forecast, BeforeASessionIsTheDistributionOfTheOthers) {
  const std::vector<PastSession> past{session(1, 2), session(2, 2), session(3, 4), session(4, 4, false)};
  const auto all = forecast_remaining(past, {});
  EXPECT_DOUBLE_EQ(all.mean_periods(), (3 + 4 + 7 + 8) / 4.0);
  EXPECT_DOUBLE_EQ(all.mean_minutes(), (5 + 6 + 11 + 12) / 4.0);
  EXPECT_DOUBLE_EQ(all.periods_quantile(0.0), 3.0);
  EXPECT_DOUBLE_EQ(all.periods_quantile(0.5), 4.0);
  EXPECT_DOUBLE_EQ(all.minutes_quantile(1.0), 12.0);
  EXPECT_DOUBLE_EQ(all.done_within(2), 0.0);
  EXPECT_DOUBLE_EQ(all.done_within(4), 0.5);
  EXPECT_DOUBLE_EQ(all.done_within(100), 0.75);  // one never learned everything
  EXPECT_DOUBLE_EQ(all.at_pace(2.0).mean_minutes(), 2.0 * all.mean_minutes());
}

// After two periods of the first stage only sessions count that needed a third one.
TEST(Forecast, DuringASessionDependsOnHowFarItIs) {
  const std::vector<PastSession> past{session(1, 2), session(2, 2), session(3, 4), session(5, 1)};
  const auto first = forecast_remaining(past, {.stage = 0, .periods = 2});
  ASSERT_EQ(first.cases().size(), 2u);
  EXPECT_DOUBLE_EQ(first.mean_periods(), (5 + 4) / 2.0);
  EXPECT_DOUBLE_EQ(first.done_within(4), 0.5);
  const auto second = forecast_remaining(past, {.stage = 1, .periods = 0});
  EXPECT_DOUBLE_EQ(second.mean_periods(), (2 + 2 + 4 + 1) / 4.0);
  EXPECT_DOUBLE_EQ(second.mean_minutes(), 2.0 * second.mean_periods());
}

TEST(Forecast, OfASessionThatTakesLongerThanAllOthersIsByItsOwnPeriods) {
  const std::vector<PastSession> past{session(1, 2), session(2, 4)};
  // More periods with probabilities 1/4 and 3/4: 7 * 3, and 7 / 3 rounded up; then the second stage of the others.
  const auto first = forecast_remaining(past, {.stage = 0, .periods = 7});
  ASSERT_EQ(first.cases().size(), 2u);
  EXPECT_EQ(first.cases()[0].periods, 21u + 2u);
  EXPECT_EQ(first.cases()[1].periods, 3u + 4u);
  EXPECT_DOUBLE_EQ(forecast_remaining(past, {.stage = 1, .periods = 9}).mean_periods(), (27.0 + 3.0) / 2.0);
  EXPECT_DOUBLE_EQ(forecast_remaining(past, {.stage = 2, .periods = 0}).mean_periods(), 0.0);
  EXPECT_THROW((void)forecast_remaining({}, {}), std::invalid_argument);
}

// People whom no lesson reaches never get done, whatever other people needed: the longer they take, the longer they are
// expected to take, and nobody is sure of them.
TEST(JudgedPeople, WhoNeverGetDoneAreNotForecastToBeDoneSoon) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    RandomStream random{seed};
    std::vector<PastSession> past;
    std::size_t longest = 0;
    const auto n = 1 + uniform_index(80, random);
    for (std::size_t i = 0; i < n; ++i) {
      past.push_back(session(1 + uniform_index(6, random), 1 + uniform_index(4, random)));
      for (std::size_t periods = 0; const auto& period : past.back().periods) {
        periods += period.stage == 0 ? 1 : 0;
        longest = std::max(longest, periods);
      }
    }
    double before = 1.0;
    for (std::size_t t = longest; t < 60; ++t) {
      const auto left = forecast_remaining(past, {.stage = 0, .periods = t});
      EXPECT_LE(left.done_within(3), 3.0 / static_cast<double>(t + 3) + 0.5 / static_cast<double>(n));
      EXPECT_LE(left.done_within(3), before + 1e-12);
      before = left.done_within(3);
    }
    EXPECT_LT(before, n > 10 ? 0.1 : 0.51);
  }
}

TEST(Forecast, WithoutOtherSessionsExtrapolatesTheirOwnPeriods) {
  const std::vector<double> minutes{2.0, 3.0, 4.0};
  const auto left = extrapolate_remaining(2, 1, 3, 50, minutes);
  EXPECT_DOUBLE_EQ(left.mean_periods(), 6.0);
  EXPECT_DOUBLE_EQ(left.minutes_quantile(0.0), 12.0);
  EXPECT_DOUBLE_EQ(left.minutes_quantile(1.0), 24.0);
  EXPECT_DOUBLE_EQ(extrapolate_remaining(2, 1, 3, 4, minutes).mean_periods(), 4.0);
  EXPECT_THROW((void)extrapolate_remaining(2, 1, 0, 4, {}), std::invalid_argument);
}

}  // namespace
}  // namespace kith
