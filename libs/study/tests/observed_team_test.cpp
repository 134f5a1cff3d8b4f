#include "kith/study/observed_team.hpp"

#include <gtest/gtest.h>

#include <span>
#include <stdexcept>
#include <string>

#include "item_delivery.hpp"
#include "kith/study/study_file.hpp"
#include "kith/study/team_run.hpp"
#include "study_texts.hpp"

namespace kith {
namespace {

using testing::item_delivery;

// Keeps what really happened, session by session.
class Witness : public TeamObserver {
 public:
  std::vector<std::vector<ObservedPeriod>> people;

  void on_session(const Session& /*session*/, std::span<const std::size_t> /*members*/) override {}
  void on_lesson(const Session& /*session*/, const Lesson& /*lesson*/, const Learners& /*learners*/) override {}
  void on_feedback(const Session& /*session*/, const Lesson& /*lesson*/,
                   const std::vector<Learner::Response>& /*responses*/, const Feedback& /*feedback*/,
                   const Learners& /*learners*/) override {}
  void on_end(const Session& session, const Learners& learners) override {
    for (std::size_t i = 0; i < learners.size(); ++i) people.push_back(observed_periods(session.history(), i));
  }
};

Study study_of(const std::string& strategy, const std::string& group = {}) {
  const auto text = R"(schema = "kith.study/1"
id = "observed"
domain = "item-delivery"
seed = 3
replicates = 2
[design]
strategies = [")" + strategy +
                    R"("]
compositions = ["NP"]
)" + testing::kPaperLearners +
                    R"([teacher]
particles = 100
[stop]
max_periods = 4
duplicate_sets = 2
)" + group;
  return parse_study(text, "observed.toml").study.value();
}

// The record of a team says as much of its members as the session does.
TEST(ObservedPeople, AreThoseOfTheSession) {
  const std::string talk = "[group.discussion]\nmodel = \"truth-wins\"\n";
  for (const auto& [strategy, group] : {std::pair{"joint", ""}, {"baseline", ""}, {"joint", talk.c_str()}}) {
    const auto study = study_of(strategy, group);
    TeachingCache cache{item_delivery()};
    Witness witness;
    const auto record = run_team(item_delivery(), cache, study.variants.front(), team_address(study, 1), &witness);
    const auto people = observed_people(item_delivery(), record);
    ASSERT_EQ(people.size(), 2u);
    for (std::size_t m = 0; m < 2; ++m) {
      const auto& expected = witness.people[m];
      ASSERT_EQ(people[m].size(), expected.size()) << strategy;
      ASSERT_FALSE(expected.empty());
      for (std::size_t p = 0; p < expected.size(); ++p) {
        const auto& one = people[m][p];
        EXPECT_EQ(one.period, expected[p].period);
        EXPECT_EQ(one.component, expected[p].component);
        EXPECT_EQ(one.answers, expected[p].answers);
        EXPECT_EQ(one.verdicts, expected[p].verdicts);
        EXPECT_EQ(one.all_correct, expected[p].all_correct);
        EXPECT_EQ(one.discussed, expected[p].discussed);
        EXPECT_EQ(one.feedback, expected[p].feedback);
        ASSERT_EQ(one.demonstrations.size(), expected[p].demonstrations.size());
        for (std::size_t d = 0; d < one.demonstrations.size(); ++d) {
          EXPECT_EQ(one.demonstrations[d].start, expected[p].demonstrations[d].start);
          EXPECT_EQ(one.demonstrations[d].half_spaces, expected[p].demonstrations[d].half_spaces);
        }
        ASSERT_EQ(one.tests.size(), expected[p].tests.size());
        for (std::size_t t = 0; t < one.tests.size(); ++t) {
          EXPECT_EQ(one.tests[t].start, expected[p].tests[t].start);
          EXPECT_EQ(one.tests[t].covered, expected[p].tests[t].covered);
        }
      }
    }
  }
}

TEST(ObservedPeople, HaveNoPeriodsWhereOnlyTeamsAreRecorded) {
  auto study = study_of("joint");
  study.variants.front().record = RecordLevel::kTeam;
  TeachingCache cache{item_delivery()};
  const auto record = run_team(item_delivery(), cache, study.variants.front(), team_address(study, 1));
  for (const auto& periods : observed_people(item_delivery(), record)) EXPECT_TRUE(periods.empty());
}

TEST(ObservedPeople, MustBeOfTheDomain) {
  TeamRecord record;
  record.address.composition = "N";
  record.demonstration_records.push_back({.period = 1, .component = 1, .mdp = 9999, .constraints = {}});
  EXPECT_THROW(static_cast<void>(observed_people(item_delivery(), record)), std::invalid_argument);
  record.demonstration_records.front().mdp = 0;
  record.demonstration_records.front().component = 9;
  EXPECT_THROW(static_cast<void>(observed_people(item_delivery(), record)), std::invalid_argument);
}

}  // namespace
}  // namespace kith
