#include "kith/teaching/forecast.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

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

TEST(Forecast, OfASessionThatTakesLongerThanAllOthersIsOneMorePeriodOfTheStage) {
  const std::vector<PastSession> past{session(1, 2), session(2, 4)};
  EXPECT_DOUBLE_EQ(forecast_remaining(past, {.stage = 0, .periods = 7}).mean_periods(), 1.0 + 3.0);
  EXPECT_DOUBLE_EQ(forecast_remaining(past, {.stage = 1, .periods = 9}).mean_periods(), 1.0);
  EXPECT_DOUBLE_EQ(forecast_remaining(past, {.stage = 2, .periods = 0}).mean_periods(), 0.0);
  EXPECT_THROW((void)forecast_remaining({}, {}), std::invalid_argument);
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
