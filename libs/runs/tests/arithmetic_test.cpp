#include "kith/runs/arithmetic.hpp"

#include <gtest/gtest.h>

namespace kith {
namespace {

TEST(Arithmetic, HasAFingerprintThatDoesNotChange) {
  EXPECT_EQ(arithmetic_fingerprint().size(), 16u);
  EXPECT_EQ(arithmetic_fingerprint(), arithmetic_fingerprint());
  EXPECT_FALSE(math_library().empty());
}

}  // namespace
}  // namespace kith
