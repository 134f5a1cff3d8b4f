#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace kith {

/// A categorical variable: which level each observation has.
struct Factor {
  std::string name;
  std::vector<std::string> levels;  ///< Different; may hold levels that no observation has.
  std::vector<std::size_t> codes;   ///< One per observation: index into levels.
  friend bool operator==(const Factor&, const Factor&) = default;
};

/// Levels in the order in which they first appear.
[[nodiscard]] Factor make_factor(std::string name, std::span<const std::string> values);

/// The values of each level, shape [levels], in their order.
/// @throws std::invalid_argument unless there is one value per observation.
[[nodiscard]] std::vector<std::vector<double>> split_by(std::span<const double> values, const Factor& factor);

/// Levels "a:b" for every pair of levels of the two factors, the first slowest; pairs without observations included.
[[nodiscard]] Factor interaction(const Factor& a, const Factor& b);

/// The factor without the levels that no observation has.
[[nodiscard]] Factor drop_unused(const Factor& factor);

}  // namespace kith
