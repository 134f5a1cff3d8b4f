#include "kith/table/outcome.hpp"

#include <algorithm>
#include <array>

#include "kith/table/column_names.hpp"

namespace kith {
namespace {

constexpr std::array kOutcomes{OutcomeColumn{columns::kPeriods},
                               OutcomeColumn{columns::kKnowledge, 0.0, 1.0},
                               OutcomeColumn{columns::kCompleted, 0.0, 1.0},
                               OutcomeColumn{columns::kAreaSr},
                               OutcomeColumn{columns::kExamShareRight, 0.0, 1.0},
                               OutcomeColumn{columns::kExamRegret},
                               OutcomeColumn{columns::kExamWorstShareRight, 0.0, 1.0}};

}  // namespace

std::span<const OutcomeColumn> outcome_columns() noexcept { return kOutcomes; }

std::optional<OutcomeColumn> find_outcome(std::string_view name) noexcept {
  const auto* const found =
      std::find_if(kOutcomes.begin(), kOutcomes.end(), [&](const auto& one) { return one.name == name; });
  return found == kOutcomes.end() ? std::nullopt : std::optional{*found};
}

}  // namespace kith
