#include "error_ids.hpp"

#include <gtest/gtest.h>

#include <string>

namespace kith {
namespace {

// Tests name the ids that they trigger; those of damaged run folders are triggered where runs are read.
TEST(RunErrorIds, AreAllTriggeredByATest) {
  std::string tests;
  for (const auto* layer : {"runs", "report"}) tests += testing::tests_of(layer);
  for (const auto& id : testing::error_ids_in("runs")) EXPECT_NE(tests.find(id), std::string::npos) << id;
}

}  // namespace
}  // namespace kith
