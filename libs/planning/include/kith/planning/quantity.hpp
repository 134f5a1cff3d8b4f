#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "kith/study/records.hpp"
#include "kith/study/study_spec.hpp"

namespace kith {

/// What is measured about a team: a column of teams.csv.
enum class Quantity {
  kPeriods,
  kKnowledge,
  kCompleted,  ///< 1 or 0.
  kAreaSr,     ///< Mean solid angle of a period's demonstrations, sr.
};
/// "periods", "knowledge", "completed", "area_sr"
[[nodiscard]] std::string_view name_of(Quantity quantity) noexcept;
[[nodiscard]] std::optional<Quantity> find_quantity(std::string_view name) noexcept;
[[nodiscard]] double value_of(const TeamRecord& team, Quantity quantity) noexcept;

/// Some of the teams of a study, pooled.
struct TeamSelection {
  std::optional<std::string> strategy;  ///< Missing: every strategy but the baseline.
  std::string composition;              ///< Empty: all.
  [[nodiscard]] bool contains(const TeamAddress& address) const;
  friend bool operator==(const TeamSelection&, const TeamSelection&) = default;
};
/// "group", "baseline", "joint", "group/NNN", "joint/NNP"
[[nodiscard]] std::string to_string(const TeamSelection& selection);
/// Reads what to_string writes. Nothing if the study has no such teams.
[[nodiscard]] std::optional<TeamSelection> parse_selection(std::string_view text, const StudySpec& spec);
/// The words that a selection of this study may begin with, for messages.
[[nodiscard]] std::string selections_of(const StudySpec& spec);

}  // namespace kith
