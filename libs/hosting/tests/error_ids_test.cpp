#include "error_ids.hpp"

#include <gtest/gtest.h>

#include <string>

namespace kith {
namespace {

TEST(SessionErrorIds, AreAllExplainedOnAPage) {
  const auto pages = testing::error_pages();
  for (const auto& id : testing::error_ids_in("hosting"))
    EXPECT_NE(pages.find("| " + id + " |"), std::string::npos) << id;
}

}  // namespace
}  // namespace kith
