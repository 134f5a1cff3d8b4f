#pragma once

#include <string>
#include <vector>

#include "kith/fit/population_fit.hpp"

namespace kith {

struct FitOptions {
  std::size_t replicates = 2;  ///< Runs of the filter per person, see LikelihoodOptions.
  double slip = 0.01;          ///< Probability that a period is answered by guessing.
  std::uint64_t seed = 1;
  std::size_t num_types = 0;       ///< Types without labels; 0: types as labelled, or one.
  std::size_t folds = 5;           ///< Of the cross-validation; 0: none. Never more than people.
  std::size_t num_abilities = 12;  ///< Points of the grid.
  std::size_t num_gains = 5;
  double ability_first = 0.51;
  double ability_last = 0.95;
  double gain_last = 0.16;
  std::size_t num_draws = 100;  ///< Possible populations over which single people are averaged.
  ParallelOptions parallel{};
};

/// The grid on which fit_learners() computes likelihoods.
[[nodiscard]] ParameterGrid grid_of(const FitOptions& options);

/// What the answers say about the parameters of one population, in figures.
struct Identifiability {
  double ability = 0.0;  ///< Mean contraction over people, see ParameterPosterior::contraction(); the same for ...
  double confirm_gain = 0.0;
  double correct_gain = 0.0;
  double difference = 0.0;             ///< ... correct - confirm.
  double gain_correlation = 0.0;       ///< Mean over people.
  GainsTest gains;                     ///< Whether the two scales differ.
  bool gains_apart = false;            ///< They do: p < 0.05.
  std::vector<std::string> sentences;  ///< The same in words.
};

/// One population.
struct TypeReport {
  std::string name;  ///< The label, "all", or "type 1", ...
  /// The headline, and what learner_section() writes: medians of the posterior of the population's parameters
  /// (FitOptions::num_draws draws, see draw_populations()). Unlike the maximum of the likelihood they do not lie at an
  /// edge of what is searched.
  PopulationParameters median;
  PopulationParameters lower;  ///< 2.5 % quantiles of the same draws.
  PopulationParameters upper;  ///< 97.5 %.
  /// The population of the largest likelihood, with profile likelihood intervals.
  PopulationFit fit;
  double share = 1.0;
  Identifiability identifiability;
  std::vector<std::string> at_edge;  ///< Sentences: where the likelihood is largest at an edge of what is searched.
};

/// One person.
struct PersonReport {
  std::string id;
  std::string type;  ///< As labelled; empty: unknown.
  std::size_t periods = 0;
  std::size_t answered = 0;
  std::size_t correct = 0;
  std::vector<double> type_probabilities;  ///< In the order of the types; empty without unknown types.
  bool type_unclear = false;               ///< No type has a probability of 0.9.
  PersonPosterior posterior;
};

struct FitReport {
  bool complete = true;  ///< False: stopped; the rest is then empty.
  std::vector<TypeReport> types;
  std::vector<PersonReport> people;
  std::vector<CrossValidation> cross_validation;  ///< "full" first; empty if there are too few people.
  std::vector<std::string> sentences;             ///< What the comparison of models says.
  /// Whether the likelihoods have too much Monte-Carlo error to trust estimates and intervals; `sentences` say so.
  bool is_too_noisy = false;
  std::string why_estimates_differ;  ///< Medians of the posterior and maximum of the likelihood.
};

/// Fits people and populations by likelihood: see docs/fitting.md.
/// @throws kith::Error (kInfeasible, E0710) with fewer than 3 people, or a type with fewer than 2.
[[nodiscard]] FitReport fit_learners(const ResponseLogs& logs, const FitOptions& options);

/// A section of a study file for a population: "[learner.N]" and its keys with the posterior medians, ready to paste.
[[nodiscard]] std::string learner_section(char letter, const TypeReport& type);

}  // namespace kith
