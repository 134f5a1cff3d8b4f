#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kith/core/diagnostic.hpp"
#include "kith/planning/effect.hpp"
#include "kith/planning/quantity.hpp"
#include "kith/study/study_file.hpp"

namespace kith {

enum class Statistic { kMean, kSd };

/// One published figure that a study should meet.
struct Target {
  Quantity quantity = Quantity::kPeriods;
  Statistic statistic = Statistic::kMean;  ///< Over the selected teams, pooled; the standard deviation with n - 1.
  TeamSelection teams;
  double value = 0.0;
  double tolerance = 1.0;    ///< > 0: as far as the model may be off; a factor > 1 if `is_factor`.
  bool is_factor = false;    ///< Off by a factor instead of a difference.
  std::size_t priority = 1;  ///< 1 is the most important.
  std::string source;
};
/// "periods of group, mean"
[[nodiscard]] std::string to_string(const Target& target);
/// How far a model's figure is off, in tolerances, with its sign: (model - value) / tolerance, or
/// log(model / value) / log(tolerance). Within the tolerance: [-1, 1].
[[nodiscard]] double miss(const Target& target, double model);

/// A parameter that calibration may move: one number that sets one or several keys of the study.
struct FreeParameter {
  std::string name;
  std::vector<std::string> keys;  ///< Dotted; no wildcards any more.
  double min = 0.0;
  double max = 1.0;  ///< > min
  bool logarithmic = false;
  bool integer = false;
  double present = 0.0;  ///< What the study has; of the first key, if they differ.
};

/// A published test.
struct PublishedFinding {
  Effect effect;
  bool significant = false;
  double alpha = 0.05;
  std::optional<double> f, df1, df2;  ///< The published statistic, all three or none.
  std::string source;
};

/// What a targets file says (schema kith.targets/1, see docs/calibration.md).
struct TargetSet {
  std::string title;
  std::vector<Target> targets;
  std::vector<FreeParameter> parameters;
  std::vector<PublishedFinding> findings;
};

/// Reads the study with these overrides ("KEY=VALUE") applied last.
using StudyMaker = std::function<StudyReading(const std::vector<std::string>& overrides)>;

struct TargetsReading {
  std::optional<TargetSet> targets;  ///< Unless there are errors.
  std::vector<Diagnostic> diagnostics;
};
/// Parses and checks a targets file against a study. Never throws for bad content.
/// @param make_study  is asked whether the parameters' keys exist and take the values at both ends of their ranges.
/// @pre make_study({}) reads a study without errors.
[[nodiscard]] TargetsReading parse_targets(std::string_view text, const std::string& name,
                                           const StudyMaker& make_study);

/// The overrides that set these values, one per parameter, in shortest round-trip form; integers are rounded.
[[nodiscard]] std::vector<std::string> overrides_of(const std::vector<FreeParameter>& parameters,
                                                    const std::vector<double>& values);

}  // namespace kith
