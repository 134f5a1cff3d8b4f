#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

namespace kith::testing {

/// A file of reference facts computed by an independent program: in $KITH_GOLDEN or ../shared/golden beside the
/// checkout, where this machine has them all, else the part of them that is in the tree, tests/support/facts.
[[nodiscard]] inline std::optional<std::filesystem::path> golden_file(const std::string& name) {
  const std::filesystem::path source{KITH_SOURCE_DIR};
  const char* folder = std::getenv("KITH_GOLDEN");
  const auto all = folder != nullptr ? std::filesystem::path{folder} : source / ".." / "shared" / "golden";
  for (const auto& place : {all, source / "tests" / "support" / "facts"}) {
    if (std::filesystem::exists(place / name)) return place / name;
  }
  return std::nullopt;
}

[[nodiscard]] inline bool on_ci() {
  const char* ci = std::getenv("CI");
  return ci != nullptr && std::string{ci} == "true";
}

}  // namespace kith::testing

/// Declares `variable` as the path of a reference file; without the file the
/// test fails on CI and is skipped, with the reason, elsewhere.
#define KITH_REQUIRE_GOLDEN(variable, name)                                                     \
  const auto variable = ::kith::testing::golden_file(name);                                     \
  if (!variable) {                                                                              \
    if (::kith::testing::on_ci()) FAIL() << "reference file " << (name) << " is missing on CI"; \
    GTEST_SKIP() << "reference file " << (name) << " is not on this machine (set KITH_GOLDEN)"; \
  }
