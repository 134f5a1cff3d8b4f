// What a program adds without a change in any library: each of these is this one file, by public headers only.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <memory>

#include "kith/domains/domain_file.hpp"
#include "kith/learners/learner_model.hpp"
#include "kith/learners/run_period.hpp"
#include "kith/teaching/session.hpp"
#include "kith/teaching/stop_rule.hpp"

namespace kith {
namespace {

// A learner who slips: knows the robot's way, but presses another key first wherever that makes a difference, and goes
// on as the robot does. Such paths are the best for no weights at all.
class SlipsAtOnce final : public Learner {
 public:
  [[nodiscard]] std::unique_ptr<Learner> clone() const override { return std::make_unique<SlipsAtOnce>(*this); }
  [[nodiscard]] bool answers_as_believed() const override { return false; }
  void begin_component() override {}
  void watch(std::span<const HalfSpace>, std::size_t) override {}
  [[nodiscard]] Response answer(Behaviours& behaviours, std::span<const StartIndex> tests, std::size_t) const override {
    const auto& atlas = behaviours.atlas();
    Response response;
    for (const auto test : tests) {
      const auto id = atlas.id(test);
      auto worst = atlas.feature_counts(test);
      for (std::size_t key = 0; key < atlas.domain().mdp(id.mdp).choices(id.start).size(); ++key) {
        const auto counts = atlas.deviation_counts(test, key);
        const auto& weights = atlas.domain().weights();
        if (weights.return_of(counts) < weights.return_of(worst)) worst = counts;
      }
      response.answers.emplace_back(worst);
    }
    return response;
  }
  void hear_feedback(bool, std::span<const HalfSpace>, std::size_t) override {}
  [[nodiscard]] std::optional<double> likelihood(const AnswerEvidence&) const override { return 1.0; }
  [[nodiscard]] double mass_in(std::span<const HalfSpace>) const override { return 1.0; }
};

// A stop rule: patience is at an end after so many periods in which somebody erred.
class Patience final : public StopRule {
 public:
  explicit Patience(std::size_t periods) : periods_{periods} {}
  [[nodiscard]] StopVerdict judge_team(const ClosedTests& closed) const override {
    const bool is_over = closed.feedback.all_correct.front() || closed.periods_of_component() >= periods_;
    return {is_over, is_over ? 1.0 : 0.0};
  }

 private:
  std::size_t periods_;
};

const std::array kPatienceParameters{Parameter{
    .name = "patience", .default_value = std::int64_t{2}, .description = "periods of a component at most", .min = 1}};

const StopRuleKind kPatience{
    .name = "patience",
    .description = "when everybody answers everything right, or patience is at an end",
    .make = [](const ParameterValues& values, TeachingCache&) -> std::unique_ptr<const StopRule> {
      return std::make_unique<Patience>(static_cast<std::size_t>(values.count("patience")));
    },
    .until =
        [](const TeachingOptions&, const ParameterValues& values) {
          return "for " + std::to_string(values.count("patience")) + " periods";
        },
    .parameters = kPatienceParameters};

TEST(OwnKinds, AreOneFileOutsideTheLibraries) {
  const Atlas atlas{load_domain("item-delivery")};
  TeachingCache cache{atlas};
  const RandomStream random{1};
  Learners people;
  people.push_back(std::make_unique<SlipsAtOnce>());
  TeachingOptions options{.max_periods = 60};
  options.mastery = StopChoice{kPatience};
  Session session{cache, options, strategy_named("joint"), std::vector{random.split("belief")},
                  random.split("teacher")};

  std::size_t outside = 0;
  while (session.propose(cache)) {
    run_period(session, cache, people);
    const auto& period = session.history().back();
    for (std::size_t t = 0; t < period.lesson.tests.size(); ++t) {
      const auto paths = atlas.tables().coverage_set(period.lesson.tests[t].start);
      const auto& given = period.answers.front().at(t);
      ASSERT_TRUE(given);
      if (std::find(paths.begin(), paths.end(), *given) == paths.end()) ++outside;
    }
    EXPECT_FALSE(period.feedback.all_correct.front());
  }

  EXPECT_GT(outside, 0u);
  EXPECT_TRUE(session.finished());
  EXPECT_EQ(session.periods(), 2 * atlas.knowledge_components().size());
}

}  // namespace
}  // namespace kith
