#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "kith/analysis/factor.hpp"

namespace kith::testing {

// Values that R computed; the script beside the file makes it.
inline nlohmann::json read_reference(const std::string& name) {
  const auto path = std::filesystem::path{KITH_SOURCE_DIR} / "libs/analysis/tests/reference" / name;
  std::ifstream in{path};
  if (!in) throw std::runtime_error{"cannot read " + path.string()};
  return nlohmann::json::parse(in);
}

inline Factor read_factor(const nlohmann::json& factor) {
  return {factor.at("name"), factor.at("levels"), factor.at("codes")};
}

inline std::vector<Factor> read_factors(const nlohmann::json& factors) {
  std::vector<Factor> result;
  for (const auto& factor : factors) result.push_back(read_factor(factor));
  return result;
}

// Codes are the numbers of levels, and these their names.
inline Factor numbered_factor(const std::string& name, const std::vector<std::size_t>& codes) {
  Factor factor{name, {}, codes};
  for (std::size_t level = 0; level <= *std::max_element(codes.begin(), codes.end()); ++level)
    factor.levels.push_back(std::to_string(level));
  return factor;
}

// Where both evaluate the same formulas.
inline constexpr double kRounding = 1e-10;

// |a - b| as a part of |b|; of 1 where b is 0.
inline double relative_error(double a, double b) { return std::abs(a - b) / (b == 0.0 ? 1.0 : std::abs(b)); }

}  // namespace kith::testing
