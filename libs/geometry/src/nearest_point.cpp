#include "nearest_point.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <limits>
#include <vector>

namespace kith::detail {
namespace {

constexpr int kMostSteps = 100;
constexpr double kSlack = 1e-9;  // relative, of the squared distance

using SmallVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 8, 1>;

// The point of the affine hull of the chosen vectors that is nearest to the origin, as weights that sum to 1.
SmallVector nearest_of_hull(const SmallMatrix& gram, const std::vector<Eigen::Index>& chosen) {
  const auto n = static_cast<Eigen::Index>(chosen.size());
  SmallMatrix part(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      part(i, j) = gram(chosen[static_cast<std::size_t>(i)], chosen[static_cast<std::size_t>(j)]);
    }
  }
  // With one more in every entry the system stays regular where the hull contains the origin, and the direction of
  // the solution is the same.
  part.array() += 1.0;
  const SmallVector solution = part.partialPivLu().solve(SmallVector::Ones(n));
  return solution / solution.sum();
}

}  // namespace

double inverse_square_distance(const SmallMatrix& gram) {
  const Eigen::Index n = gram.rows();
  SmallVector weights = SmallVector::Zero(n);
  weights[0] = 1.0;
  std::vector<Eigen::Index> chosen{0};
  double best = std::numeric_limits<double>::infinity();
  for (int step = 0; step < kMostSteps; ++step) {
    const SmallVector heights = gram * weights;
    const double square = weights.dot(heights);
    Eigen::Index lowest = 0;
    const double low = heights.minCoeff(&lowest);
    if (low > 0.0) best = std::min(best, square / (low * low));
    if (low >= square * (1.0 - kSlack) || std::find(chosen.begin(), chosen.end(), lowest) != chosen.end()) break;
    chosen.push_back(lowest);
    for (;;) {
      const SmallVector target = nearest_of_hull(gram, chosen);
      if (target.minCoeff() > 0.0) {
        for (std::size_t k = 0; k < chosen.size(); ++k) weights[chosen[k]] = target[static_cast<Eigen::Index>(k)];
        break;
      }
      // Goes as far towards the target as the simplex allows, and drops the vectors that lose their weight.
      double part = 1.0;
      for (std::size_t k = 0; k < chosen.size(); ++k) {
        const double from = weights[chosen[k]];
        const double to = target[static_cast<Eigen::Index>(k)];
        if (to <= 0.0) part = std::min(part, from / (from - to));
      }
      std::vector<Eigen::Index> kept;
      for (std::size_t k = 0; k < chosen.size(); ++k) {
        double& weight = weights[chosen[k]];
        const double to = target[static_cast<Eigen::Index>(k)];
        const bool is_lost = to <= 0.0 && weight / (weight - to) <= part;
        weight = is_lost ? 0.0 : (1.0 - part) * weight + part * to;
        if (!is_lost) kept.push_back(chosen[k]);
      }
      chosen = std::move(kept);
    }
  }
  return best;
}

}  // namespace kith::detail
