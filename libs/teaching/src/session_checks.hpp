#pragma once

#include <stdexcept>
#include <string>

#include "kith/core/error.hpp"

namespace kith {

// What a session was made with is wrong.
inline void require(bool holds, const std::string& rule) {
  if (!holds) throw std::invalid_argument{"Session: " + rule};
}

// What a session was told is wrong.
[[noreturn]] inline void refuse(const std::string& message) { throw Error{ErrorKind::kInvalidInput, message}; }

}  // namespace kith
