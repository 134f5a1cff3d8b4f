#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "run_kith.hpp"

namespace kith::testing {

/// A study of 16 teams, which take a fraction of a second; the last word is "-q".
[[nodiscard]] inline std::vector<std::string> small_study(const std::string& folder) {
  return {"study", "quick", "-o", folder, "--set", "replicates=8", "-j", "2", "-q"};
}

/// Its tables when nothing happens.
[[nodiscard]] inline const Tables& expected() {
  static const Tables kTables = [] {
    const Scratch scratch;
    EXPECT_EQ(run_kith(small_study(scratch / "run")).code, 0);
    return tables_in(scratch / "run");
  }();
  return kTables;
}

}  // namespace kith::testing
