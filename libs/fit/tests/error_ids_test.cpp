#include <gtest/gtest.h>

#include "error_ids.hpp"

namespace kith {
namespace {

// Tests name the ids that they trigger.
TEST(FitErrorIds, AreAllTriggeredByATest) {
  const auto tests = testing::tests_of("fit");
  for (const auto& id : testing::error_ids_in("fit")) EXPECT_NE(tests.find(id), std::string::npos) << id;
}

}  // namespace
}  // namespace kith
