#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <functional>
#include <string>

#include "kith/core/error.hpp"

namespace kith::testing {

/// KITH_MEMORY has this value for as long as it lives.
class MemoryLimit {
 public:
  explicit MemoryLimit(const char* said) { setenv("KITH_MEMORY", said, 1); }
  ~MemoryLimit() { unsetenv("KITH_MEMORY"); }
  MemoryLimit(const MemoryLimit&) = delete;
  MemoryLimit& operator=(const MemoryLimit&) = delete;
};

/// What work says that needs more memory than there is (E1201); empty if it is done.
[[nodiscard]] inline std::string memory_refusal(const std::function<void()>& work) {
  try {
    work();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kInfeasible);
    EXPECT_EQ(error.diagnostics().at(0).id, "E1201");
    return error.what();
  }
  return {};
}

}  // namespace kith::testing
