#include "kith/domains/judgement.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <stdexcept>

#include "kith/domains/file_units.hpp"

namespace kith {
namespace {

constexpr double kRelativeError = 1e-6;

// Two returns of expected counts that differ by less are equal, in counts times weights of length 1.
double tolerance(const Domain& domain, const IntegerVector& robot) {
  const auto& unit = domain.weights().unit;
  const auto scale = static_cast<double>(domain.count_scale());
  const double value = std::abs(dot(robot, std::span{unit.data(), robot.size()})) / scale;
  const double rounding = 2.0 * std::sqrt(static_cast<double>(robot.size())) / scale;
  return std::max(kRelativeError * std::max(1.0, value), rounding);
}

}  // namespace

PathJudgement judge_path(const Domain& domain, const IntegerVector& robot, const IntegerVector& path) {
  const auto& weights = domain.weights();
  if (robot.size() != domain.num_features() || path.size() != robot.size()) {
    throw std::invalid_argument{"judge_path: there must be one count per feature"};
  }
  PathJudgement result;
  result.loss = robot - path;
  const auto scale = static_cast<double>(domain.count_scale());
  const int sign = sign_of_dot(weights.integer, result.loss);
  const bool is_equal =
      sign == 0 ||
      (!domain.is_exact() &&
       std::abs(dot(result.loss, std::span{weights.unit.data(), robot.size()})) / scale <= tolerance(domain, robot));
  result.is_right = is_equal || sign < 0;
  result.is_better = !is_equal && sign < 0;
  if (is_equal) return result;
  result.regret = weights.return_of(result.loss) / scale;
  result.raw_regret = dot(result.loss, weights.raw) / scale;
  return result;
}

double in_file_units(const RewardWeights& weights, double value) {
  if (weights.raw.empty()) return value;
  double length = 0.0;
  for (const double x : weights.raw) length += weights.norm == WeightNorm::kL1 ? std::abs(x) : x * x;
  if (weights.norm == WeightNorm::kL2) length = std::sqrt(length);
  std::array<char, 32> digits{};
  const auto written = std::to_chars(digits.begin(), digits.end(), value * length, std::chars_format::general, 15);
  std::from_chars(digits.begin(), written.ptr, value);
  return value;
}

}  // namespace kith
