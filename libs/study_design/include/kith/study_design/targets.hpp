#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kith/core/diagnostic.hpp"
#include "kith/study/study_file.hpp"
#include "kith/study_design/effect.hpp"
#include "kith/study_design/quantity.hpp"

namespace kith {

enum class Statistic {
  kMean,
  kSd,
  kF,  ///< Of a term of the group strategies' analysis of variance.
};

/// One published figure that a study should meet.
struct Target {
  Quantity quantity = Quantity::kPeriods;
  Statistic statistic = Statistic::kMean;  ///< Over the selected teams, pooled; the standard deviation with n - 1.
  TeamSelection teams;                     ///< Not of kF.
  double value = 0.0;
  double tolerance = 1.0;    ///< > 0: as far as the model may be off; a factor > 1 if `is_factor`.
  bool is_factor = false;    ///< Off by a factor instead of a difference.
  std::size_t priority = 1;  ///< 1 is the most important: the frontier is between the first two quantities.
  std::string source;
  /// Of the published value, in its own unit, > 0. Missing: the tolerance is taken for two standard errors.
  std::optional<double> standard_error = std::nullopt;
  std::optional<Effect> effect = std::nullopt;  ///< Of kF: an analysis-of-variance term.
  double df1 = 0.0;                             ///< Of kF, as published.
  double df2 = 0.0;                             ///< > 4
};
/// "periods of group, mean", "F of periods: composition"
[[nodiscard]] std::string to_string(const Target& target);
/// How far a model's figure is off, in tolerances, with its sign: (model - value) / tolerance, or
/// log(model / value) / log(tolerance). Within the tolerance: [-1, 1].
[[nodiscard]] double miss(const Target& target, double model);
/// The scale on which figures are compared: the figure itself, or its logarithm for a target met within a factor.
[[nodiscard]] double compared(const Target& target, double figure);
/// A standard error of a figure of this size, on that scale.
[[nodiscard]] double compared_error(const Target& target, double figure, double standard_error);
/// The published standard error on that scale; half a tolerance where none is published. > 0.
[[nodiscard]] double published_error(const Target& target);
/// Expected value and standard deviation of a published F at a non-centrality >= 0: those of the non-central F
/// distribution with df1 and df2 > 4 degrees of freedom [johnson1995, chapter 30].
struct FMoments {
  double mean = 0.0;
  double sd = 0.0;
};
[[nodiscard]] FMoments f_moments(double df1, double df2, double non_centrality);

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
