#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

#include "golden.hpp"

namespace kith::testing {

/// A file of recorded answers of real people, which may not be copied into the
/// tree, if this machine has it: $KITH_HUMAN_DATA, else ../shared/human_data
/// beside the checkout.
[[nodiscard]] inline std::optional<std::filesystem::path> human_data_file(const std::string& name) {
  const char* folder = std::getenv("KITH_HUMAN_DATA");
  const auto path = folder != nullptr ? std::filesystem::path{folder} / name
                                      : std::filesystem::path{KITH_SOURCE_DIR} / ".." / "shared" / "human_data" / name;
  if (!std::filesystem::exists(path)) return std::nullopt;
  return path;
}

}  // namespace kith::testing

/// Declares `variable` as the path of a file of recorded answers; without the
/// file the test fails on CI and is skipped, with the reason, elsewhere.
#define KITH_REQUIRE_HUMAN_DATA(variable, name)                                                        \
  const auto variable = ::kith::testing::human_data_file(name);                                        \
  if (!variable) {                                                                                     \
    if (::kith::testing::on_ci()) FAIL() << "recorded answers " << (name) << " are missing on CI";     \
    GTEST_SKIP() << "recorded answers " << (name) << " are not on this machine (set KITH_HUMAN_DATA)"; \
  }
