#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "kith/belief/likelihood.hpp"
#include "kith/belief/prior_cover.hpp"
#include "kith/teaching/learner_hypothesis.hpp"
#include "kith/teaching/lesson.hpp"

namespace kith {

/// The tests that tell the hypotheses of a LearnerBank apart before anything was taught: greedily, the start that adds
/// most to the mutual information of the hypothesis and the answers,
///
///   I(H; A) = sum_h p_h sum_a P_h(a) log(P_h(a) / sum_g p_g P_g(a)),
///
/// where all answers of a person come from one weight of the person's belief. At most `n`, fewer if no other start adds
/// anything: where hypotheses differ in how people learn only, there are none. Where behaviours are not tabulated,
/// starts that test the constraints of the components, each component in turn.
/// @param cover  of the prior: what people believe who know nothing beforehand.
[[nodiscard]] std::vector<Test> placement_tests(const Atlas& atlas, const PriorCover& cover, LikelihoodForm likelihood,
                                                std::span<const LearnerHypothesis> hypotheses, std::size_t n);

/// The constraints of every knowledge component, without the prior's.
[[nodiscard]] std::vector<std::vector<HalfSpace>> constraints_of_components(const Atlas& atlas);
/// What somebody knows who knows some of these components: their constraints, each once.
/// @param known  bit k is component k.
[[nodiscard]] std::vector<HalfSpace> known_half_spaces(std::span<const std::vector<HalfSpace>> components,
                                                       std::uint32_t known);

/// The ability with which hypotheses take in what people know beforehand.
inline constexpr double kAbilityOfKnowing = 0.95;

}  // namespace kith
