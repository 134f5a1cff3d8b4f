#include "kith/study/session_forecasts.hpp"

#include "kith/core/stream.hpp"
#include "kith/study/team_run.hpp"

namespace kith {

PastSession past_session(const TeamRecord& team, const StudySpec& spec, std::size_t num_components) {
  PastSession session{{}, team.status != SessionStatus::kMaxPeriods};
  std::size_t number = 0, last_period = 0, last_member = 0, last_session = 0;
  for (const auto& period : team.period_records) {
    // In the baseline every member has a session.
    const bool is_new = period.session != last_session || period.member != last_member || period.period <= last_period;
    if (is_new) ++number;
    last_period = period.period;
    last_member = period.member;
    last_session = period.session;
    session.periods.push_back({.stage = (number - 1) * num_components + period.component - 1,
                               .minutes = minutes_of(spec.teaching.pace, period.demonstrations, period.tests,
                                                     spec.group.discussion.choice.is_held())});
  }
  return session;
}

std::vector<PastSession> imagine_sessions(const Atlas& atlas, TeachingCache& cache, const StudySpec& spec,
                                          const std::string& strategy, const std::string& composition, std::size_t n) {
  auto imagined = spec;
  imagined.seed = RandomStream{spec.seed}.split("forecast").address();
  imagined.record = RecordLevel::kPeriod;
  imagined.exam = ExamLevel::kNone;
  imagined.forecast_sessions = 0;
  std::vector<PastSession> sessions;
  for (std::size_t replicate = 1; replicate <= n; ++replicate) {
    const auto team =
        run_team(atlas, cache, imagined, {.strategy = strategy, .composition = composition, .replicate = replicate});
    sessions.push_back(past_session(team, imagined, atlas.knowledge_components().size()));
  }
  return sessions;
}

TeamForecast forecast_of(const RemainingTime& all) {
  constexpr double kLow = 0.1, kHigh = 0.9;
  return {.periods = all.mean_periods(),
          .periods_low = all.periods_quantile(kLow),
          .periods_high = all.periods_quantile(kHigh),
          .minutes = all.mean_minutes(),
          .minutes_low = all.minutes_quantile(kLow),
          .minutes_high = all.minutes_quantile(kHigh)};
}

const std::vector<PastSession>& SessionForecasts::like(const Atlas& atlas, TeachingCache& cache, const StudySpec& spec,
                                                       const TeamAddress& address) {
  Cell* cell = nullptr;
  {
    const std::lock_guard lock{mutex_};
    auto& slot = cells_[{address.variant, address.strategy, address.composition}];
    if (!slot) slot = std::make_unique<Cell>();
    cell = slot.get();
  }
  std::call_once(cell->once, [&] {
    cell->sessions =
        imagine_sessions(atlas, cache, spec, address.strategy, address.composition, spec.forecast_sessions);
  });
  return cell->sessions;
}

}  // namespace kith
