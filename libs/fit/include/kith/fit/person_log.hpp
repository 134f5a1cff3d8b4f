#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kith/core/diagnostic.hpp"
#include "kith/geometry/cone.hpp"
#include "kith/learners/learner_model.hpp"

namespace kith {

/// What a person saw, was asked and heard in one interaction period.
struct LoggedPeriod {
  std::size_t component = 1;          ///< 1-based; another one than before sets the ability back.
  std::vector<HalfSpace> conveyed;    ///< By the demonstrations, watched at the current ability.
  std::vector<HalfSpace> possible;    ///< Weights with a finite optimum in every test, the only ones that answer.
  std::vector<AnswerRegion> answers;  ///< One per test that was answered.
  double chance = 1.0;                ///< Probability of these answers by guessing.
  bool all_correct = true;            ///< Which gain the feedback brings.
  bool feedback = true;               ///< Whether the person heard which answers were right.
  std::vector<HalfSpace> taught;      ///< By the feedback, at the changed ability.
  // What find_answer_regions() needs besides. Only from run folders.
  std::vector<GivenAnswer> given;  ///< The paths that were answered.
  std::vector<bool> given_right;   ///< Whether they were right, shape [given].
};

/// What is taken for known about a learner of the model "bayesian": all but the parameters that are fitted.
struct KnownLearner {
  ParameterValues parameters{bayesian_model().parameters};  ///< Of these, ability and gains are not used.
  Cone prior;                                               ///< Where the person's belief starts, uniformly.
  LikelihoodForm form = LikelihoodForm::kDiscontinuous;
  std::shared_ptr<const Atlas> atlas{};  ///< Of the domain; null if only constraints are known of it.
};

/// Of a simulated person.
struct TrueParameters {
  double ability = 0.0;
  double confirm_gain = 0.0;
  double correct_gain = 0.0;
};

/// One person's sequence.
struct PersonLog {
  std::string id;         ///< Unique: "7/2" is member 2 of team 7.
  std::string type;       ///< Learner type as labelled; empty: unknown.
  std::size_t model = 0;  ///< Index into ResponseLogs::models.
  std::vector<LoggedPeriod> periods;
  std::size_t answered = 0;               ///< Tests answered, in all periods.
  std::size_t correct = 0;                ///< Of these.
  std::optional<TrueParameters> truth{};  ///< If known; for recovery() only, no estimate depends on it.
};

/// What a person was taught, as text: the same for people of any name, in any order of the files, and whatever they
/// answered, so that the probabilities of all answers sum to 1. Random streams of a person are addressed by it.
[[nodiscard]] std::string lessons_of(const PersonLog& person);

/// How the answers of people were told apart where no tables say which paths are best for somebody; see
/// find_answer_regions().
struct PathSample {
  std::size_t weights = 0;  ///< For which paths were planned.
  std::size_t paths = 0;    ///< Different ones of all tests together.
  std::size_t checked = 0;  ///< Weights of the last round, drawn after all others.
  std::size_t missed = 0;   ///< Of these, the weights with a path that was not known before.
};

/// The people of some logs, in the order of the files, and everything worth saying about how they were read.
struct ResponseLogs {
  std::vector<PersonLog> people;
  std::vector<KnownLearner> models;
  std::optional<PathSample> sample;  ///< Set by find_answer_regions().
  std::vector<Diagnostic> notes;     ///< Warnings: what was repaired, left out or doubtful.
};

/// How much of an answer is used.
enum class AnswerDetail {
  kPath,     ///< Which path was taken: the weight lies where this path is the best one.
  kVerdict,  ///< Only whether it was right.
};

}  // namespace kith
