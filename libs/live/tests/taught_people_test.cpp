#include "kith/live/taught_people.hpp"

#include <gtest/gtest.h>

#include "live_play.hpp"

namespace kith {
namespace {

using testing::live_study;
using testing::Play;

// Everybody after the events of a play so far.
std::vector<TaughtPerson> people_of(Play& play) {
  TaughtPeople taught;
  Room room{play.study_of_room(), play.room().setup(), play.cache()};
  for (const auto& event : play.events()) {
    room.apply(event, play.cache());
    taught.see(room);
  }
  return taught.all(room);
}

TEST(TaughtPeople, KeepTheAnswersThatTheyGaveBeforeTheyLeft) {
  Play play{live_study("[group]\ndropout = { policy = \"simulate\" }\n")};
  play.start(3);
  for (std::size_t i = 1; i <= 3; ++i) play.watch(i);
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
