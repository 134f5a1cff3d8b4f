#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <stdexcept>
#include <string>

#include "kith/analysis/factor.hpp"

namespace kith {

// Preconditions that most of this layer's functions share; each throws std::invalid_argument in `function`'s name.

inline void require_finite(std::span<const double> values, const char* function) {
  for (const double value : values) {
    if (!std::isfinite(value)) throw std::invalid_argument{std::string{function} + ": values must be finite"};
  }
}

inline void require_codes(const Factor& factor, std::size_t observations, const char* function) {
  const auto place = std::string{function} + ": factor '" + factor.name + "' ";
  if (factor.codes.size() != observations) throw std::invalid_argument{place + "needs one level per observation"};
  for (const auto code : factor.codes) {
    if (code >= factor.levels.size()) throw std::invalid_argument{place + "has a code that is none of its levels"};
  }
}

inline void require_confidence(double confidence, const char* function) {
  if (!(confidence > 0.0 && confidence < 1.0))
    throw std::invalid_argument{std::string{function} + ": confidence must be in (0, 1)"};
}

}  // namespace kith
