#pragma once

#include <cstddef>

namespace kith {

struct PastPeriod;

/// How long people take, for times in minutes: assumptions, unless they were measured.
struct Pace {
  double demonstration_s = 10.0;  ///< Seconds to watch one.
  double test_s = 15.0;           ///< Seconds to answer one, until the slowest of the group has.
  double feedback_s = 10.0;       ///< Seconds of feedback about one.
  double discussion_s = 10.0;     ///< Seconds to talk about the answers to one, in groups that do.
  friend bool operator==(const Pace&, const Pace&) = default;
};

/// Minutes of demonstrations and tests with feedback. @param discussed  whether the group talked about its answers.
[[nodiscard]] double minutes_of(const Pace& pace, std::size_t demonstrations, std::size_t tests,
                                bool discussed = false) noexcept;
[[nodiscard]] double minutes_of(const Pace& pace, const PastPeriod& period) noexcept;

}  // namespace kith
