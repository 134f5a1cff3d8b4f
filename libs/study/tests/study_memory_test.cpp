#include "kith/study/study_memory.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "item_delivery.hpp"
#include "kith/core/error.hpp"
#include "kith/study/study_file.hpp"
#include "memory_limit.hpp"

namespace kith {
namespace {

using testing::memory_refusal;

Study quick(const std::vector<std::string>& overrides = {}) {
  auto reading = load_study("quick", {overrides});
  if (!reading.study) throw Error{reading.diagnostics};
  return *std::move(reading.study);
}

class StudyMemory : public ::testing::Test {
 protected:
  testing::MemoryLimit limit_{"2G"};
};

TEST_F(StudyMemory, GrowsWithParticlesMembersAndWhatIsRecorded) {
  const auto usual = memory_per_thread(quick());
  EXPECT_LT(usual, 10'000'000u);
  EXPECT_GT(memory_per_thread(quick({"teacher.particles=1000000"})), 100 * usual);
  EXPECT_GT(memory_per_thread(quick({"design.compositions=[\"NNNNNNNNNNNNNNNNNNNN\"]"})), 5 * usual);
  EXPECT_GT(memory_per_team(quick({"record.level=\"particles\""})), 10 * memory_per_team(quick()));
}

TEST_F(StudyMemory, OfOneThreadTooManyIsRefused) {
  const auto study = quick({"teacher.particles=1000000"});
  require_study_memory(study, 2);
  EXPECT_THAT(memory_refusal([&] { require_study_memory(study, 1000); }),
              ::testing::HasSubstr("teaching on 1000 threads needs about"));
}

// Every record is kept until the last team is there.
TEST_F(StudyMemory, OfTeamsThatAreAllKeptIsChecked) {
  const auto study = quick({"record.level=\"team\""});
  require_study_memory(study, 2, 10'000);
  EXPECT_THAT(memory_refusal([&] { require_study_memory(study, 2, 5'000'000); }),
              ::testing::HasSubstr("keeping 5000000 teams and teaching on 2 threads needs about"));
}

TEST_F(StudyMemory, IsCheckedBeforeTheFirstTeam) {
  const auto study = quick({"teacher.particles=1000000", "learner.N.particles=1000000", "replicates=1",
                            "design.compositions=[\"NNNNNNNNNNNNNNNNNNNNNNNNNNNNNN\"]"});
  const auto& atlas = testing::item_delivery();
  const auto addresses = team_addresses(study);
  RunOptions run;
  run.threads = 1;
  EXPECT_NE(memory_refusal([&] { (void)run_teams(atlas, study, addresses, run); }), "");
  const std::vector<std::uint32_t> teams{1};
  StreamOptions stream;
  stream.threads = 1;
  const auto sink = [](const TeamOutcome&) { FAIL() << "a team was taught"; };
  EXPECT_NE(memory_refusal([&] { stream_teams(atlas, study, teams, stream, sink); }), "");
}

}  // namespace
}  // namespace kith
