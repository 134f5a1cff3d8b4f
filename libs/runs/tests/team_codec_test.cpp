#include "kith/runs/team_codec.hpp"

#include <gtest/gtest.h>

#include "item_delivery.hpp"
#include "kith/core/stream.hpp"
#include "kith/study/tables.hpp"
#include "run_support.hpp"

namespace kith {
namespace {

constexpr std::string_view kKey = "whose work it is";

std::string tables_text(const Study& study, const TeamRecord& team) {
  std::string all;
  write_study_tables(study, std::span{&team, 1}, [&](std::string_view, std::string_view piece) { all += piece; });
  return all;
}

// One team of every strategy, with everything that can be recorded.
std::vector<TeamRecord> teams(RecordLevel level) {
  const auto reading = testing::quick_study({"replicates=1", "design.strategies=[\"baseline\",\"joint\"]"});
  auto study = *reading.study;
  study.variants[0].record = level;
  study.variants[0].estimates = level != RecordLevel::kTeam;
  study.variants[0].beliefs = level != RecordLevel::kTeam;
  study.variants[0].teaching.filter.particles = 60;
  for (auto& type : study.variants[0].learner_types) type.parameters.set("particles", std::int64_t{50});
  return run_teams(testing::item_delivery(), study, team_addresses(study)).teams;
}

TEST(TeamCodec, GivesEveryRecordBack) {
  for (const auto level : {RecordLevel::kTeam, RecordLevel::kPeriod, RecordLevel::kParticles}) {
    auto study = *testing::quick_study().study;
    study.variants[0].record = level;
    study.variants[0].estimates = level != RecordLevel::kTeam;
    study.variants[0].beliefs = level != RecordLevel::kTeam;
    for (const auto& team : teams(level)) {
      const auto bytes = encode_team(team, kKey);
      const auto again = decode_team(team.address, bytes, kKey);
      ASSERT_TRUE(again);
      EXPECT_EQ(encode_team(*again, kKey), bytes);
      EXPECT_EQ(tables_text(study, *again), tables_text(study, team));
      EXPECT_EQ(again->learners[0].traits, team.learners[0].traits);
      EXPECT_EQ(again->fewest_particles, team.fewest_particles);
      EXPECT_EQ(team.fewest_particles.has_value(), level != RecordLevel::kTeam);
    }
  }
}

// Layout 9 had no kinds of learners in estimates, and 8 no discussions. The one before sessions could end as skipped
// had a flag in the place of the status.
TEST(TeamCodec, ReadsRecordsOfEarlierLayouts) {
  for (auto team : teams(RecordLevel::kPeriod)) {
    team.estimates.clear();
    for (const auto status : {SessionStatus::kComplete, SessionStatus::kMaxPeriods}) {
      team.status = status;
      for (auto& period : team.period_records) period.tests_demonstrated = 0;  // which came with layout 11
      EXPECT_TRUE(decode_team(team.address, encode_team(team, kKey, 9), kKey));
      EXPECT_TRUE(decode_team(team.address, encode_team(team, kKey, 8), kKey));

      std::string content{unseal_record(team.address.team, encode_team(team, kKey, 8), kKey).value()};
      content.front() = 7;
      content.at(2 + team.seed_address.size()) = status == SessionStatus::kComplete ? 1 : 0;
      const auto again = decode_team(team.address, seal_record(team.address.team, content, kKey), kKey);
      ASSERT_TRUE(again);
      EXPECT_EQ(encode_team(*again, kKey), encode_team(team, kKey));
    }
  }
}

TEST(TeamCodec, KeepsHowATeamEnded) {
  auto team = teams(RecordLevel::kTeam).front();
  for (const auto status : {SessionStatus::kComplete, SessionStatus::kSkipped, SessionStatus::kMaxPeriods}) {
    team.status = status;
    const auto again = decode_team(team.address, encode_team(team, kKey), kKey);
    ASSERT_TRUE(again);
    EXPECT_EQ(again->status, status);
    EXPECT_EQ(again->completed(), status == SessionStatus::kComplete);
  }
}

TEST(TeamCodec, NeedsLittleRoom) {
  for (const auto& team : teams(RecordLevel::kTeam)) EXPECT_LT(encode_team(team, kKey).size(), 300u);
}

TEST(TeamCodec, NoticesEveryFlippedBitAndEveryCut) {
  const auto team = teams(RecordLevel::kTeam).front();
  const auto bytes = encode_team(team, kKey);
  EXPECT_TRUE(is_intact(team.address.team, bytes, kKey));
  EXPECT_FALSE(is_intact(team.address.team + 1, bytes, kKey));
  EXPECT_FALSE(is_intact(team.address.team, bytes, "another key"));
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    auto flipped = bytes;
    flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ (1 << (bit % 8)));
    EXPECT_FALSE(is_intact(team.address.team, flipped, kKey)) << bit;
  }
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_FALSE(decode_team(team.address, std::string_view{bytes}.substr(0, size), kKey)) << size;
  }
}

TEST(TeamCodec, ReadsNothingFromNoise) {
  RandomStream random{1};
  for (int i = 0; i < 2000; ++i) {
    std::string noise(random() % 300, '\0');
    for (auto& byte : noise) byte = static_cast<char>(random());
    EXPECT_FALSE(decode_team({}, noise, kKey));
  }
}

}  // namespace
}  // namespace kith
