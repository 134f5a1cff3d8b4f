#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

namespace kith::testing {

/// The folder of reference facts computed by an independent program, if this
/// machine has it: $KITH_GOLDEN, else ../shared/golden beside the checkout.
[[nodiscard]] inline std::optional<std::filesystem::path> golden_file(const std::string& name) {
  const char* folder = std::getenv("KITH_GOLDEN");
  const auto path = folder != nullptr ? std::filesystem::path{folder} / name
                                      : std::filesystem::path{KITH_SOURCE_DIR} / ".." / "shared" / "golden" / name;
  if (!std::filesystem::exists(path)) return std::nullopt;
  return path;
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
