#pragma once

#include <cstddef>
#include <span>

namespace kith {

/// How often something holds of a person, under one hypothesis about the person.
struct WeightedShare {
  double weight = 1.0;  ///< Probability of the hypothesis, >= 0.
  double share = 0.0;   ///< In [0, 1].
};

struct CredibleLevelOptions {
  double enough = 0.8;       ///< The share that counts as enough, in (0, 1).
  double coverage = 0.8;     ///< Probability of the interval, in (0, 1).
  double precision = 160.0;  ///< n > 0 of the Beta(n share, n (1 - share)) that each hypothesis stands for.
};

/// How often something holds of a person, and how well that is known.
struct CredibleLevel {
  double mean = 0.0;  ///< Expected share: the probability that it holds the next time.
  /// The share lies in [low, high] with probability `coverage`: equal tails, but never without the mean, which few but
  /// very different hypotheses can put into a tail; then the probability is larger.
  double low = 0.0;
  double high = 1.0;         ///< See low.
  double probability = 0.0;  ///< That the share is at least `enough`.
  friend bool operator==(const CredibleLevel&, const CredibleLevel&) = default;
};

/// The level of a mixture of hypotheses. Each stands for a Beta distribution about its share, because hypotheses are
/// few, and people of one kind differ by chance in what they take in.
/// @throws std::invalid_argument if an option is out of range, or no weight is above 0.
[[nodiscard]] CredibleLevel credible_level(std::span<const WeightedShare> shares,
                                           const CredibleLevelOptions& options = {});

/// CredibleLevel::probability alone, of a mixture and of one hypothesis. @pre the options are in range.
[[nodiscard]] double probability_of_enough(std::span<const WeightedShare> shares,
                                           const CredibleLevelOptions& options = {});
[[nodiscard]] double probability_of_enough(double share, const CredibleLevelOptions& options = {});

/// The level by nothing but the answers: Beta(1 + right, 1 + wrong). `precision` is not used.
/// @throws std::invalid_argument if an option is out of range, or right > tests.
[[nodiscard]] CredibleLevel level_by_answers(std::size_t right, std::size_t tests,
                                             const CredibleLevelOptions& options = {});

}  // namespace kith
