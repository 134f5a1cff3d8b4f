// What every registered learner model promises (learner.hpp).
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string>

#include "item_delivery.hpp"
#include "kith/core/error.hpp"
#include "kith/learners/learner_model.hpp"
#include "kith/teaching/known_components.hpp"

namespace kith {
namespace {

using testing::item_delivery;

const std::array kTests{StartIndex{10}, StartIndex{4000}, StartIndex{9000}};

// What can be seen of a person from outside.
struct State {
  std::optional<double> ability;
  std::vector<double> masses;
  std::vector<std::vector<std::optional<IntegerVector>>> answers;
  std::optional<ParticleBelief> belief;
  friend bool operator==(const State&, const State&) = default;
};

class LearnerLaws : public ::testing::TestWithParam<const LearnerModel*> {
 protected:
  // Few particles: the laws do not depend on how many there are.
  [[nodiscard]] ParameterValues values() const {
    ParameterValues result{model().parameters};
    if (num_particles(result) > 0) result.set("particles", std::int64_t{200});
    return result;
  }

  [[nodiscard]] std::unique_ptr<Learner> person(std::uint64_t number) const {
    std::optional<PriorCover> cover;
    const LearnerStart start{.cover = [&](std::size_t num_points) -> const PriorCover& {
                               return cover.emplace(item_delivery().prior_cone(), num_points);
                             },
                             .components = [] { return constraints_of_components(item_delivery()); }};
    const RandomStream random = RandomStream{kSeed}.split(number);
    const auto traits = model().draw(values(), random.split("parameters"));
    EXPECT_EQ(traits.size(), model().traits.size());
    return model().make(values(), traits, start, random.split("learner"));
  }

  static void live_through_period(Learner& learner, std::size_t period) {
    const auto& bec = item_delivery().policy_bec_half_spaces();
    if (period % 3 == 1) learner.begin_component();
    if (period > 1) learner.let_time_pass(2.0, period);
    learner.see(item_delivery(), std::array{StartIndex{100 * period}, StartIndex{8000 + period}});
    learner.watch(std::span{bec}.first(1 + period % bec.size()), period);
    learner.hear_feedback(period % 2 == 0, std::span{bec}.last(1), period);
  }
  static void live(Learner& learner, std::size_t first, std::size_t last) {
    for (std::size_t period = first; period <= last; ++period) live_through_period(learner, period);
  }

  [[nodiscard]] State state_of(const Learner& learner) {
    State state{.ability = learner.ability(), .masses = {}, .answers = {}, .belief = {}};
    for (const auto& half_space : item_delivery().policy_bec_half_spaces()) {
      state.masses.push_back(learner.mass_in(std::array{half_space}));
    }
    for (std::size_t period = 1; period <= 5; ++period) {
      state.answers.push_back(learner.answer(behaviours_, kTests, period).answers);
    }
    if (learner.belief() != nullptr) state.belief = *learner.belief();
    return state;
  }

  [[nodiscard]] static const LearnerModel& model() { return *GetParam(); }

