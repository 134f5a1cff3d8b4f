#pragma once

#include <cstddef>
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
  // Of the exam at the end, see TeamExam; only if the teams were examined:
  kExamShareRight,       ///< Mean over members of the share of all starts that they answer right, in [0, 1].
  kExamRegret,           ///< Mean over members, in the units of the domain file's weights.
  kExamWorstShareRight,  ///< The smallest share of a member.
};
inline constexpr std::size_t kNumQuantities = 7;  ///< As many as there are outcome_columns(), in the same order.
/// "periods", "knowledge", "completed", "area_sr", "exam_share_right", "exam_regret", "exam_worst_share_right"
[[nodiscard]] std::string_view name_of(Quantity quantity) noexcept;
[[nodiscard]] std::optional<Quantity> find_quantity(std::string_view name) noexcept;
/// All of these names, in the order of the enumerators.
[[nodiscard]] std::span<const std::string_view> quantity_names() noexcept;
/// Whether only an exam gives it.
[[nodiscard]] constexpr bool is_of_exam(Quantity quantity) noexcept { return quantity >= Quantity::kExamShareRight; }
/// @throws std::invalid_argument for a quantity of the exam of a team that was not examined.
[[nodiscard]] double value_of(const TeamRecord& team, Quantity quantity);
/// The study with as little recorded as these quantities need: teams, and an exam at the end if one of them is of it.
/// Exams change nothing else about a team.
[[nodiscard]] StudySpec recording(StudySpec spec, std::span<const Quantity> quantities);

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
/// The words that a selection of this study may begin with, for messages.
[[nodiscard]] std::string selections_of(const StudySpec& spec);

}  // namespace kith
