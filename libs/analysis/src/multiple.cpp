#include "kith/analysis/multiple.hpp"

#include <algorithm>
#include <numeric>
#include <stdexcept>

namespace kith {

std::string_view to_string(Correction correction) noexcept {
  switch (correction) {
    case Correction::kBonferroni:
      return "Bonferroni";
    case Correction::kHolm:
      return "Holm";
    case Correction::kFdr:
      return "Benjamini-Hochberg";
    case Correction::kNone:
      break;
  }
  return "none";
}

namespace {

// Holm: the smallest p counts n times, the next n - 1 times. `order` ascends.
void step_down(const std::vector<std::size_t>& order, std::vector<double>& p) {
  double largest = 0.0;
  for (std::size_t rank = 0; rank < order.size(); ++rank) {
    largest = std::max(largest, p[order[rank]] * static_cast<double>(order.size() - rank));
    p[order[rank]] = std::min(1.0, largest);
  }
}

// Benjamini and Hochberg: the largest p counts once, the one before it n / (n - 1) times.
void step_up(const std::vector<std::size_t>& order, std::vector<double>& p) {
  double smallest = 1.0;
  for (auto rank = order.size(); rank-- > 0;) {
    smallest = std::min(smallest, p[order[rank]] * (static_cast<double>(order.size()) / static_cast<double>(rank + 1)));
    p[order[rank]] = smallest;
  }
}

}  // namespace

std::vector<double> adjust(std::span<const double> p_values, Correction correction) {
  for (const double p : p_values) {
    if (!(p >= 0.0 && p <= 1.0)) throw std::invalid_argument{"adjust: p-values must be in [0, 1]"};
  }
  std::vector<double> adjusted{p_values.begin(), p_values.end()};
  const auto n = adjusted.size();
  if (correction == Correction::kBonferroni) {
    for (auto& p : adjusted) p = std::min(1.0, p * static_cast<double>(n));
  } else if (correction != Correction::kNone) {
    std::vector<std::size_t> order(n);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](auto i, auto j) { return p_values[i] < p_values[j]; });
    if (correction == Correction::kHolm) {
      step_down(order, adjusted);
    } else {
      step_up(order, adjusted);
    }
  }
  return adjusted;
}

}  // namespace kith
