#include "kith/belief/aggregation.hpp"

#include <algorithm>
#include <array>

namespace kith {
namespace detail {

// The registry: one row per rule. Each is defined in a file of its own.
AggregationRule common_rule();
AggregationRule joint_rule();

}  // namespace detail

std::span<const AggregationRule> aggregation_rules() noexcept {
  static const std::array rules{detail::common_rule(), detail::joint_rule()};
  return rules;
}

const AggregationRule* find_aggregation_rule(std::string_view name) noexcept {
  const auto rules = aggregation_rules();
  const auto found = std::find_if(rules.begin(), rules.end(), [&](const auto& rule) { return rule.name == name; });
  return found == rules.end() ? nullptr : &*found;
}

}  // namespace kith
