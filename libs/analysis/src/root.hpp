#pragma once

#include <boost/math/tools/roots.hpp>
#include <cstdint>

namespace kith::detail {

// The root of a function that has different signs at `low` and `high`, to `bits` binary digits (Alefeld, Potra and
// Shi).
template <typename Function>
[[nodiscard]] double root_between(double low, double high, double at_low, double at_high, unsigned bits, Function f) {
  std::uintmax_t evaluations = 200;
  const auto [from, to] = boost::math::tools::toms748_solve(
      f, low, high, at_low, at_high, boost::math::tools::eps_tolerance<double>(bits), evaluations);
  return from + (to - from) / 2.0;
}
template <typename Function>
[[nodiscard]] double root_between(double low, double high, unsigned bits, Function f) {
  return root_between(low, high, f(low), f(high), bits, f);
}

}  // namespace kith::detail
