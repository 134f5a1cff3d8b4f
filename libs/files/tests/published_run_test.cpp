#include "kith/files/published_run.hpp"

#include <gtest/gtest.h>

namespace kith {
namespace {

TEST(Manifest, IsSealedUntilAnythingInItChanges) {
  const auto sealed = sealed_manifest(R"({"teams": 300, "tables": {"teams.csv": "abc"}})");
  EXPECT_TRUE(is_sealed(sealed));
  auto changed = sealed;
  changed.replace(changed.find("300"), 3, "301");
  EXPECT_FALSE(is_sealed(changed));
  EXPECT_FALSE(is_sealed("{}"));
  EXPECT_FALSE(is_sealed("no JSON"));
}

TEST(Manifest, MayBeNestedVeryDeep) {
  constexpr std::size_t kDepth = 400'000;
  const auto deep = R"({"checksum": "0", "a": )" + std::string(kDepth, '[') + std::string(kDepth, ']') + "}";
  EXPECT_FALSE(is_sealed(deep));
}

}  // namespace
}  // namespace kith
