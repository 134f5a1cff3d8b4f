#pragma once

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

#include "kith/core/error.hpp"

namespace kith {

// What a session was made with is wrong.
inline void require(bool holds, const std::string& rule) {
  if (!holds) throw std::invalid_argument{"Session: " + rule};
}

// What a session was told is wrong.
[[noreturn]] inline void refuse(const std::string& message) { throw Error{ErrorKind::kInvalidInput, message}; }

inline bool nobody(const std::vector<bool>& present) {
  return std::find(present.begin(), present.end(), true) == present.end();
}

}  // namespace kith
