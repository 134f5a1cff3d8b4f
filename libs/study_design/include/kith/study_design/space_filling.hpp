#pragma once

#include <cstddef>
#include <vector>

#include "kith/random/stream.hpp"

namespace kith {

/// A Latin hypercube: `n` points of the unit cube [0, 1)^dimension, of which each coordinate has exactly one in every
/// interval [k/n, (k+1)/n). Of `tries` such designs the one whose closest pair is farthest apart [morris1995].
/// Shape [n][dimension]. Depends on the arguments only. O(tries n^2 dimension) for tries > 1.
[[nodiscard]] std::vector<std::vector<double>> latin_hypercube(std::size_t n, std::size_t dimension, std::size_t tries,
                                                               const RandomStream& random);

}  // namespace kith
