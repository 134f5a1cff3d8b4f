#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "kith/core/parallel.hpp"
#include "kith/fit/person_log.hpp"

namespace kith {

struct KindsOptions {
  std::size_t replicates = 1;  ///< Runs of the filter per person and point whose probabilities are averaged.
  double slip = 0.01;          ///< Probability that a period is answered by guessing, whoever answers.
  std::uint64_t seed = 1;
  std::vector<double> abilities{0.6, 0.65, 0.7, 0.75, 0.8, 0.85, 0.9};  ///< That are compared.
  ParallelOptions parallel{};
};

/// What is known about one parameter of a person, if they are of a kind.
struct KindParameter {
  std::string name;  ///< "ability" or a name of LearnerModel::fitted.
  double mean = 0.0;
  double lower = 0.0;  ///< 5 %
  double upper = 0.0;  ///< 95 %
};

/// How well the kinds explain one person.
struct KindOfPerson {
  std::string id;
  std::string type;                  ///< As labelled; empty: unknown.
  std::size_t answered = 0;          ///< Tests.
  std::vector<double> log_evidence;  ///< log p(all answers | kind), averaged over its parameters; shape [kinds].
  std::vector<double> probability;   ///< Of the kinds, if all are equally probable beforehand; shape [kinds].
  std::size_t likeliest = 0;         ///< Index of a kind.
  bool is_unclear = false;           ///< No kind has a probability of 0.9: cannot tell yet.
  std::vector<std::vector<KindParameter>> parameters;  ///< Shape [kinds][parameters].
};

/// How well one kind explains everybody.
struct KindOfPopulation {
  std::string kind;
  double share = 0.0;          ///< Of people, by expectation-maximisation over the kinds.
  std::size_t described = 0;   ///< People whom no kind describes better.
  double log_evidence = 0.0;   ///< Summed over people.
  double difference = 0.0;     ///< log_evidence minus that of the first kind.
  double difference_se = 0.0;  ///< Of people.
};

struct KindsReport {
  bool complete = true;  ///< False: stopped; the rest is then empty.
  std::vector<KindOfPopulation> kinds;
  std::vector<KindOfPerson> people;
};

/// Asks of every person what kind of learner they are, for all models with the parameters of "bayesian": each is
/// replayed at every combination of its LearnerModel::fitted and of some abilities, all equally probable, with the mean
/// gains that the logs' study gives. The evidence of a kind is the mean of the likelihoods, so it predicts every answer
/// from those before, and a kind with more parameters has no advantage.
/// @throws kith::Error (kInfeasible, E0710) without people; (kInvalidInput, E0714) if the logs do not have paths.
[[nodiscard]] KindsReport fit_kinds(const ResponseLogs& logs, const KindsOptions& options,
                                    LearnerModels models = learner_models());

}  // namespace kith
