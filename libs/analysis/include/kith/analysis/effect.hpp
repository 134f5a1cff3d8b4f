#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kith/study/outcomes.hpp"
#include "kith/study/study_spec.hpp"

namespace kith {

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

/// An effect that a study may be planned to show.
struct Effect {
  enum class Kind {
    kStrategy,        ///< Main effect of the group strategies (without the baseline), two-way analysis of variance.
    kComposition,     ///< Main effect of the compositions, in the same analysis.
    kInteraction,     ///< Strategy by composition, in the same analysis.
    kStrategyWithin,  ///< One-way analysis of the group strategies within one composition, Bonferroni over all of them.
    kContrast,        ///< Mean of some teams minus that of others.
  };
  const StudyOutcome* outcome = &outcomes().front();  ///< Not null.
  Kind kind = Kind::kStrategy;
  std::string composition;      ///< Of kStrategyWithin.
  TeamSelection first, second;  ///< Of kContrast: first - second.
  /// The size of the effect, if it is not the one that the study's own model has: partial eta squared in (0, 1), or for
  /// kContrast the difference, in the outcome's unit, not 0.
  std::optional<double> imposed;
};

/// "periods: strategy", "knowledge: strategy x composition", "knowledge: joint - common = 0.05", "periods: strategy in
/// NNN eta2 = 0.1"
[[nodiscard]] std::string to_string(const Effect& effect);

struct EffectReading {
  std::optional<Effect> effect;
  std::string problem;  ///< Without an effect: why, a clause.
  std::string hint;
};
/// Reads `QUANTITY: TERM [eta2 = X]`, where TERM is `strategy`, `composition`, `strategy x composition` or `strategy in
/// COMPOSITION`, or `QUANTITY: TEAMS - TEAMS [= X]`, where TEAMS are as in parse_selection and blanks surround `-`.
[[nodiscard]] EffectReading parse_effect(std::string_view text, const StudySpec& spec);

/// What a planned contrast ([[contrast]]) compares, as effects on its outcome, or on all that the study analyses.
/// None for weights that are not the mean of some levels minus that of others.
[[nodiscard]] std::vector<Effect> effects_of(const StudyContrast& contrast, const StudySpec& spec);

/// The study with as little recorded as these outcomes need: teams, and an exam at the end if one of them is of it.
/// Exams change nothing else about a team.
[[nodiscard]] StudySpec recording(StudySpec spec, std::span<const StudyOutcome* const> outcomes);

}  // namespace kith
