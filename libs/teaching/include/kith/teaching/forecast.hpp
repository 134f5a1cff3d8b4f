#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace kith {

/// A session that is over, as far as forecasts need it. Stages are what is taught one after the other: the components
/// of a session or, for a team that is taught in several sessions, those of all sessions in their order.
struct PastSession {
  struct Period {
    std::size_t stage = 0;
    double minutes = 0.0;
  };
  std::vector<Period> periods;  ///< Stages ascend.
  bool completed = true;        ///< False: stopped before everything was learned.
};

/// Where a session stands, between two periods.
struct SessionPlace {
  std::size_t stage = 0;    ///< What is taught next.
  std::size_t periods = 0;  ///< Periods of this stage so far.
};

/// What is left of a session, as a distribution: cases of equal probability.
class RemainingTime {
 public:
  struct Case {
    std::size_t periods = 0;
    double minutes = 0.0;
    bool completed = true;  ///< False: the session ends with something not learned.
  };
  /// @throws std::invalid_argument without cases.
  explicit RemainingTime(std::vector<Case> cases);

  [[nodiscard]] std::span<const Case> cases() const noexcept { return cases_; }
  [[nodiscard]] double mean_periods() const;
  [[nodiscard]] double mean_minutes() const;
  /// The smallest number that at least a share q of the cases does not exceed. @pre 0 <= q <= 1.
  [[nodiscard]] double periods_quantile(double q) const;
  [[nodiscard]] double minutes_quantile(double q) const;
  /// Probability that everything is learned after at most so many more periods.
  [[nodiscard]] double done_within(std::size_t periods) const;
  /// The same with all minutes multiplied: people who take longer than assumed. @pre factor >= 0.
  [[nodiscard]] RemainingTime at_pace(double factor) const;

 private:
  std::vector<Case> cases_;
};

/// What is left, from sessions of the same kind: what was left of those that had got as far, that is, that spent more
/// periods on the stage than this one has. If fewer than a twentieth did, this session may be of another kind, such as
/// that of people whom lessons do not reach: it makes up the twentieth, or everything if none did, with cases in which
/// the stage needs at least k periods more with probability t / (t + k - 1) after t of them, at most 9 t, and the later
/// stages what they needed in the other sessions.
/// @throws std::invalid_argument without sessions.
[[nodiscard]] RemainingTime forecast_remaining(std::span<const PastSession> sessions, const SessionPlace& place);

/// What is left if nothing is known of other sessions: every open component takes as many periods as the earlier ones
/// did on average, and at least one; a case for each past period, whose minutes all later ones take.
/// @param minutes  of each past period. @param most_periods  that are left at most.
/// @throws std::invalid_argument without past periods.
[[nodiscard]] RemainingTime extrapolate_remaining(std::size_t open_components, std::size_t learned_components,
                                                  std::size_t periods, std::size_t most_periods,
                                                  std::span<const double> minutes);

}  // namespace kith
