#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "kith/random/stream.hpp"
#include "kith/stats/anova.hpp"

namespace kith {

/// Analysis of variance by permutation: each term's F is compared with those of
/// data in which the residuals of the model without that term are shuffled
/// (Freedman and Lane), so that nothing need be normal. p = (1 + #{F* >= F}) / (1 + permutations).
/// The table is that of anova(); only the p-values differ. Deterministic given the stream.
[[nodiscard]] AnovaTable permutation_anova(std::span<const double> response, std::span<const Factor> factors,
                                           std::span<const std::vector<std::size_t>> terms, SumsOfSquares type,
                                           std::size_t permutations, RandomStream random);

/// Aligned rank transform: for each term the response is stripped of all other effects, ranked, and analysed
/// (type III); the row of that term is kept [wobbrock2011]. Needs a full factorial model without empty cells: terms
/// that cannot be aligned say why.
[[nodiscard]] AnovaTable aligned_rank_anova(std::span<const double> response, std::span<const Factor> factors);

}  // namespace kith
