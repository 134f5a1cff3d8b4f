#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "kith/fit/log_likelihood.hpp"

namespace kith {

/// A population of learners: beta_0 normal, both gains half-normal, as in a study file.
struct PopulationParameters {
  double ability_mean = 0.7;
  double ability_sd = 0.03;
  double confirm_scale = 0.03;  ///< sigma; the mean gain is 0.80 sigma
  double correct_scale = 0.05;
  friend bool operator==(const PopulationParameters&, const PopulationParameters&) = default;
};

/// The edges of what fit_population() searches.
inline constexpr PopulationParameters kSmallestPopulation{0.5, 0.003, 0.001, 0.001};
inline constexpr PopulationParameters kLargestPopulation{1.0, 0.3, 0.5, 0.5};

/// What is known to be impossible: abilities and gains outside are not drawn.
struct PopulationLimits {
  double ability_min = 0.5;
  double ability_max = 0.95;
  double gain_max = 0.08;
  bool ordered_gains = false;  ///< confirm <= correct
};

/// How the gains of a population are spread.
enum class GainModel {
  kFree,   ///< Two half-normals.
  kEqual,  ///< A person's gains are one number, half-normal.
  kNone,   ///< Nobody gains anything.
};

/// The people's likelihoods on a refined grid, on which everything about populations is computed: log-likelihoods are
/// interpolated by cubics [catmull1974] in every parameter, between the points where the filter was run.
class LikelihoodSurface {
 public:
  /// @param refine  points of the new grid per step of abilities; of gains there are 2.
  /// @throws std::invalid_argument unless the table is complete, has people and refine >= 1.
  explicit LikelihoodSurface(const LikelihoodTable& table, std::size_t refine = 5);

  [[nodiscard]] std::size_t num_people() const noexcept { return relative_.size(); }
  [[nodiscard]] const std::vector<double>& abilities() const noexcept { return abilities_; }
  [[nodiscard]] const std::vector<double>& gains() const noexcept { return gains_; }
  [[nodiscard]] double ability_step() const noexcept { return abilities_[1] - abilities_[0]; }
  [[nodiscard]] double gain_step() const noexcept { return gains_[1] - gains_[0]; }
  /// Likelihood over the person's largest one, shape [abilities, gains, gains] (confirm, then correct).
  [[nodiscard]] const std::vector<double>& relative(std::size_t person) const { return relative_[person]; }
  /// The person's largest log-likelihood.
  [[nodiscard]] double log_top(std::size_t person) const { return log_top_[person]; }

