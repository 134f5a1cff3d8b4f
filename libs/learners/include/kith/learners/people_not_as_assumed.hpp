#pragma once

#include <span>

#include "kith/learners/learner_model.hpp"

namespace kith {

/// Simulated people of whom judges assume too much, 16 kinds: they have the parameters of the model "bayesian", but
/// guess, copy, stop learning, hold on to what they think, or answer otherwise than they believe. To rehearse an exam
/// and to test who is said to understand; no study can name them. The first six are those of docs/audit.md. The last,
/// who imitate, need an atlas with tables.
[[nodiscard]] std::span<const LearnerModel> people_not_as_assumed();

}  // namespace kith
