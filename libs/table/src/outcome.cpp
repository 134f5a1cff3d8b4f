#include "kith/table/outcome.hpp"

#include <algorithm>
#include <array>

namespace kith {
namespace {

constexpr std::array kOutcomes{OutcomeColumn{"periods"},
                               OutcomeColumn{"knowledge", 0.0, 1.0},
                               OutcomeColumn{"completed", 0.0, 1.0},
                               OutcomeColumn{"area_sr"},
                               OutcomeColumn{"exam_share_right", 0.0, 1.0},
                               OutcomeColumn{"exam_regret"},
                               OutcomeColumn{"exam_worst_share_right", 0.0, 1.0}};

}  // namespace

std::span<const OutcomeColumn> outcome_columns() noexcept { return kOutcomes; }

std::optional<OutcomeColumn> find_outcome(std::string_view name) noexcept {
  const auto* const found =
      std::find_if(kOutcomes.begin(), kOutcomes.end(), [&](const auto& one) { return one.name == name; });
  return found == kOutcomes.end() ? std::nullopt : std::optional{*found};
}

}  // namespace kith