 private:
  std::vector<double> abilities_;
  std::vector<double> gains_;
  std::vector<std::vector<double>> relative_;
  std::vector<double> log_top_;
};

/// The prior masses of a population's cells about the points of a surface.
struct PopulationMasses {
  std::vector<double> abilities;  ///< Shape [abilities]; sums to 1.
  std::vector<double> gains;      ///< Shape [gains, gains]; sums to 1.
};
[[nodiscard]] PopulationMasses masses_of(const LikelihoodSurface& surface, const PopulationParameters& population,
                                         const PopulationLimits& limits, GainModel gains);

/// log of the probability of one person's answers in a population: the likelihood averaged over the prior masses.
[[nodiscard]] double log_marginal(const LikelihoodSurface& surface, std::size_t person, const PopulationMasses& masses);

/// An interval of a parameter. An end is open if the data do not limit the parameter there: the likelihood stays within
/// the bound up to the edge of what is searched.
struct FitInterval {
  double lower = 0.0;
  double upper = 0.0;
  bool lower_open = false;
  bool upper_open = false;
};

/// Parameters of a population, fitted by marginal maximum likelihood.
struct PopulationFit {
  PopulationParameters parameters;
  GainModel gains = GainModel::kFree;
  double log_likelihood = 0.0;
  double people = 0.0;  ///< Sum of the weights.
  // 95 % intervals by profile likelihood: where twice the loss of log-likelihood, the other parameters refitted, stays
  // below 3.84. Only from fit_with_intervals().
  FitInterval ability_mean;
  FitInterval ability_sd;
  FitInterval confirm_scale;
  FitInterval correct_scale;
};

/// @param weights  one per person, >= 0, some positive; empty: 1 for everybody.
/// @param start    where the search begins.
/// @throws std::invalid_argument if the number of weights is wrong.
[[nodiscard]] PopulationFit fit_population(const LikelihoodSurface& surface, const std::vector<double>& weights,
                                           const PopulationLimits& limits, GainModel gains,
                                           const PopulationParameters& start = {});
/// The same with intervals.
[[nodiscard]] PopulationFit fit_with_intervals(const LikelihoodSurface& surface, const std::vector<double>& weights,
                                               const PopulationLimits& limits, GainModel gains);

/// Twice the difference of log-likelihood between free scales of the gains and one scale for both, without an
/// order of the gains; chi-squared with one degree of freedom if they are equal.
struct GainsTest {
  double statistic = 0.0;
  double p = 1.0;
};
[[nodiscard]] GainsTest compare_gain_scales(const LikelihoodSurface& surface, const std::vector<double>& weights,
                                            PopulationLimits limits);

/// Populations that the answers leave possible: draws from the posterior of the population's parameters, by a random
/// walk of Metropolis in (mean, log sd, log scales) with a flat prior on the mean and half-normal priors of scale 0.1
/// on the others. What is said about single people is averaged over them, so that it does not pretend the
/// population to be known. [gelman2013, section 11.2]
[[nodiscard]] std::vector<PopulationParameters> draw_populations(const LikelihoodSurface& surface,
                                                                 const std::vector<double>& weights,
                                                                 const PopulationLimits& limits,
                                                                 const PopulationFit& start, std::size_t num_draws,
                                                                 RandomStream random);

/// Populations whose members are not labelled.
struct MixtureFit {
  std::vector<PopulationFit> types;              ///< By ascending mean ability.
  std::vector<double> shares;                    ///< Sum to 1.
  std::vector<std::vector<double>> probability;  ///< Of the types, per person, shape [people][types].
  double log_likelihood = 0.0;
  std::size_t rounds = 0;
};

/// Expectation-maximisation: the probability of each person's type, then each type's population with these
/// weights, until the log-likelihood rises by less than 0.001 (at most 100 rounds).
/// @throws std::invalid_argument unless 1 <= num_types <= people.
[[nodiscard]] MixtureFit fit_mixture(const LikelihoodSurface& surface, std::size_t num_types,
                                     const PopulationLimits& limits);

/// What is known about a parameter of one person.
struct ParameterPosterior {
  double mean = 0.0;
  double sd = 0.0;
  double lower = 0.0;  ///< 2.5 %
  double upper = 0.0;  ///< 97.5 %
  double prior_sd = 0.0;
  /// 1 - sd^2 / prior_sd^2: the share of the population's variance that the person's answers remove. 0: they say
  /// nothing.
  [[nodiscard]] double contraction() const noexcept {
    return prior_sd > 0.0 ? 1.0 - sd * sd / (prior_sd * prior_sd) : 0.0;
  }
};

/// One person's parameters, under the population as prior.
struct PersonPosterior {
  ParameterPosterior ability;
  ParameterPosterior confirm_gain;
  ParameterPosterior correct_gain;
  ParameterPosterior difference;  ///< correct - confirm; no limits.
  double gain_correlation = 0.0;  ///< Of both gains, given the answers; 0 if one of them is known.
};
[[nodiscard]] PersonPosterior posterior_of(const LikelihoodSurface& surface, std::size_t person,
                                           const PopulationMasses& masses);
/// The same where several populations are possible, each with its probability for this person.
[[nodiscard]] PersonPosterior posterior_of(const LikelihoodSurface& surface, std::size_t person,
                                           const std::vector<PopulationMasses>& masses,
                                           const std::vector<double>& probabilities);

/// How well a model predicts people it was not fitted to.
struct CrossValidation {
  std::string model;         ///< "full", "equal gains", "no gains", "two types", "types as labelled"
  double log_density = 0.0;  ///< Summed over people, each held out once.
  double difference = 0.0;   ///< log_density minus that of "full".
  double difference_se = 0.0;
};

/// K-fold cross-validation over people: person i is in fold (position of i in an order by seed) mod K.
/// @param labels  types per person; "types as labelled" is compared if there are at least two, each with two people in
///                every training set.
/// @throws std::invalid_argument unless 2 <= folds <= people.
[[nodiscard]] std::vector<CrossValidation> cross_validate(const LikelihoodSurface& surface,
                                                          const std::vector<std::string>& labels,
                                                          const PopulationLimits& limits, std::size_t folds,
                                                          std::uint64_t seed, const ParallelOptions& parallel);

}  // namespace kith
