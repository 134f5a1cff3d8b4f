#include "nelder_mead.hpp"

#include <algorithm>

namespace kith::detail {
namespace {

std::vector<double> between(const std::vector<double>& a, const std::vector<double>& b, double t) {
  std::vector<double> result(a.size());
  for (std::size_t k = 0; k < a.size(); ++k) result[k] = a[k] + t * (b[k] - a[k]);
  return result;
}

}  // namespace

Minimum nelder_mead(const std::function<double(const std::vector<double>&)>& f, const std::vector<double>& start,
                    double step, double tolerance, std::size_t max_calls) {
  std::size_t calls = 0;
  const auto evaluated = [&](std::vector<double> x) {
    ++calls;
    const double value = f(x);
    return Minimum{std::move(x), value};
  };
  const auto less = [](const Minimum& a, const Minimum& b) { return a.value < b.value; };
  std::vector<Minimum> corners{evaluated(start)};
  if (start.empty()) return corners.front();
  for (std::size_t k = 0; k < start.size(); ++k) {
    auto x = start;
    x[k] += step;
    corners.push_back(evaluated(std::move(x)));
  }
  while (calls < max_calls) {
    std::stable_sort(corners.begin(), corners.end(), less);
    auto& worst = corners.back();
    if (worst.value - corners.front().value < tolerance) break;
    std::vector<double> centre(start.size(), 0.0);
    for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
      for (std::size_t k = 0; k < centre.size(); ++k) centre[k] += corners[i].x[k] / static_cast<double>(start.size());
    }
    auto reflected = evaluated(between(centre, worst.x, -1.0));
    if (reflected.value < corners.front().value) {
      auto expanded = evaluated(between(centre, worst.x, -2.0));
      worst = expanded.value < reflected.value ? std::move(expanded) : std::move(reflected);
    } else if (reflected.value < corners[corners.size() - 2].value) {
      worst = std::move(reflected);
    } else {
      auto contracted = evaluated(between(centre, worst.x, reflected.value < worst.value ? -0.5 : 0.5));
      if (contracted.value < std::min(worst.value, reflected.value)) {
        worst = std::move(contracted);
      } else {
        for (std::size_t i = 1; i < corners.size(); ++i)
          corners[i] = evaluated(between(corners[0].x, corners[i].x, 0.5));
      }
    }
  }
  return *std::min_element(corners.begin(), corners.end(), less);
}

}  // namespace kith::detail