  static constexpr std::uint64_t kSeed = 20240517;
  Behaviours behaviours_{item_delivery()};
};

TEST_P(LearnerLaws, TheSameStreamAndEventsGiveTheSamePerson) {
  const auto a = person(1);
  const auto b = person(1);
  live(*a, 1, 8);
  live(*b, 1, 8);
  EXPECT_EQ(state_of(*a), state_of(*b));
}

TEST_P(LearnerLaws, AnsweringChangesNothing) {
  const auto silent = person(1);
  const auto asked = person(1);
  for (std::size_t period = 1; period <= 6; ++period) {
    for (std::size_t again = 0; again < period % 3; ++again) (void)asked->answer(behaviours_, kTests, period);
    live_through_period(*silent, period);
    live_through_period(*asked, period);
  }
  EXPECT_EQ(state_of(*silent), state_of(*asked));
}

TEST_P(LearnerLaws, ACloneIsEqualAndIndependent) {
  const auto original = person(2);
  live(*original, 1, 4);
  const auto before = state_of(*original);
  const auto clone = original->clone();
  EXPECT_EQ(state_of(*clone), before);
  live(*clone, 5, 9);
  EXPECT_EQ(state_of(*original), before);
  live(*original, 5, 9);
  EXPECT_EQ(state_of(*original), state_of(*clone));
}

// Who else is there, and in which order people are called, matters to nobody.
TEST_P(LearnerLaws, SeatsDoNotMatter) {
  const auto teach = [&](const std::vector<std::uint64_t>& seats) {
    std::map<std::uint64_t, std::unique_ptr<Learner>> team;
    for (const auto number : seats) team.emplace(number, person(number));
    for (std::size_t period = 1; period <= 5; ++period) {
      for (const auto number : seats) live_through_period(*team.at(number), period);
    }
    std::map<std::uint64_t, State> states;
    for (const auto& [number, learner] : team) states.emplace(number, state_of(*learner));
    return states;
  };
  const auto states = teach({1, 2, 3});
  EXPECT_EQ(teach({3, 1, 2}), states);
  EXPECT_EQ(teach({2}).at(2), states.at(2));
}

// A learner that is replayed from the beginning arrives where the first one is, whatever other learners the same
// cache has served.
TEST_P(LearnerLaws, AReplayArrivesAtTheSameState) {
  const auto learner = person(4);
  std::vector<State> history;
  for (std::size_t period = 1; period <= 5; ++period) {
    live_through_period(*learner, period);
    history.push_back(state_of(*learner));
  }
  for (std::size_t last = 1; last <= 5; ++last) {
    const auto again = person(4);
    live(*again, 1, last);
    EXPECT_EQ(state_of(*again), history[last - 1]) << last;
  }
}

TEST_P(LearnerLaws, MassesAreProbabilities) {
  const auto learner = person(5);
  EXPECT_EQ(learner->mass_in({}), 1.0);
  for (std::size_t period = 1; period <= 6; ++period) {
    live_through_period(*learner, period);
    const auto& bec = item_delivery().policy_bec_half_spaces();
    const double all = learner->mass_in(bec);
    EXPECT_GE(all, 0.0);
    for (const auto& half_space : bec) {
      const double one = learner->mass_in(std::array{half_space});
      EXPECT_LE(all, one + 1e-12);
      EXPECT_LE(one, 1.0 + 1e-12);
    }
  }
}

TEST_P(LearnerLaws, ParametersOutOfRangeAreRefusedWithNameAndRange) {
  for (const auto& parameter : model().parameters) {
    auto values = this->values();
    std::vector<ParameterValue> wrong;
    if (std::holds_alternative<double>(parameter.default_value)) {
      wrong = {parameter.min - 0.001, parameter.max + 0.001, std::nan("")};
      if (parameter.min_is_open) wrong.emplace_back(parameter.min);
      if (parameter.max_is_open) wrong.emplace_back(parameter.max);
    } else if (std::holds_alternative<std::int64_t>(parameter.default_value)) {
      wrong = {static_cast<std::int64_t>(parameter.min) - 1, static_cast<std::int64_t>(parameter.max) + 1};
    } else if (std::holds_alternative<Spread>(parameter.default_value)) {
      wrong = {Spread{}, Spread{.half_normal = 0.1, .value = 0.1},
               Spread{.half_normal = parameter.min - 0.1, .value = {}},
               Spread{.half_normal = {}, .value = parameter.max + 0.1}};
    }
    for (const auto& value : wrong) {
      try {
        values.set(parameter.name, value);
        ADD_FAILURE() << parameter.name << " = " << to_string(value) << " is taken";
      } catch (const Error& error) {
        const std::string message = error.what();
        EXPECT_NE(message.find(parameter.name), std::string::npos) << message;
        EXPECT_NE(message.find(range_of(parameter)), std::string::npos) << message;
      }
    }
    EXPECT_EQ(values, this->values());
  }
}

TEST_P(LearnerLaws, EverythingHasANameAndADescription) {
  EXPECT_EQ(find_learner_model(model().kind), &model());
  EXPECT_FALSE(model().description.empty());
  EXPECT_NE(model().description.back(), '.');
  for (const auto& parameter : model().parameters) {
    EXPECT_FALSE(parameter.description.empty()) << parameter.name;
    EXPECT_NE(parameter.description.back(), '.') << parameter.name;
    auto values = this->values();
    EXPECT_NO_THROW(values.set(parameter.name, parameter.default_value)) << parameter.name;
    for (const auto* taken : {"kind", "label", "prior"}) EXPECT_NE(parameter.name, taken);
  }
  for (const auto& trait : model().traits) {
    EXPECT_FALSE(trait.description.empty()) << trait.name;
    for (const auto* taken : {"member", "type", "p_bec", "periods", "tests", "correct"}) EXPECT_NE(trait.name, taken);
  }
  EXPECT_EQ(person(1)->ability().has_value(), model().has_ability);
  EXPECT_FALSE(describe_person(model(), values(), model().draw(values(), RandomStream{1})).empty());
}

// --- likelihood ----------------------------------------------------------------

AnswerEvidence evidence_of(std::span<const StartIndex> tests, std::span<const IntegerVector> answers) {
  std::vector<GivenAnswer> given;
  for (std::size_t t = 0; t < tests.size(); ++t) given.push_back({tests[t], answers[t]});
  return {item_delivery(), given};
}
AnswerEvidence evidence_of(StartIndex test, const IntegerVector& answer) {
  return evidence_of(std::array{test}, std::array{answer});
}

// The frequencies of n answers agree with the probabilities that the model gives them: each within 5 standard errors
// sqrt(p (1 - p) / n), and 1e-3 for weights on the border between two answers, which both regions count. The periods
// are the draws: what is drawn in one is independent of the others.
TEST_P(LearnerLaws, LikelihoodsAreTheFrequenciesOfAnswers) {
  constexpr int n = 4000;
  const auto learner = person(6);
  for (const std::size_t periods : {0u, 2u}) {
    live(*learner, 1, periods);
    for (const auto test : kTests) {
      std::map<IntegerVector, int> counts;
      int answered = 0;
      for (int draw = 1; draw <= n; ++draw) {
        const auto answer =
            learner->answer(behaviours_, std::array{test}, static_cast<std::size_t>(draw)).answers.front();
        if (!answer) continue;
        ++counts[*answer];
        ++answered;
      }
      ASSERT_GT(answered, 0);
      for (const auto& answer : item_delivery().tables().coverage_set(test)) counts.try_emplace(answer, 0);
      double sum = 0.0;
      for (const auto& [answer, count] : counts) {
        const double p = std::exp(log_likelihood(*learner, evidence_of(test, answer)));
        const double error = std::sqrt(p * (1.0 - p) / answered);
        EXPECT_NEAR(static_cast<double>(count) / answered, p, 5.0 * error + 1e-3);
        sum += p;
      }
      EXPECT_NEAR(sum, 1.0, 1e-3);
    }
  }
}

// The same of all answers of a period together, which come from one weight: each combination within 5 standard errors.
TEST_P(LearnerLaws, LikelihoodsOfSeveralAnswersAreTheFrequenciesOfAllTogether) {
  constexpr int n = 4000;
  const auto learner = person(6);
  live(*learner, 1, 2);
  std::map<std::vector<IntegerVector>, int> counts;
  int answered = 0;
  for (std::size_t draw = 1; draw <= n; ++draw) {
    std::vector<IntegerVector> answers;
    for (const auto& answer : learner->answer(behaviours_, kTests, draw).answers) {
      if (answer) answers.push_back(*answer);
    }
    if (answers.size() != kTests.size()) continue;
    ++counts[answers];
    ++answered;
  }
  ASSERT_GT(answered, 0);
  double sum = 0.0;
  for (const auto& [answers, count] : counts) {
    const double p = std::exp(log_likelihood(*learner, evidence_of(kTests, answers)));
    EXPECT_NEAR(static_cast<double>(count) / answered, p, 5.0 * std::sqrt(p * (1.0 - p) / answered) + 1e-3);
    sum += p;
  }
  EXPECT_LE(sum, 1.0 + 1e-9);
  EXPECT_GE(sum, 0.9);  // many rare combinations are not drawn
}

TEST_P(LearnerLaws, GuessingHasTheProbabilityOfChance) {
  const auto learner = person(7);
  const auto answer = item_delivery().tables().coverage_set(kTests[0])[0];
  const auto evidence = evidence_of(kTests[0], answer);
  EXPECT_DOUBLE_EQ(log_likelihood(*learner, evidence, 1.0), std::log(evidence.chance()));
  EXPECT_EQ(log_likelihood(*learner, AnswerEvidence{{}, {}, 1.0}, 0.5), 0.0);
}

INSTANTIATE_TEST_SUITE_P(AllModels, LearnerLaws, ::testing::ValuesIn(learner_models().begin(), learner_models().end()),
                         [](const auto& one) {
                           std::string name{one.param->kind};
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

}  // namespace
}  // namespace kith
