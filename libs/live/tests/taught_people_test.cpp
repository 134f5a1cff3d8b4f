#include <gtest/gtest.h>

#include "live_play.hpp"

namespace kith {
namespace {

using testing::live_study;
using testing::people_of;
using testing::Play;

TEST(TaughtPeople, KeepTheAnswersThatTheyGaveBeforeTheyLeft) {
  Play play{live_study("[group]\ndropout = { policy = \"simulate\" }\n")};
  play.start_tests(3);
  play.answer(2, false);
  ASSERT_EQ(play.seat(2, "leave"), "");
  while (play.room().session().periods() < 2) play.play_on({1, 3}, false, 1);
  const auto people = people_of(play);
  ASSERT_EQ(people.size(), 4u);
  EXPECT_EQ(people[1].seat, 2u);
  ASSERT_EQ(people[1].periods.size(), 1u);
  EXPECT_TRUE(people[1].periods[0].verdicts[0].answered);
  EXPECT_FALSE(people[2].is_person);
  ASSERT_FALSE(people[2].periods.empty());
  EXPECT_EQ(people[2].periods[0].period, 2u);
}

}  // namespace
}  // namespace kith
