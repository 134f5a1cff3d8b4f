#include "error_ids.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kith {
namespace {

TEST(AnalysisErrors, AreAllTested) {
  const auto tests = testing::tests_of("analysis");
  ASSERT_FALSE(tests.empty());
  const auto ids = testing::error_ids_in("analysis");
  ASSERT_GE(ids.size(), 7u);  // the scan found the sources
  for (const auto& id : ids) EXPECT_THAT(tests, ::testing::HasSubstr('"' + id + '"'));
}

}  // namespace
}  // namespace kith
