#include "kith/belief/aggregation.hpp"

#include <algorithm>
#include <array>

#include "aggregation_rules.hpp"

namespace kith {

std::span<const AggregationRule> aggregation_rules() noexcept {
  static const std::array rules{detail::kCommonRule, detail::kJointRule};
  return rules;
}

const AggregationRule* find_aggregation_rule(std::string_view name) noexcept {
  const auto rules = aggregation_rules();
  const auto found = std::find_if(rules.begin(), rules.end(), [&](const auto& rule) { return rule.name == name; });
  return found == rules.end() ? nullptr : &*found;
}

}  // namespace kith
