#pragma once

#include <limits>
#include <optional>
#include <span>
#include <string_view>

namespace kith {

/// An outcome of a team, a column of teams.csv, and what values it can have.
struct OutcomeColumn {
  std::string_view name;
  double low = 0.0;
  double high = std::numeric_limits<double>::infinity();  ///< Infinite: as large as may be.
};

/// All of them: periods, knowledge, completed, area_sr and those of the exam.
[[nodiscard]] std::span<const OutcomeColumn> outcome_columns() noexcept;
/// Nothing if no outcome has this name.
[[nodiscard]] std::optional<OutcomeColumn> find_outcome(std::string_view name) noexcept;

}  // namespace kith
