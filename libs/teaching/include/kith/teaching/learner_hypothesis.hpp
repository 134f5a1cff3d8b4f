#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "kith/belief/particle_belief.hpp"

namespace kith {

struct PresumedKind;

/// What a person may be like; abilities are those with which the person learns, after any scaling.
struct LearnerHypothesis {
  double ability = 0.8;         ///< beta_0, at the start of every knowledge component, in [0.5, 1].
  double confirm_gain = 0.02;   ///< Added after a period with all answers right, >= 0.
  double correct_gain = 0.045;  ///< Added after a period with a wrong answer, >= 0.
  double probability = 1.0;     ///< Before anything was observed, > 0; those of a bank need not sum to 1.
  std::uint32_t known = 0;      ///< Components that the person knows beforehand: bit k is component k.
  std::shared_ptr<const PresumedKind> kind{};  ///< How the person learns and answers; null: by the paper's model.
  friend bool operator==(const LearnerHypothesis&, const LearnerHypothesis&) = default;
};

/// @throws std::invalid_argument if there is no hypothesis or one is out of range.
void require_hypotheses(std::span<const LearnerHypothesis> hypotheses);

/// One person of average ability: (0.8, 0.02, 0.045).
[[nodiscard]] std::vector<LearnerHypothesis> one_hypothesis();
/// Abilities 0.62, 0.68, ..., 0.92, each with the gains (0.01, 0.03) and (0.03, 0.055), all equally probable.
[[nodiscard]] std::vector<LearnerHypothesis> grid_of_hypotheses();

/// The components that people may know beforehand: all but the last, which has the constraints of all others, so that
/// who knows it knows everything; that one if it is the only one.
[[nodiscard]] constexpr std::size_t num_known_by_chance(std::size_t num_components) noexcept {
  return num_components > 1 ? num_components - 1 : num_components;
}

/// People of average ability who know each of these components beforehand or not: all 2^n combinations for up to four
/// of them, else nothing, any single one and the first k of them; all equally probable.
/// @throws std::invalid_argument for more than 31 components.
[[nodiscard]] std::vector<LearnerHypothesis> grid_of_known_components(std::size_t num_components);

/// How often a person answers by pressing the keys of a demonstration again, one of those shown so far, with
/// probability proportional to exp(-distance / temperature) [lage2019].
struct Imitation {
  double probability = 0.0;
  double temperature = 1.0;  ///< > 0
  friend bool operator==(const Imitation&, const Imitation&) = default;
};

/// What a member may be like, and what the member would then believe.
struct MemberHypothesis {
  double weight = 1.0;                     ///< Probability of the hypothesis, >= 0.
  const ParticleBelief* belief = nullptr;  ///< Never null.
  double shown_ability = 0.8;              ///< beta while watching demonstrations, in [0.5, 1].
  double feedback_ability = 0.8;           ///< beta while hearing the feedback, in [0.5, 1].
  Imitation imitation{};                   ///< How often answers do not come from the belief.
};

}  // namespace kith
