#pragma once

#include <functional>
#include <vector>

namespace kith::detail {

struct Minimum {
  std::vector<double> x;
  double value = 0.0;
};

// The simplex search of Nelder and Mead [nelder1965] from `start`, whose first simplex has one corner `step` away along
// each axis. It stops when the values of the corners differ by less than `tolerance`, or after max_calls.
[[nodiscard]] Minimum nelder_mead(const std::function<double(const std::vector<double>&)>& f,
                                  const std::vector<double>& start, double step, double tolerance = 1e-5,
                                  std::size_t max_calls = 600);

}  // namespace kith::detail
