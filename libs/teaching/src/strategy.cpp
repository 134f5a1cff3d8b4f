#include "kith/teaching/strategy.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>

#include "strategy_kinds.hpp"

namespace kith {

std::span<const StrategyKind> strategy_kinds() noexcept {
  static const std::array kinds{
      detail::kBaselineKind, detail::kIndividualLowKind, detail::kIndividualHighKind,
      detail::kCommonKind,   detail::kJointKind,
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
