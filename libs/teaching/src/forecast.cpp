#include "kith/teaching/forecast.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace kith {
namespace {

template <typename Value>
double mean_of(std::span<const RemainingTime::Case> cases, Value value) {
  double sum = 0.0;
  for (const auto& one : cases) sum += value(one);
  return sum / static_cast<double>(cases.size());
}

template <typename Value>
double quantile_of(std::span<const RemainingTime::Case> cases, double q, Value value) {
  std::vector<double> values;
  for (const auto& one : cases) values.push_back(value(one));
  std::sort(values.begin(), values.end());
  const auto rank = static_cast<std::size_t>(std::ceil(q * static_cast<double>(values.size())));
  return values[std::max<std::size_t>(rank, 1) - 1];
}

double periods_of(const RemainingTime::Case& one) { return static_cast<double>(one.periods); }
double case_minutes(const RemainingTime::Case& one) { return one.minutes; }

std::size_t periods_of_stage(const PastSession& session, std::size_t stage) {
  return static_cast<std::size_t>(std::count_if(session.periods.begin(), session.periods.end(),
                                                [&](const auto& period) { return period.stage == stage; }));
}

// The periods from the stage on, without the first `skipped`.
RemainingTime::Case rest_of(const PastSession& session, std::size_t stage, std::size_t skipped) {
  RemainingTime::Case rest{.periods = 0, .minutes = 0.0, .completed = session.completed};
  for (const auto& period : session.periods) {
    if (period.stage < stage) continue;
    if (skipped > 0) {
      --skipped;
      continue;
    }
    ++rest.periods;
    rest.minutes += period.minutes;
  }
  return rest;
}

double mean_minutes_of_periods(std::span<const PastSession> sessions) {
  double sum = 0.0, n = 0.0;
  for (const auto& session : sessions) {
    for (const auto& period : session.periods) sum += period.minutes;
    n += static_cast<double>(session.periods.size());
  }
  return n > 0.0 ? sum / n : 0.0;
}

}  // namespace

RemainingTime::RemainingTime(std::vector<Case> cases) : cases_{std::move(cases)} {
  if (cases_.empty()) throw std::invalid_argument{"RemainingTime: there is no case"};
}

double RemainingTime::mean_periods() const { return mean_of(cases_, periods_of); }
double RemainingTime::mean_minutes() const { return mean_of(cases_, case_minutes); }
double RemainingTime::periods_quantile(double q) const { return quantile_of(cases_, q, periods_of); }
double RemainingTime::minutes_quantile(double q) const { return quantile_of(cases_, q, case_minutes); }

double RemainingTime::done_within(std::size_t periods) const {
  return mean_of(cases_, [&](const Case& one) { return one.completed && one.periods <= periods ? 1.0 : 0.0; });
}

RemainingTime RemainingTime::at_pace(double factor) const {
  auto cases = cases_;
  for (auto& one : cases) one.minutes *= factor;
  return RemainingTime{std::move(cases)};
}

RemainingTime forecast_remaining(std::span<const PastSession> sessions, const SessionPlace& place) {
  if (sessions.empty()) throw std::invalid_argument{"forecast_remaining: there are no sessions"};
  std::vector<RemainingTime::Case> cases;
  for (const auto& session : sessions) {
    if (place.periods > 0 && periods_of_stage(session, place.stage) <= place.periods) continue;
    cases.push_back(rest_of(session, place.stage, place.periods));
  }
  // Where hardly any other session got so far, this one may be of another kind. Then the periods so far are all that is
  // known: with t of them, at least k more are needed with probability t / (t + k - 1).
  constexpr double kFew = 0.05;
  const auto n = sessions.size();
  const auto few = static_cast<std::size_t>(std::ceil(kFew * static_cast<double>(n)));
  if (place.periods == 0 || cases.size() >= few) return RemainingTime{std::move(cases)};
  const std::size_t unlike = cases.empty() ? n : few - cases.size();
  const double minutes = mean_minutes_of_periods(sessions);
  for (std::size_t i = 0; i < unlike; ++i) {
    // The probability of more. Nobody is taught ten times as long.
    const double above = std::max(0.1, (static_cast<double>(i) + 0.5) / static_cast<double>(unlike));
    const double more = std::ceil(static_cast<double>(place.periods) * (1.0 - above) / above);
    auto& rest = cases.emplace_back(rest_of(sessions[i * n / unlike], place.stage + 1, 0));
    rest.periods += static_cast<std::size_t>(more);
    rest.minutes += more * minutes;
  }
  return RemainingTime{std::move(cases)};
}

RemainingTime extrapolate_remaining(std::size_t open_components, std::size_t learned_components, std::size_t periods,
                                    std::size_t most_periods, std::span<const double> minutes) {
  const double learned = std::max(1.0, static_cast<double>(learned_components));
  const double each = std::max(1.0, static_cast<double>(periods) / learned);
  const double left =
      std::min(static_cast<double>(most_periods), std::ceil(static_cast<double>(open_components) * each));
  std::vector<RemainingTime::Case> cases;
  for (const double one : minutes)
    cases.push_back({.periods = static_cast<std::size_t>(left), .minutes = left * one, .completed = true});
  return RemainingTime{std::move(cases)};
}

}  // namespace kith
