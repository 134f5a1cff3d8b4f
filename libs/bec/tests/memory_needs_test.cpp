#include "kith/bec/memory_needs.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "item_delivery.hpp"
#include "kith/bec/atlas.hpp"
#include "kith/bec/behaviours.hpp"
#include "kith/core/error.hpp"
#include "kith/domains/domain_file.hpp"
#include "memory_limit.hpp"

namespace kith {
namespace {

using ::testing::HasSubstr;
using testing::item_delivery;
using testing::memory_refusal;
using testing::MemoryLimit;

// An open map of so many cells a side, with every state as a start or with a few.
Domain open_map(std::size_t side, const std::string& family = {}) {
  std::string rows;
  for (std::size_t y = 0; y < side; ++y) {
    std::string row(side, '.');
    if (y == 0) row.front() = 'S';
    if (y + 1 == side) row.back() = 'G';
    rows += '"' + row + "\",\n";
  }
  const auto text =
      "schema = \"kith.domain/1\"\nid = \"open\"\n" + family + "[map]\nrows = [\n" + rows +
      "]\n[map.legend]\n\".\" = \"floor\"\n\"S\" = { start = true }\n\"G\" = { goal = true }\n"
      "[[feature]]\nname = \"step\"\nwhen = \"action\"\n[[feature]]\nname = \"up\"\nwhen = \"action:up\"\n"
      "[[feature]]\nname = \"left\"\nwhen = \"action:left\"\n"
      "[reward]\nweights = { step = -1, up = -0.5, left = -0.5 }\n";
  auto reading = parse_domain(text, "open.toml");
  if (!reading.domain) throw std::logic_error{to_text(reading.diagnostics.at(0))};
  return *std::move(reading.domain);
}

TEST(MemoryNeeds, GrowWithTheStatesAndWithThePairsOfStartsAndStates) {
  const auto small = open_map(50);
  const auto large = open_map(100);
  EXPECT_NEAR(static_cast<double>(planning_memory(large)) / static_cast<double>(planning_memory(small)), 4.0, 0.01);
  EXPECT_GT(teaching_memory(large), 4 * teaching_memory(small));
  EXPECT_LT(teaching_memory(open_map(100, "[family]\nstarts = 100\n")), teaching_memory(large) / 50);
}

TEST(MemoryNeeds, OfTablesAreThoseOfPlanning) {
  EXPECT_EQ(teaching_memory(item_delivery().domain()), 0u);
  EXPECT_GT(planning_memory(item_delivery().domain()), 0u);
}

TEST(MemoryNeeds, IncludeThePartitionsThatThreadsShareOnce) {
  const auto domain = open_map(50);
  EXPECT_EQ(partition_memory(domain), PartitionStore::kDefaultBytes);
  EXPECT_EQ(partition_memory(item_delivery().domain()), 0u);
  ASSERT_LT(planning_memory(domain) + 2 * teaching_memory(domain), 50'000'000u);
  const MemoryLimit limit{"100M"};
  // 134 MB of them once, and 17 MB per thread.
  EXPECT_THAT(memory_refusal([&] { require_teaching_memory(domain, 2); }),
              HasSubstr("teaching the 2499 states of 'open' needs about 170 MB"));
}

TEST(MemoryNeeds, AreCheckedBeforePlanning) {
  const auto domain = open_map(100);
  const MemoryLimit little{"1M"};
  EXPECT_THAT(memory_refusal([&] { (void)Atlas{domain}; }),
              HasSubstr("planning the 9999 states of 'open' needs about 7 MB"));
  EXPECT_THAT(memory_refusal([&] { require_teaching_memory(domain, 2); }), HasSubstr("teaching the 9999 states"));
}

TEST(MemoryNeeds, AreCheckedBeforeTeaching) {
  const Atlas atlas{open_map(100)};
  const MemoryLimit little{"1M"};
  EXPECT_THAT(memory_refusal([&] { (void)Behaviours{atlas}; }),
              HasSubstr("choosing what to teach in domain 'open' needs"));
}

}  // namespace
}  // namespace kith
