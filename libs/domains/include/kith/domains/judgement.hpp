#pragma once

#include "kith/domains/domain.hpp"

namespace kith {

/// What a path costs the robot beside its own path from the same start.
struct PathJudgement {
  /// mu(robot) - mu(path) in units of 1 / Domain::count_scale(), shape [d].
  IntegerVector loss;
  /// w . loss in counts, with the weights at the domain's length 1. Exactly 0 if the two are as good as equal, < 0 only
  /// if the path is better.
  double regret = 0.0;
  /// The same with the weights as the domain file states them (RewardWeights::raw).
  double raw_regret = 0.0;
  /// Whether the path is as good as the robot's, or better.
  bool is_right = false;
  /// Whether it is better: no path can be, if the robot's is optimal.
  bool is_better = false;
};

/// Says whether a path is right. There is no other judge: tests, exams, screening, lessons and tables ask this one.
///
/// In exact domains (Domain::is_exact()) two paths are equally good if w . loss is 0, an integer. In all others feature
/// counts are expectations, known to 1 / count_scale() each, of policies that are optimal up to 1e-9 of the return in
/// every step (BehaveOptions::tolerance). There two paths are equally good if, with weights of Euclidean length 1,
///   |w . loss| <= max(1e-6 * max(1, |w . mu(robot)|), 2 sqrt(d) / count_scale()),
/// which is what a thousand steps and the rounding of both counts may add up to. It does not depend on how the weights
/// of the file are scaled nor on how returns are shown (WeightNorm).
/// @param robot, path  feature counts in units of 1 / count_scale(), shape [d]. Exact domains use their difference
/// only.
/// @throws std::invalid_argument unless both have d entries.
[[nodiscard]] PathJudgement judge_path(const Domain& domain, const IntegerVector& robot, const IntegerVector& path);

}  // namespace kith
