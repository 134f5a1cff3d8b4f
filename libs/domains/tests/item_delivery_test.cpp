#include <gtest/gtest.h>

#include "kith/domains/domain_file.hpp"

namespace kith {
namespace {

TEST(ItemDelivery, HasTheStatesOfThePaper) {
  const Domain domain = load_domain("item-delivery");
  EXPECT_EQ(domain.num_mdps(), 64u);
  EXPECT_EQ(domain.num_starts(), 9312u);
}

}  // namespace
}  // namespace kith
