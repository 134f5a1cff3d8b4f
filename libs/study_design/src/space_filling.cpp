#include "kith/study_design/space_filling.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

#include "kith/random/distributions.hpp"

namespace kith {
namespace {

using Points = std::vector<std::vector<double>>;

Points one_design(std::size_t n, std::size_t dimension, RandomStream random) {
  Points points(n, std::vector<double>(dimension));
  std::vector<std::size_t> order(n);
  for (std::size_t k = 0; k < dimension; ++k) {
    std::iota(order.begin(), order.end(), std::size_t{0});
    for (std::size_t i = n; i > 1; --i) std::swap(order[i - 1], order[uniform_index(i, random)]);
    for (std::size_t i = 0; i < n; ++i)
      points[i][k] = (static_cast<double>(order[i]) + uniform01(random)) / static_cast<double>(n);
  }
  return points;
}

double smallest_squared_distance(const Points& points) {
  double smallest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      double sum = 0.0;
      for (std::size_t k = 0; k < points[i].size(); ++k)
        sum += (points[i][k] - points[j][k]) * (points[i][k] - points[j][k]);
      smallest = std::min(smallest, sum);
    }
  }
  return smallest;
}

}  // namespace

Points latin_hypercube(std::size_t n, std::size_t dimension, std::size_t tries, const RandomStream& random) {
  auto best = one_design(n, dimension, random.split(0));
  if (tries <= 1) return best;
  double distance = smallest_squared_distance(best);
  for (std::size_t t = 1; t < tries; ++t) {
    auto design = one_design(n, dimension, random.split(t));
    const double other = smallest_squared_distance(design);
    if (other > distance) {
      distance = other;
      best = std::move(design);
    }
  }
  return best;
}

}  // namespace kith
