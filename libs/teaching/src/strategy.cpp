#include "kith/teaching/strategy.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>

namespace kith {
namespace detail {

// The registry: one row per kind, in the order of the documentation. Each is defined in a file of its own.
StrategyKind baseline_kind();
StrategyKind individual_low_kind();
StrategyKind individual_high_kind();
StrategyKind common_kind();
StrategyKind joint_kind();
StrategyKind plan_kind();
StrategyKind oracle_kind();
StrategyKind random_kind();
StrategyKind set_cover_kind();
StrategyKind highlights_kind();

}  // namespace detail

std::span<const StrategyKind> strategy_kinds() noexcept {
  static const std::array kinds{
      detail::baseline_kind(),  detail::individual_low_kind(), detail::individual_high_kind(), detail::common_kind(),
      detail::joint_kind(),     detail::plan_kind(),           detail::oracle_kind(),          detail::random_kind(),
      detail::set_cover_kind(), detail::highlights_kind(),
  };
  return kinds;
}

const StrategyKind* find_strategy_kind(std::string_view name, std::span<const StrategyKind> kinds) noexcept {
  const auto found = std::find_if(kinds.begin(), kinds.end(), [&](const auto& kind) { return kind.name == name; });
  return found == kinds.end() ? nullptr : &*found;
}

StrategyChoice strategy_named(std::string_view name, std::span<const StrategyKind> kinds) {
  const auto* kind = find_strategy_kind(name, kinds);
  if (kind == nullptr) throw std::invalid_argument{"strategy_named: there is no strategy '" + std::string{name} + "'"};
  return {std::string{name}, *kind, ParameterValues{kind->parameters}};
}

}  // namespace kith
