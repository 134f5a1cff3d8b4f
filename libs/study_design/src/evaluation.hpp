#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "kith/study/study.hpp"
#include "kith/study_design/calibration.hpp"
#include "kith/study_design/power.hpp"

namespace kith {

// The figures of one simulated setting, and again without each replicate.
struct Evaluation {
  std::vector<double> figures;               // [targets]
  std::vector<std::vector<double>> without;  // [replicates][targets]
};

[[nodiscard]] Evaluation evaluate(std::span<const Target> targets, const TeamPool& pool);

// Jackknife covariance of the figures of one setting, on the scale of comparison and in published standard errors,
// shape [targets, targets].
[[nodiscard]] Eigen::MatrixXd covariance_of(std::span<const Target> targets, const Evaluation& evaluation);

// How far figures are off, in published standard errors.
[[nodiscard]] std::vector<double> misses_of(std::span<const Target> targets, std::span<const double> figures);

[[nodiscard]] CalibrationPoint point_of(std::span<const Target> targets, const Evaluation& evaluation,
                                        std::vector<double> values, std::string label);

// Simulates settings; counts the teams.
class Laboratory {
 public:
  Laboratory(const Atlas& atlas, const StudyMaker& make_study, const TargetSet& set, const CalibrationOptions& options);

  // Teams per cell times cells.
  [[nodiscard]] std::size_t cost(std::size_t settings, std::size_t teams) const { return settings * teams * cells_; }
  void expect(std::size_t total) { total_ = total; }
  [[nodiscard]] std::size_t done() const { return done_; }

  // Nothing if the run was stopped. Settings share their people and chance.
  [[nodiscard]] std::optional<std::vector<Evaluation>> run(const std::vector<std::vector<double>>& settings,
                                                           std::size_t teams, std::uint64_t seed);

 private:
  const Atlas& atlas_;
  StudyMaker make_study_;
  const TargetSet& set_;
  const CalibrationOptions& options_;
  std::vector<Quantity> quantities_;  // of the targets
  std::size_t cells_ = 0;
  std::size_t done_ = 0;
  std::size_t total_ = 0;
};

}  // namespace kith
