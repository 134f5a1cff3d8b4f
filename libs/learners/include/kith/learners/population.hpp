#pragma once

#include <optional>
#include <string>

#include "kith/random/stream.hpp"

namespace kith {

/// How one gain parameter is spread over a population: half-normal with this
/// scale, or the same value for everybody.
struct GainDistribution {
  std::optional<double> half_normal;  ///< sigma; mean sigma * sqrt(2 / pi)
  std::optional<double> value;        ///< exactly one of the two is set
};

/// A type of learner, as in Table I of [jayaraman2024].
struct Population {
  std::string label;
  double ability_mean = 0.703;  ///< of beta_0
  double ability_sd = 0.034;
  double ability_min = 0.6;   ///< beta_0 is drawn again while <= this or >= ability_max.
  double ability_max = 0.95;  ///< cap on the ability at all times
  GainDistribution confirm_gain{.half_normal = 0.033, .value = {}};
  GainDistribution correct_gain{.half_normal = 0.056, .value = {}};
  double gain_max = 0.08;      ///< gains are drawn again, both, while one is >= this ...
  bool ordered_gains = true;   ///< ... or confirm >= correct.
  double ability_scale = 1.0;  ///< multiplies the log-odds of the current, capped ability at every update
};

/// The parameters of one simulated person, constant for a session.
struct LearnerParameters {
  double ability = 0.7;       ///< beta_0
  double confirm_gain = 0.0;  ///< added after a period in which all answers were right
  double correct_gain = 0.0;  ///< added after a period with a wrong answer
  double ability_max = 0.95;
  double ability_scale = 1.0;
  friend bool operator==(const LearnerParameters&, const LearnerParameters&) = default;
};

/// Draws one person. Order: beta_0 (normal, redrawn until inside the limits),
/// then both gains, redrawn together until they meet the rules; each from its own
/// branch of the stream, so that a change of one distribution leaves the other's draws.
/// @throws kith::Error (kInfeasible) if 10 000 draws do not meet the rules;
/// @throws std::invalid_argument on nonsensical limits: 0.5 <= ability_min < ability_max <= 1 must hold, scales
/// and spreads be finite and not negative, and each gain have exactly one of its two parameters.
[[nodiscard]] LearnerParameters draw_learner(const Population& population, RandomStream random);

}  // namespace kith
