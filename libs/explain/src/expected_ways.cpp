#include "kith/explain/expected_ways.hpp"

#include <algorithm>
#include <map>

#include "kith/geometry/cover.hpp"

namespace kith {

std::vector<ExpectedWay> expected_ways(Behaviours& behaviours, StartIndex start, std::size_t n) {
  const Eigen::MatrixXd people = cover(behaviours.atlas().prior_cone(), n, behaviours.atlas().feature_order());
  std::map<IntegerVector, ExpectedWay> by_counts;
  double all = 0.0;
  for (Eigen::Index i = 0; i < people.cols(); ++i) {
    const Direction weights = people.col(i);
    const auto counts = behaviours.answer(start, behaviours.locate(weights));
    if (!counts) continue;
    by_counts.try_emplace(*counts, ExpectedWay{*counts, weights, 0.0}).first->second.share += 1.0;
    all += 1.0;
  }
  std::vector<ExpectedWay> ways;
  for (auto& [counts, way] : by_counts) {
    way.share /= all;
    ways.push_back(std::move(way));
  }
  std::ranges::stable_sort(ways, std::ranges::greater{}, &ExpectedWay::share);
  return ways;
}

}  // namespace kith
