#pragma once

#include <algorithm>
#include <chrono>

namespace kith {

/// Lets `rate` things per second pass, and at most `burst` at once.
class TokenBucket {
 public:
  using Time = std::chrono::steady_clock::time_point;

  TokenBucket(double rate, double burst, Time now) : rate_{rate}, burst_{burst}, tokens_{burst}, filled_{now} {}

  /// Whether one more may pass at `now`, which must not go back.
  [[nodiscard]] bool take(Time now) {
    const std::chrono::duration<double> elapsed = now - filled_;
    tokens_ = std::min(burst_, tokens_ + rate_ * elapsed.count());
    filled_ = now;
    if (tokens_ < 1.0) return false;
    tokens_ -= 1.0;
    return true;
  }

 private:
  double rate_;
  double burst_;
  double tokens_;
  Time filled_;
};

}  // namespace kith
