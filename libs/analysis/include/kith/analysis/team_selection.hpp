#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "kith/study/outcomes.hpp"
#include "kith/study/study_spec.hpp"

namespace kith {

/// The study with as little recorded as these outcomes need: teams, and an exam at the end if one of them is of it.
/// Exams change nothing else about a team.
[[nodiscard]] StudySpec recording(StudySpec spec, std::span<const StudyOutcome* const> outcomes);

/// Some of the teams of a study, pooled.
struct TeamSelection {
  std::optional<std::string> strategy;  ///< Or several, "joint+common". Missing: all but the baseline.
  std::string composition;              ///< Empty: all.
  [[nodiscard]] bool contains(const TeamAddress& address) const;
  friend bool operator==(const TeamSelection&, const TeamSelection&) = default;
};
/// "group", "baseline", "joint", "group/NNN", "joint/NNP"
[[nodiscard]] std::string to_string(const TeamSelection& selection);
/// Reads what to_string writes. Nothing if the study has no such teams.
[[nodiscard]] std::optional<TeamSelection> parse_selection(std::string_view text, const StudySpec& spec);

}  // namespace kith
