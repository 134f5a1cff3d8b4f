#include "kith/teaching/exam_chooser.hpp"

#include <gtest/gtest.h>

#include <array>
#include <set>
#include <vector>

#include "item_delivery.hpp"

namespace kith {
namespace {

using testing::item_delivery;

class ExamChooserTest : public ::testing::Test {
 protected:
  ExamChooserTest() { options_.filter.particles = 200; }
  [[nodiscard]] MisconceptionBank bank() {
    return {item_delivery(), options_, MisconceptionBank::beliefs(cache_, options_, RandomStream{3})};
  }
  [[nodiscard]] static std::vector<HalfSpace> all_constraints() { return constraints_to_learn(item_delivery()); }
  [[nodiscard]] static std::optional<StartIndex> choose(ExamChooser& chooser, const MisconceptionBank& bank) {
    const std::array components{all_constraints()};
    return chooser.choose(bank, components, {});
  }

  MisconceptionBank::Options options_;
  TeachingCache cache_{item_delivery()};
};

TEST_F(ExamChooserTest, NeverChoosesWhatWasShownOrLooksLikeIt) {
  ExamChooser chooser{cache_};
  const auto one = bank();
  std::set<std::uint32_t> classes;
  for (std::size_t n = 0; n < 12; ++n) {
    const auto start = choose(chooser, one);
    ASSERT_TRUE(start);
    EXPECT_TRUE(item_delivery().is_candidate(*start));
    EXPECT_TRUE(classes.insert(item_delivery().trajectory_class(*start)).second);
    chooser.leave_out(*start);
  }
}

TEST_F(ExamChooserTest, AsksOnlyWhatPeopleCanBeAskedAbout) {
  const auto is_even = [](StartIndex start) { return start.value() % 2 == 0; };
  ExamChooser chooser{cache_, is_even};
  const auto start = choose(chooser, bank());
  ASSERT_TRUE(start);
  EXPECT_TRUE(is_even(*start));
  ExamChooser nothing{cache_, [](StartIndex) { return false; }};
  EXPECT_FALSE(choose(nothing, bank()));
}

// Boards of an exam weigh people, but nobody stops, learns or is mended by them.
TEST_F(ExamChooserTest, RightAnswersSpeakAgainstGuessesAndTeachNothing) {
  auto one = bank();
  ExamChooser chooser{cache_};
  const auto before = one.possible_people(0.0).size();
  const double guessing = one.probability_of_guessing();
  for (std::size_t n = 1; n <= 4; ++n) {
    const auto start = choose(chooser, one);
    ASSERT_TRUE(start);
    chooser.leave_out(*start);
    one.observe(item_delivery(), exam_board(item_delivery(), *start, item_delivery().feature_counts(*start), n));
  }
  EXPECT_LT(one.probability_of_guessing(), guessing);
  EXPECT_GT(one.odds_against_halves(), 1.0);
  EXPECT_EQ(one.num_boards(), 4u);
  EXPECT_EQ(one.possible_people(0.0).size(), before);
  EXPECT_EQ(one.agreement().right, 4u);
}

}  // namespace
}  // namespace kith
