// What the posterior and forecasts say of simulated people who do not learn, or do not answer, as the model assumes.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "item_delivery.hpp"
#include "kith/study/study_file.hpp"
#include "kith/study/team_run.hpp"
#include "kith/teaching/forecast.hpp"
#include "kith/teaching/random_test.hpp"
#include "people_not_as_assumed.hpp"
#include "study_file_support.hpp"

namespace kith {
namespace {

using testing::item_delivery;

// Whether somebody was declared done with a component without answering a random test of it right with a probability
// of 0.8.
class DeclaredDone : public TeamObserver {
 public:
  explicit DeclaredDone(TeachingCache& cache) : cache_{cache} {}
  bool wrongly = false;
  std::size_t learned = 0;

  void on_session(const Session& /*session*/, std::span<const std::size_t> /*members*/) override {}
  void on_lesson(const Session& /*session*/, const Lesson& /*lesson*/, const Learners& /*learners*/) override {}
  void on_feedback(const Session& /*session*/, const Lesson& /*lesson*/,
                   const std::vector<Learner::Response>& /*responses*/, const Feedback& /*feedback*/,
                   const Learners& /*learners*/) override {}
  void on_end(const Session& session, const Learners& learners) override {
    constexpr double kUnderstood = 0.8;
    const auto* belief = learners.front()->belief();
    for (std::size_t k = 0; k < session.components().size(); ++k) {
      if (session.components()[k] != ComponentStatus::kLearned) continue;
      ++learned;
      const RandomTest test{item_delivery(), cache_.exam(), k};
      const auto right = [&] { return test.all_right(std::vector<std::vector<double>>{test.right(*belief)}); };
      wrongly = wrongly || belief == nullptr || right() < kUnderstood;
    }
  }

 private:
  TeachingCache& cache_;
};

struct Declared {
  std::size_t people = 0, wrongly = 0, learned = 0, periods = 0;
};

Declared declared_of(const LearnerModel& model, std::size_t people, const std::string& more = "") {
  TeachingCache cache{item_delivery()};
  const auto study = testing::study_of_kind(model, R"(["N", "P"])", people / 2, 12,
                                            "[stop]\nmax_periods = 20\nmastery = \"posterior\"\n" + more);
  Declared declared;
  for (std::size_t team = 1; team <= num_teams(study); ++team) {
    DeclaredDone observer{cache};
    const auto record = run_team(item_delivery(), cache, study.variants.front(), team_address(study, team), &observer);
    ++declared.people;
    declared.wrongly += observer.wrongly ? 1u : 0u;
    declared.learned += observer.learned;
    declared.periods += record.periods;
  }
  return declared;
}

void expect_nearly_nobody_done(std::size_t people) {
  for (const auto& model : testing::people_not_as_assumed()) {
    const auto declared = declared_of(model, people);
    EXPECT_LE(static_cast<double>(declared.wrongly), 0.02 * static_cast<double>(declared.people)) << model.kind;
  }
}

TEST(JudgedPeople, WhoDoNotLearnAreNotDeclaredDone) { expect_nearly_nobody_done(8); }

// 1000 people of each kind: with 200 a rate of 3 % was within the bound.
TEST(JudgedPeopleSlow, WhoDoNotLearnAreNotDeclaredDone) { expect_nearly_nobody_done(1000); }

TEST(JudgedPeople, WhoLearnAsAssumedAreDeclaredDone) {
  const auto declared = declared_of(bayesian_model(), 16);
  EXPECT_GE(declared.learned, 2 * declared.people);
}

}  // namespace
}  // namespace kith
