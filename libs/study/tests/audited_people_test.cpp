// What an audit says of simulated people who do not learn, or do not answer, as the model assumes.

#include <gtest/gtest.h>
#include <span>
#include <string>
#include <vector>

#include "item_delivery.hpp"
#include "kith/explain/audit.hpp"
#include "kith/study/observed_team.hpp"
#include "kith/study/study_file.hpp"
#include "kith/study/team_run.hpp"
#include "people_not_as_assumed.hpp"
#include "study_file_support.hpp"
#include "true_levels.hpp"

namespace kith {
namespace {

using testing::item_delivery;

// Teams of four people of one kind.
Study study_of_fours(const LearnerModel& model, const std::string& stop, std::size_t people) {
  return testing::study_of_kind(model, R"(["NNPP"])", people / 4, 11, "[stop]\nmax_periods = 12\n" + stop);
}

struct Said {
  std::size_t people = 0;
  std::size_t wrongly = 0;  // people who are said to understand a component that they do not
  std::size_t rightly = 0;  // components that people understand, and are said to
  std::size_t understood = 0;
  std::size_t unexplained = 0;
};

Said said_of(const LearnerModel& model, const std::string& stop, std::size_t people) {
  constexpr double kUnderstood = 0.8;  // CredibleLevelOptions::enough
  TeachingCache cache{item_delivery()};
  Auditor auditor{cache, {}};
  const auto study = study_of_fours(model, stop, people);
  Said said;
  for (std::size_t team = 1; team <= num_teams(study); ++team) {
    testing::TrueLevels truth{auditor};
    const auto record = run_team(item_delivery(), cache, study.variants.front(), team_address(study, team), &truth);
    const auto people_of_team =
        auditor.audit_group(observed_people(item_delivery(), record), RandomStream{1}.split(team));
    for (std::size_t m = 0; m < people_of_team.size(); ++m) {
      const auto& person = people_of_team[m];
      bool wrongly = false;
      for (const auto& audit : person.components) {
        const bool understands = audit.understanding == Understanding::kUnderstands;
        const bool is_true = truth.levels[m][audit.component] >= kUnderstood;
        wrongly = wrongly || (understands && !is_true);
        said.understood += is_true ? 1u : 0u;
        said.rightly += understands && is_true ? 1u : 0u;
        EXPECT_LE(audit.level.low, audit.level.mean);
        EXPECT_GE(audit.level.high, audit.level.mean);
      }
      ++said.people;
      said.wrongly += wrongly ? 1u : 0u;
      said.unexplained += person.is_explained ? 0u : 1u;
    }
  }
  return said;
}

constexpr const char* kNinePeriods = "mastery = \"fixed\"\n";

// At most 2 % of each kind: with 200 people four.
TEST(JudgedPeopleSlow, WhoDoNotUnderstandAreNotSaidTo) {
  for (const std::string stop : {kNinePeriods, ""}) {
    for (const auto& model : testing::people_not_as_assumed()) {
      const auto said = said_of(model, stop, 200);
      EXPECT_LE(said.wrongly, 4u) << model.kind << (stop.empty() ? ", until all are right" : ", nine periods");
    }
  }
}

// The same of few people, all kinds together. If 2 % of 24 people are judged wrongly, more than two are with
// probability 0.012.
TEST(JudgedPeople, WhoDoNotUnderstandAreNotSaidTo) {
  Said all;
  for (const auto& model : testing::people_not_as_assumed()) {
    const auto said = said_of(model, kNinePeriods, 4);
    all.people += said.people;
    all.wrongly += said.wrongly;
  }
  EXPECT_EQ(all.people, 24u);
  EXPECT_LE(all.wrongly, 2u);
}

bool costs(const IntegerVector& loss) { return sign_of_dot(item_delivery().domain().weights().integer, loss) > 0; }

// Whatever was shown, and however wrong the answers are.
TEST(JudgedPeople, WhoHaveNoRightAnswerAreNotSaidToUnderstand) {
  TeachingCache cache{item_delivery()};
  Auditor auditor{cache, {}};
  const auto study = study_of_fours(bayesian_model(), kNinePeriods, 12);
  for (std::size_t team = 1; team <= num_teams(study); ++team) {
    const auto record = run_team(item_delivery(), cache, study.variants.front(), team_address(study, team));
    auto observed = observed_people(item_delivery(), record);
    for (std::size_t m = 0; m < observed.size(); ++m) {
      RandomStream random = RandomStream{2}.split(team).split(m);
      std::size_t tests = 0;
      for (auto& period : observed[m]) {
        for (std::size_t t = 0; t < period.tests.size(); ++t) {
          const auto start = period.tests[t].start;
          auto losses = item_delivery().tables().hull(item_delivery().tables().hull(start)).losses;
          std::erase_if(losses, [](const auto& one) { return !costs(one); });
          ASSERT_FALSE(losses.empty());
          auto loss = losses[uniform_index(losses.size(), random)];
          // Some of the paths are best for nobody: all of them, none or half.
          if (m == 0 || (m > 1 && uniform01(random) < 0.5)) loss[2] -= 2;
          period.answers[t] = item_delivery().feature_counts(start) - loss;
          period.verdicts[t] = {.correct = false, .half_spaces = {HalfSpace{-loss}}};
        }
        period.all_correct = false;
        tests += period.tests.size();
        if (tests < 5) continue;
        const std::span so_far{observed[m].data(), static_cast<std::size_t>(&period - observed[m].data()) + 1};
        const auto person = auditor.audit(so_far, RandomStream{1});
        for (const auto& audit : person.components) {
          EXPECT_NE(audit.understanding, Understanding::kUnderstands) << "period " << period.period;
          EXPECT_LT(audit.level.probability, 0.5);
        }
      }
    }
  }
}

// A quarter of the components that people understand; see docs/audit.md on why it is not more.
TEST(JudgedPeopleSlow, WhoLearnAsAssumedAreStillFound) {
  const auto said = said_of(bayesian_model(), kNinePeriods, 200);
  EXPECT_GE(static_cast<double>(said.rightly), 0.25 * static_cast<double>(said.understood));
  EXPECT_LE(said.wrongly, 4u);
}

// Of 62 such components, fewer than 8 are found with probability 0.01 if it is a quarter.
TEST(JudgedPeople, WhoLearnAsAssumedAreStillFound) {
  const auto said = said_of(bayesian_model(), kNinePeriods, 24);
  EXPECT_GE(said.rightly, 8u);
  EXPECT_EQ(said.unexplained, 0u);
}

}  // namespace
}  // namespace kith
