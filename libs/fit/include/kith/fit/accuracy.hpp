#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "kith/fit/lee2021.hpp"

namespace kith {

/// Whether somebody answered a question rightly: all that data without exposures say.
struct AccuracyRecord {
  std::string person;
  std::string item;
  bool correct = false;
};

/// What is known about one person's accuracy.
struct AccuracyPerson {
  std::string id;
  std::size_t answered = 0;
  std::size_t correct = 0;
  double ability =
      0.0;  ///< Posterior mean, in log-odds: 0 answers a question of difficulty 0 rightly half of the time.
  double sd = 0.0;
  double lower = 0.0;  ///< 2.5 %
  double upper = 0.0;  ///< 97.5 %
};

struct AccuracyItem {
  std::string id;
  std::size_t answered = 0;
  std::size_t correct = 0;
  double difficulty = 0.0;  ///< In log-odds.
};

/// The Rasch model [rasch1960]: P(right) = 1 / (1 + exp(difficulty - ability)), abilities N(0, sd^2) over people.
struct AccuracyFit {
  double ability_sd = 0.0;
  /// Share of the variance of the abilities that is not error of estimation, in [0, 1].
  double reliability = 0.0;
  std::vector<AccuracyPerson> people;  ///< In order of appearance.
  std::vector<AccuracyItem> items;     ///< In order of appearance.
};

/// Marginal maximum likelihood by expectation-maximisation over 61 abilities; difficulties have a weak prior N(0, 3^2),
/// so that questions that everybody answered alike stay finite.
/// These abilities are log-odds of being right, not the learning ability of kith's learners: without exposures and
/// feedback in the data nothing can be said about that, nor about gains.
/// @throws kith::Error (kInfeasible, E0710) without people or with one question only.
[[nodiscard]] AccuracyFit fit_accuracy(const std::vector<AccuracyRecord>& records);

/// The records of the 2021 study: questions are its worlds.
[[nodiscard]] std::vector<AccuracyRecord> accuracy_records(const std::vector<RecordedResponse>& responses);

}  // namespace kith
