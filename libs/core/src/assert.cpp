#include "kith/core/assert.hpp"

#include <stdexcept>
#include <string>

namespace kith::detail {

void assertion_failed(const char* condition, const char* file, int line) {
  throw std::logic_error{std::string{file} + ":" + std::to_string(line) + ": assertion failed: " + condition};
}

}  // namespace kith::detail
