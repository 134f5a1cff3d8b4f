// The exam after the lessons, which everybody takes alone.

#include <gtest/gtest.h>

#include <set>

#include "kith/explain/examination.hpp"
#include "kith/live/room_audit.hpp"
#include "live_play.hpp"

namespace kith {
namespace {

using testing::live_study;
using testing::Play;

// Taught until the lessons are over.
void teach_everybody(Play& play, std::size_t people) {
  play.start(people);
  std::vector<std::size_t> seats;
  for (std::size_t i = 1; i <= people; ++i) seats.push_back(i);
  play.play_on(seats);
}

TEST(LiveExam, IsTakenAloneAfterTheLessonsAndEndsWithTheQuestions) {
  Play play{live_study("[group]\nexam = true\n")};
  teach_everybody(play, 3);
  ASSERT_EQ(play.room().stage(), RoomStage::kQuestions);
  for (std::size_t seat = 1; seat <= 3; ++seat) {
    std::set<std::string> boards;
    for (std::size_t n = 0; play.room().stage_of(seat) == "exam"; ++n) {
      const auto task = testing::page(play, seat)["predict"];
      EXPECT_EQ(task["index"], n);
      EXPECT_EQ(task["of"], Examination::kMostBoards);
      EXPECT_TRUE(boards.insert(task["board"].dump()).second);
      ASSERT_EQ(play.seat(seat, "examine", {{"test", n}, {"actions", Json::array()}, {"ms", 5}}), "");
      ASSERT_LT(n, Examination::kMostBoards);
    }
    EXPECT_FALSE(boards.empty());
    EXPECT_EQ(play.room().exam_of(seat).size(), boards.size());
    EXPECT_NE(play.room().stage_of(seat), "exam");
    EXPECT_EQ(play.seat(seat, "examine", {{"test", 40}, {"actions", Json::array()}, {"ms", 5}}), "not-now");
  }
  EXPECT_EQ(play.room().stage(), RoomStage::kEnded);
  play.expect_replay();
}

TEST(LiveExam, CountsForTheAudit) {
  Play play{live_study("[group]\nexam = true\n")};
  teach_everybody(play, 3);
  ASSERT_EQ(play.room().stage_of(1), "exam");
  ASSERT_EQ(play.seat(1, "examine", {{"test", 0}, {"actions", Json::array()}, {"ms", 5}}), "");
  const auto people = testing::people_of(play);
  ASSERT_FALSE(people.empty());
  EXPECT_TRUE(people.front().periods.back().is_exam());
  EXPECT_FALSE(people.back().periods.back().is_exam());
}

TEST(LiveExam, IsLeftOutUnlessTheStudyAsksForIt) {
  Play play{live_study()};
  teach_everybody(play, 3);
  EXPECT_EQ(play.room().stage(), RoomStage::kEnded);
}

}  // namespace
}  // namespace kith
