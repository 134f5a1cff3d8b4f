#include "kith/study/exam_rehearsal.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "item_delivery.hpp"
#include "kith/learners/people_not_as_assumed.hpp"
#include "kith/study/study_file.hpp"

namespace kith {
namespace {

using testing::item_delivery;

std::vector<RehearsedKind> rehearsed(std::size_t people, std::size_t threads) {
  auto spec = load_study("paper").study->variants.front();
  take_domain(spec, item_delivery().domain());
  return rehearse_exam(item_delivery(), spec, {.people = people, .threads = threads});
}

TEST(ExamRehearsal, IsTheSameOnAnyNumberOfThreads) {
  const auto one = rehearsed(1, 1), two = rehearsed(1, 2);
  EXPECT_EQ(rehearsal_json(item_delivery(), one, "kith").dump(), rehearsal_json(item_delivery(), two, "kith").dump());
  ASSERT_EQ(one.size(), people_not_as_assumed().size() + 1);
  for (const auto& kind : one) {
    EXPECT_EQ(kind.people, 1u);
    EXPECT_LE(kind.boards, Examination::kMostBoards);
    ASSERT_EQ(kind.findings.size(), kExamLengths.size());
    EXPECT_LE(kind.findings.back().rightly, kind.understood);
  }
}

// Twelve boards find people whom lessons alone do not tell from others; at most 2 % of each kind are found wrongly.
TEST(ExamRehearsalSlow, FindsMorePeopleThanLessonsDoAndHardlyAnybodyWrongly) {
  constexpr std::size_t kPeople = 200;
  const auto kinds = rehearsed(kPeople, 0);
  const auto& taught = kinds.front();
  EXPECT_GE(taught.findings.back().rightly, taught.findings.front().rightly + taught.understood / 5);
  for (const auto& kind : kinds) EXPECT_LE(kind.findings.back().wrongly, kPeople / 50) << kind.kind;
}

}  // namespace
}  // namespace kith
