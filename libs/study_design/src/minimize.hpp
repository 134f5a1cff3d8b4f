#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "kith/random/stream.hpp"
#include "parameter_box.hpp"

namespace kith {

// A function of unit coordinates whose minimum is wanted.
using Objective = std::function<double(std::span<const double> unit)>;

// Coordinates that are given; the others are free.
using Fixed = std::vector<std::optional<double>>;

struct SamplePoint {
  std::vector<double> unit;
  double value = 0.0;
};

// A Latin hypercube of n points of the box, sorted by the objective, the least first.
[[nodiscard]] std::vector<SamplePoint> ranked_sample(const Objective& objective, const Box& box, const Fixed& fixed,
                                                     std::size_t n, const RandomStream& random);

// The minimum over a box: the best points of a sample, each improved coordinate by coordinate.
[[nodiscard]] std::vector<double> minimum(const Objective& objective, const Box& box, const Fixed& fixed,
                                          const RandomStream& random);

}  // namespace kith
