#include "kith/bec/grade_table.hpp"

#include <gtest/gtest.h>

#include "item_delivery.hpp"
#include "kith/core/error.hpp"
#include "kith/domains/domain_file.hpp"

namespace kith {
namespace {

using testing::item_delivery;

PolicyCellIndex robots_cell() {
  return item_delivery().tables().cells().locate(item_delivery().domain().weights().unit);
}

TEST(GradeTable, GivesTheRobotFullMarks) {
  const GradeTable table{item_delivery()};
  EXPECT_DOUBLE_EQ(table.all(robots_cell()).share_right, 1.0);
  EXPECT_EQ(table.all(robots_cell()).regret, 0.0);
  for (std::size_t k = 0; k < table.num_components(); ++k) {
    EXPECT_DOUBLE_EQ(table.component(robots_cell(), k).share_right, 1.0);
    for (const auto& test : table.tests(k)) EXPECT_TRUE(table.is_right(robots_cell(), test.hull));
  }
}

// Start by start, for some cells.
TEST(GradeTable, IsTheMeanOverAllStarts) {
  const auto& atlas = item_delivery();
  const GradeTable table{atlas};
  const auto& raw = atlas.domain().weights().raw;
  for (std::size_t cell = 0; cell < atlas.tables().cells().size(); cell += 40) {
    double right = 0.0, regret = 0.0;
    for (StartIndex start{0}; start.value() < atlas.num_states(); ++start) {
      const auto& robot = atlas.feature_counts(start);
      double worst = 0.0;
      for (const auto& counts : atlas.tables().coverage_set(start)) worst = std::max(worst, dot(robot - counts, raw));
      const auto answer = atlas.tables().answer(start, PolicyCellIndex{cell});
      const double loss = answer ? dot(robot - *answer, raw) : worst;
      right += answer && loss == 0.0 ? 1.0 : 0.0;
      regret += loss;
    }
    const auto n = static_cast<double>(atlas.num_states());
    EXPECT_NEAR(table.all(PolicyCellIndex{cell}).share_right, right / n, 1e-9) << cell;
    EXPECT_NEAR(table.all(PolicyCellIndex{cell}).regret, regret / n, 1e-9) << cell;
  }
}

TEST(GradeTable, SpreadsTestsEvenlyOverTheFacets) {
  const GradeTable table{item_delivery()};
  for (std::size_t k = 0; k < table.num_components(); ++k) {
    double sum = 0.0;
    for (const auto& test : table.tests(k)) sum += test.weight;
    EXPECT_NEAR(sum, 1.0, 1e-12);
  }
}

TEST(GradeTable, NeedsTables) {
  const Atlas atlas{load_domain("item-delivery"), BehaviourSource::kOnDemand};
  EXPECT_THROW(GradeTable{atlas}, Error);
}

}  // namespace
}  // namespace kith
