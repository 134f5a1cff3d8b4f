#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kith/bec/atlas.hpp"
#include "kith/study_design/targets.hpp"

namespace kith {

/// What a model makes of one target.
struct TargetOutcome {
  double model = 0.0;
  /// By the jackknife over replicates, which keeps the teams of the same people together.
  double standard_error = 0.0;
  /// (model - published) over the standard error of that difference: the published one and the model's, together.
  double misfit = 0.0;
  double miss = 0.0;  ///< In tolerances, signed: within [-1, 1] as close as was wished.
};

/// One setting of the parameters, simulated.
struct CalibrationPoint {
  std::string label;           ///< "the study as it is", "minimum", ...
  std::vector<double> values;  ///< One per parameter.
  std::size_t teams_per_cell = 0;
  std::vector<TargetOutcome> targets;
  /// r' V^-1 r >= 0, r the misses in published standard errors and V their covariance, Calibration::discrepancy
  /// included. Settings whose misfits differ by less than ParameterRange names do not differ significantly in one
  /// parameter.
  double misfit = 0.0;
};

/// The 95 % interval of one parameter: the values at which the misfit, the other parameters adjusted, exceeds its
/// minimum by at most 3.84 (chi-squared, one degree of freedom) or, if there is a discrepancy, by the square of the
/// 97.5 % quantile of Student's t with Calibration::degrees_of_freedom [knapp2003]. Contains the calibrated value.
struct ParameterRange {
  double low = 0.0;
  double high = 0.0;
  bool open_low = false;   ///< The targets set no limit: the interval goes down to the end of the last design, which is
                           ///< min unless `low` is larger.
  bool open_high = false;  ///< Up to its other end.
};

/// What a parameter does to a target's figure, over the whole ranges, by the quadratic fitted to the first design.
struct Sensitivity {
  double main_share = 0.0;   ///< Of the variance, in [0, 1]: by this parameter alone [sobol2001].
  double total_share = 0.0;  ///< And with all terms that it is part of.
  double slope = 0.0;        ///< From the lower to the upper end, others at the centre, in the figure's unit.
};

/// Two targets that pull in different directions.
struct Conflict {
  std::size_t first = 0;  ///< Indices of targets.
  std::size_t second = 0;
  /// The smallest value that the larger of the two |misses| takes over all settings, by the quadratics, in published
  /// standard errors.
  double closest = 0.0;
};

/// A point of the trade-off between two quantities.
struct FrontierPoint {
  CalibrationPoint point;
  /// Root mean square of the misses of the first quantity's means, in published standard errors.
  double first_error = 0.0;
  double second_error = 0.0;
};

struct CalibrationOptions {
  std::size_t rounds = 3;           ///< Designs, each in a smaller box than the one before.
  std::size_t points = 64;          ///< Settings per design.
  std::size_t teams = 40;           ///< Per cell, for each setting of the last design.
  std::size_t confirm_teams = 200;  ///< Per cell, fresh ones, for the candidates; half as many on the frontier.
  std::size_t frontier_points = 7;  ///< 0: no frontier.
  std::uint64_t seed = 1;
  std::size_t threads = 0;  ///< Changes the speed, never a result.
  /// As in RunOptions; counts teams. The total is exact from the last design on and an upper bound before.
  std::function<bool(std::size_t done, std::size_t total)> on_progress{};
};

struct Calibration {
  CalibrationPoint best;
  std::vector<CalibrationPoint> candidates;  ///< All that were confirmed, the study as it is first.
  std::vector<ParameterRange> ranges;        ///< One per parameter.
  /// Standard deviation of what the model cannot remove, in published standard errors, one for all targets: the misfit
  /// that is left beyond chance. 0: the model agrees with the targets as well as chance allows.
  double discrepancy = 0.0;
  double least_misfit = 0.0;        ///< Without discrepancy, by the quadratics.
  double degrees_of_freedom = 0.0;  ///< Of it: targets less the parameters that they determine.
  /// P(chi-squared >= least_misfit); missing if no degree of freedom is left to judge by.
  std::optional<double> misfit_p;
  std::vector<double> surface_error, explained;             ///< Of the last quadratics, one per target.
  std::vector<std::vector<Sensitivity>> sensitivities;      ///< Shape [targets][parameters].
  std::vector<double> sensitivity_explained;                ///< By the first quadratics, one per target.
  std::vector<Conflict> conflicts;                          ///< Worst first; only pairs whose members can be met alone.
  std::optional<Quantity> first_quantity, second_quantity;  ///< Of the frontier; missing without one.
  std::vector<FrontierPoint> frontier;                      ///< Not dominated by each other; first_error rises.
  std::size_t teams_simulated = 0;
};

/// The most teams that calibrate() simulates in every cell of the design.
[[nodiscard]] std::size_t most_teams_per_cell(const CalibrationOptions& options);

/// Fits the free parameters of a study to published figures by simulation.
///
/// A maximin Latin hypercube over the box, simulated with common random numbers, gives a quadratic per target. With r
/// the misses in published standard errors, the misfit is r' V^-1 r; V has the published errors (correlated as the
/// simulated figures are), those of simulation and quadratics, and a model discrepancy of one variance for all targets
/// [kennedy2001], at which the least misfit is what chance leaves [paule1982]. Where the misfit is small the next,
/// smaller design is placed, with twice the teams, and so on. The minimum is simulated with fresh seeds and more teams,
/// the quadratics are moved to what that says, and their new minimum and the setting that leaves as many parameters as
/// possible as they are get simulated, too. Among all candidates, the study as it is included, whose misfit is within 1
/// of the least and that miss no more tolerances, the one that changes least is the answer. Values are rounded to the
/// digits that matter; intervals are profiles of the misfit.
/// @param targets  with at least one target and one parameter.
/// @return nothing if on_progress stopped it.
/// @throws std::invalid_argument without targets or parameters or with counts below 2 (teams) or 8 (points).
/// @throws kith::Error if the study refuses a combination of values.
[[nodiscard]] std::optional<Calibration> calibrate(const Atlas& atlas, const StudyMaker& make_study,
                                                   const TargetSet& targets, const CalibrationOptions& options = {});

}  // namespace kith
