#include "kith/learners/presumed_kinds.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "item_delivery.hpp"
#include "kith/learners/run_period.hpp"
#include "kith/teaching/cache.hpp"
#include "kith/teaching/kind_of_person.hpp"
#include "kith/teaching/known_components.hpp"

namespace kith {
namespace {

using testing::item_delivery;

TeachingOptions asking(const std::vector<std::string>& kinds = presumable_kinds()) {
  TeachingOptions options;
  options.filter.particles = 200;
  options.mastery = stop_rule_named("fixed");
  options.hypotheses_about = HypothesesAbout::kKinds;
  options.kinds = hypotheses_about_kinds(kinds);
  return options;
}

std::unique_ptr<Learner> somebody(TeachingCache& cache, const LearnerModel& model, const RandomStream& random) {
  ParameterValues values{model.parameters};
  values.set("particles", std::int64_t{200});
  const LearnerStart start{
      .cover = [&](std::size_t n) -> const PriorCover& { return cache.cover(item_delivery().prior_cone(), n); },
      .components = [] { return constraints_of_components(item_delivery()); }};
  return model.make(values, model.draw(values, random.split("traits")), start, random);
}

// Two people of these models taught for some periods.
Session taught(TeachingCache& cache, const TeachingOptions& options, const StrategyChoice& strategy,
               const std::vector<const LearnerModel*>& models, const std::vector<std::uint64_t>& seeds,
               std::size_t periods, const DiscussionChoice& discussion = {}) {
  std::vector<RandomStream> persons;
  Learners people;
  for (std::size_t i = 0; i < models.size(); ++i) {
    persons.push_back(RandomStream{seeds[i]});
    people.push_back(somebody(cache, *models[i], persons.back().split("learner")));
  }
  Session session{cache, options, strategy, persons, RandomStream{1}};
  for (std::size_t t = 0; t < periods && session.propose(cache); ++t) {
    run_period(session, cache, people, {.discussion = discussion, .talk = persons});
  }
  return session;
}

double probability_of(const std::vector<KindProbability>& kinds, std::string_view kind) {
  return std::find_if(kinds.begin(), kinds.end(), [&](const auto& one) { return one.kind == kind; })->probability;
}

TEST(PresumedKinds, AreEquallyProbableBeforehand) {
  const auto kinds = kinds_of(hypotheses_about_kinds(presumable_kinds()));
  EXPECT_EQ(kinds.size(), learner_models().size());
  EXPECT_EQ(kinds.front().kind, kUsualKind);
  for (const auto& [kind, probability] : kinds) EXPECT_NEAR(probability, 1.0 / 6.0, 1e-12) << kind;
  EXPECT_EQ(kind_word(kinds), "cannot tell yet");
  EXPECT_THROW((void)hypotheses_about_kinds({"absent-minded"}), std::invalid_argument);
}

TEST(PresumedKinds, AreNamedFromFourFifths) {
  EXPECT_EQ(kind_word(std::vector<KindProbability>{{"bayesian", 0.2}, {"imitating", 0.8}}), "imitating");
  EXPECT_EQ(kind_word(std::vector<KindProbability>{{"bayesian", 0.21}, {"imitating", 0.79}}), "cannot tell yet");
  EXPECT_EQ(kinds_in_words({{"bayesian", 0.1}, {"imitating", 0.9}}), "imitating (90 %)");
  EXPECT_EQ(kinds_in_words({{"bayesian", 0.09}, {"slipping", 0.3}, {"imitating", 0.61}}),
            "cannot tell yet (imitating 61 %, slipping 30 %)");
}

// Of eight people of each of these kinds, with nine periods of answers, the posterior of the true kind is well above
// 1/6 on average, and larger than that of people who learn as usual.
TEST(PresumedKinds, AreToldByTheirAnswers) {
  TeachingCache cache{item_delivery()};
  const auto mean_posterior = [&](const LearnerModel& true_kind, std::string_view kind) {
    double sum = 0.0;
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      const auto session =
          taught(cache, asking(), strategy_named("joint"), {&true_kind, &true_kind}, {10 * seed, 10 * seed + 1}, 9);
      for (std::size_t i = 0; i < 2; ++i) {
        const auto kinds = session.bank()->member(i).kinds();
        const double all = std::accumulate(kinds.begin(), kinds.end(), 0.0,
                                           [](double before, const auto& one) { return before + one.probability; });
        EXPECT_NEAR(all, 1.0, 1e-9);
        sum += probability_of(kinds, kind) / 8.0;
      }
    }
    return sum;
  };
  EXPECT_GT(mean_posterior(imitating_model(), "imitating"), 0.6);
  EXPECT_LT(mean_posterior(bayesian_model(), "imitating"), 0.1);
}

TEST(PresumedKinds, AreTheSameFromOutside) {
  TeachingCache cache{item_delivery()};
  const auto options = asking();
  for (const auto& talk : discussion_models()) {  // which takes time, too
    const auto session = taught(cache, options, strategy_named("joint"), {&imitating_model(), &decaying_model()},
                                {3, 4}, 4, {&talk, ParameterValues{talk.parameters}});
    for (std::size_t i = 0; i < 2; ++i) {
      const auto seen =
          kinds_after(cache, options, observed_periods(session.history(), i), RandomStream{1}.split("bank"));
      EXPECT_EQ(seen, session.bank()->member(i).kinds()) << talk.name;
    }
  }
}

// Laws of sessions: replayed they are the same, and seats do not matter.
TEST(PresumedKinds, ReplayAndChangeSeats) {
  const auto strategy = strategy_named("plan");
  TeachingCache cache{item_delivery()};
  const auto options = asking();
  const auto session = taught(cache, options, strategy, {&imitating_model(), &decaying_model()}, {5, 6}, 3);
  Session again{cache, options, strategy, {RandomStream{5}, RandomStream{6}}, RandomStream{1}};
  for (const auto& event : session.events()) again.apply(event, cache);
  EXPECT_TRUE(again == session);
  const auto other = taught(cache, options, strategy, {&decaying_model(), &imitating_model()}, {6, 5}, 3);
  ASSERT_EQ(other.periods(), session.periods());
  for (std::size_t t = 0; t < session.periods(); ++t) {
    EXPECT_EQ(other.history()[t].lesson.demonstrations, session.history()[t].lesson.demonstrations);
  }
  EXPECT_EQ(other.bank()->member(0).kinds(), session.bank()->member(1).kinds());
}

// Whoever is sure that people do not imitate does not choose other lessons than who does not think of it.
TEST(PresumedKinds, ChangeLessonsForPeopleWhoImitate) {
  TeachingCache cache{item_delivery()};
  const auto first_lesson = [&](const StrategyChoice& strategy, const std::vector<std::string>& kinds) {
    return taught(cache, asking(kinds), strategy, {&bayesian_model(), &bayesian_model()}, {7, 8}, 1)
        .history()[0]
        .lesson.demonstrations;
  };
  const auto plan = strategy_named("plan");
  EXPECT_EQ(first_lesson(plan, {"bayesian"}).front().start, first_lesson(plan, {"slipping"}).front().start);
  EXPECT_NE(first_lesson(plan, {"bayesian"}).front().start, first_lesson(plan, {"imitating"}).front().start);
  // It waits until somebody is likelier to imitate than not.
  auto patient = plan;
  patient.parameters.set("answers", 0.0);
  EXPECT_EQ(first_lesson(patient, {"bayesian", "slipping", "imitating"}),
            first_lesson(patient, {"bayesian", "slipping"}));
  EXPECT_NE(first_lesson(patient, {"slipping", "imitating", "imitating"}), first_lesson(patient, {"slipping"}));
}

// What imitators do with the robot's own demonstration of a start is right.
TEST(PresumedKinds, GradeImitation) {
  TeachingCache cache{item_delivery()};
  auto& table = cache.imitation();
  const auto test = cache.exam().starts(ExamDifficulty::kLow).front();
  const auto row = table.of(test);
  ASSERT_EQ(row.size(), table.num_starts());
  EXPECT_EQ(row.front().distance, 0.0);
  EXPECT_EQ(row.front().grade, (Grade{1.0, 0.0}));
  EXPECT_TRUE(std::any_of(row.begin(), row.end(), [](const auto& copy) { return copy.grade.share_right < 1.0; }));
}

}  // namespace
}  // namespace kith
