#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "kith/study_design/targets.hpp"

namespace kith {

// Settings as points of the unit cube: 0 is a parameter's min, 1 its max, on its own scale.
[[nodiscard]] std::vector<double> to_unit(const std::vector<FreeParameter>& parameters, std::span<const double> values);
[[nodiscard]] std::vector<double> to_values(const std::vector<FreeParameter>& parameters, std::span<const double> unit);

// A part of the unit cube.
struct Box {
  std::vector<double> low, high;

  [[nodiscard]] static Box whole(std::size_t dimension) {
    return {std::vector<double>(dimension, 0.0), std::vector<double>(dimension, 1.0)};
  }
  // [0, 1]^d to the box, and the box to [-1, 1]^d.
  [[nodiscard]] std::vector<double> place(std::span<const double> fraction) const;
  [[nodiscard]] std::vector<double> local(std::span<const double> unit) const;
  // Whether the point is in the box, or within `margin` of its width around it.
  [[nodiscard]] bool contains(std::span<const double> unit, double margin) const;
};

// The value rounded to the largest power of ten that is at most half the width of its range.
[[nodiscard]] double rounded(double value, double low, double high, bool integer);

}  // namespace kith
