#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "kith/core/parallel.hpp"
#include "kith/fit/lee2021.hpp"

namespace kith {

/// Answers whose predictions are about equally sure.
struct CalibrationBin {
  std::size_t answers = 0;
  double predicted = 0.0;  ///< Mean probability of a right answer.
  double right = 0.0;      ///< Share of right answers.
};

/// How well a model predicts whether people's answers are right.
struct AnswerPrediction {
  std::string model;
  double log_loss = 0.0;       ///< Mean of -log p(what was answered) over answers, nats.
  double log_loss_se = 0.0;    ///< Over people.
  double difference = 0.0;     ///< log_loss minus that of "bayesian", the filter of the paper.
  double difference_se = 0.0;  ///< Over people, paired.
  double area = 0.0;           ///< Under the receiver operating characteristic curve, of all answers together.
  std::size_t best_for = 0;    ///< People whom no other model predicts better.
  std::vector<CalibrationBin> calibration;  ///< Ten bins of width 0.1.
};

struct PredictionReport {
  bool complete = true;  ///< False: stopped; the rest is then empty.
  std::size_t people = 0;
  std::size_t answers = 0;
  std::vector<AnswerPrediction> models;
};

/// Predicts every answer of every person, in the order of the table, from their answers before and from all other
/// people (leave one person out). What the models know of other people are the shares of their parameters, difficulties
/// and means, fitted anew without the person.
///
/// * "everybody": the share right of the others.
/// * "person": the person's running share right, beginning with two answers of the others' share.
/// * "difficulty": the others' share right in this world, with two answers of their overall share.
/// * "Rasch": both [rasch1960]; fitted without a tenth of the people at a time.
/// * "bayesian": a belief over the prior after every constraint of the family's worlds was learned with an ability from
/// a
///   grid, as the videos should teach; the probability that weights drawn from it lead to a right path.
/// * "slipping", "noisy-rational", "misconceived": the same with that difference, on the grid of LearnerModel::fitted.
///   ("imitating" and "decaying" people need what was shown, and when, which the data do not tell.)
/// @throws kith::Error (kInfeasible, E0710) with fewer than three people; (kInvalidInput, E0702) if a response names a
/// world that is not among them.
[[nodiscard]] PredictionReport predict_answers(const std::vector<RecordedWorld>& worlds,
                                               const std::vector<RecordedResponse>& responses,
                                               const ParallelOptions& parallel = {});

}  // namespace kith
