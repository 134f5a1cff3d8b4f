#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kith/belief/likelihood.hpp"
#include "kith/belief/prior_cover.hpp"
#include "kith/core/parameter.hpp"
#include "kith/core/stream.hpp"
#include "kith/learners/learner.hpp"

namespace kith {

/// A number that describes one person and stays the same for a session: a column of learners.csv.
struct LearnerTrait {
  std::string_view name;         ///< Of the column. Models that share a name share the column.
  std::string_view description;  ///< One sentence with a full stop, for the codebook.
};

/// A combination of parameters that makes no sense, although each of them is in its range.
struct ParameterProblem {
  std::string_view where;  ///< Name of a parameter, or of a table of them, to point at.
  std::string message;
  std::string hint{};
};

/// What a person starts with besides the model's parameters.
struct LearnerStart {
  /// Points that cover what people of this type know beforehand (their prior) evenly, so many of them. What it returns
  /// stays where it is until the person is made.
  std::function<const PriorCover&(std::size_t num_points)> cover;
  LikelihoodForm likelihood = LikelihoodForm::kDiscontinuous;  ///< As in `teacher.likelihood`.
  /// The constraints of every knowledge component, for people who know some of them; may be empty.
  std::function<std::vector<std::vector<HalfSpace>>()> components{};
  bool records_support = false;  ///< As in FilterOptions.
};

/// A parameter of a model that `kith fit --kinds` estimates, with the values that it compares, ascending.
struct FittedParameter {
  std::string_view name;
  std::span<const double> values;
};

/// A kind of simulated learner: a row of the registry. To add one, see docs/library.md.
struct LearnerModel {
  std::string_view kind;                   ///< `learner.X.kind` in study files.
  std::string_view description;            ///< One sentence without a full stop.
  std::span<const Parameter> parameters;   ///< Keys of `[learner.X]` besides kind, label and prior.
  std::span<const LearnerTrait> traits{};  ///< What draw() returns.
  bool has_ability = false;                ///< Whether Learner::ability() has a value.
  bool needs_paths = false;                ///< Whether Learner::likelihood() takes only evidence with paths.

  /// What is estimated of people besides their ability, which may be nothing.
  std::span<const FittedParameter> fitted{};

  /// What is wrong with parameters that are each in their range, if anything. May be null.
  std::optional<ParameterProblem> (*check)(const ParameterValues& values) = nullptr;
  /// Draws one person: a number per trait. @throws kith::Error (kInfeasible) if no person meets the parameters.
  std::vector<double> (*draw)(const ParameterValues& values, RandomStream random) = nullptr;
  /// The person with these traits, before the first component.
  std::function<std::unique_ptr<Learner>(const ParameterValues& values, std::span<const double> traits,
                                         const LearnerStart& start, RandomStream random)>
      make{};
  /// The person in a few words, for transcripts. May be null; then the traits are listed.
  std::string (*describe)(const ParameterValues& values, std::span<const double> traits) = nullptr;
};

/// A list of models. The models have to stay while studies refer to them, as built-in ones do.
using LearnerModels = std::span<const LearnerModel* const>;

/// The built-in models. The first one is what a learner type without `kind` is.
[[nodiscard]] LearnerModels learner_models();
/// The built-in model "bayesian" (see BayesianLearner).
[[nodiscard]] const LearnerModel& bayesian_model();
/// The built-in models of other minds: people who learn like those of "bayesian" but for what their description says.
/// They have its parameters and traits, and some of their own.
[[nodiscard]] const LearnerModel& slipping_model();
[[nodiscard]] const LearnerModel& noisy_rational_model();
[[nodiscard]] const LearnerModel& imitating_model();
[[nodiscard]] const LearnerModel& misconceived_model();
[[nodiscard]] const LearnerModel& decaying_model();
/// The model of this kind, or null.
[[nodiscard]] const LearnerModel* find_learner_model(std::string_view kind, LearnerModels models = learner_models());

/// The person in a few words: "ability 0.7193, gains 0.0072 confirmed ...".
[[nodiscard]] std::string describe_person(const LearnerModel& model, const ParameterValues& values,
                                          std::span<const double> traits);

/// Points of the beliefs of these people: the parameter `particles`; 0 if the model has no such parameter.
[[nodiscard]] std::size_t num_particles(const ParameterValues& values);

/// `particles` and `process_noise`, to be declared by models whose people have a particle belief.
[[nodiscard]] Parameter particles_parameter();
[[nodiscard]] Parameter process_noise_parameter();

}  // namespace kith
