#include "error_ids.hpp"

#include <gtest/gtest.h>

#include <string>

namespace kith {
namespace {

// Tests name the ids that they trigger; those of the tables of a run are triggered where runs are read.
TEST(StudyErrorIds, AreAllTriggeredByATest) {
  std::string tests;
  for (const auto* layer : {"study", "runs", "report", "fit"}) tests += testing::tests_of(layer);
  for (const auto& id : testing::error_ids_in("study")) EXPECT_NE(tests.find(id), std::string::npos) << id;
}

}  // namespace
}  // namespace kith
