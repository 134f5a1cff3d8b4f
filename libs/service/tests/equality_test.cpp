// One engine: a room of stand-ins on the server, and the team of a study with the same address.
#include <gtest/gtest.h>

#include "kith/store/session_review.hpp"
#include "kith/study/team_run.hpp"
#include "service_support.hpp"

namespace kith {
namespace {

using testing::ScratchFolder;
using testing::small_study;
using testing::Stage;

TEST(OneEngine, TeachesStandInsOfARoomLikeTheTeamOfAStudy) {
  const ScratchFolder scratch;
  Stage stage{scratch / "live", small_study()};
  auto facilitator = stage.facilitator();
  const auto made = facilitator->ask(stage.service(), "room-make",
                                     {{"strategy", "common"}, {"seats", {"N", "N", "P"}}, {"count", 2}});
  stage.show(*facilitator);
  ASSERT_EQ(facilitator->acks().back(), made) << facilitator->last_nak();
  for (const auto* room : {"r1", "r2"}) facilitator->ask(stage.service(), "start", {{"room", room}, {"reason", "now"}});
  stage.service().settle();
  for (int i = 0; i < 200; ++i) stage.pass_ms(1000);
  stage.stop();

  const auto& study = stage.study().study;
  TeachingCache cache{study->atlas};
  auto file = EventFile::read(stage.folder());
  const auto rooms = file.rooms();
  ASSERT_EQ(rooms.size(), 2u);
  for (std::size_t replicate = 1; replicate <= 2; ++replicate) {
    std::optional<Room> room;
    const auto replayed = replay_room(file, rooms[replicate - 1], study, cache,
                                      [&](const Room& after, const RoomEvent&) { room = after; });
    ASSERT_EQ(replayed.problem, "");
    ASSERT_TRUE(room);
    const TeamAddress address{
        .variant = 0, .strategy = "common", .composition = "NNP", .replicate = replicate, .team = replicate};
    const auto record = run_team(*study->atlas, cache, study->spec, address);
    const auto& history = room->session().history();
    ASSERT_EQ(history.size(), record.periods) << "replicate " << replicate;
    EXPECT_TRUE(room->session().finished());
    std::size_t shown = 0;
    for (std::size_t i = 0; i < history.size(); ++i) {
      const auto& lesson = history[i].lesson;
      EXPECT_EQ(lesson.gain, record.period_records[i].gain);
      EXPECT_EQ(lesson.area_sr, record.period_records[i].area_sr);
      for (const auto& demonstration : lesson.demonstrations) {
        const auto id = study->atlas->id(demonstration.start);
        EXPECT_EQ(id.mdp.value(), record.demonstration_records[shown].mdp);
        EXPECT_EQ(id.start.value(), record.demonstration_records[shown].start);
        ++shown;
      }
    }
    const auto& beliefs = room->session().belief();
    for (std::size_t rule = 0; rule < study->spec.teaching.rules.size(); ++rule) {
      EXPECT_EQ(
          beliefs.aggregate(study->spec.teaching.rules[rule].name).mass_in(study->atlas->policy_bec_half_spaces()),
          record.period_records.back().p_bec[rule])
          << "to the bit";
    }
  }
}

}  // namespace
}  // namespace kith
