#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "kith/random/stream.hpp"
#include "kith/stats/anova.hpp"
#include "kith/stats/estimable.hpp"
#include "kith/stats/factor.hpp"

namespace kith {

/// Analysis of variance by permutation, so that nothing need be normal [freedman1983].
///
/// The table is that of anova(); only the p-values differ. For each term, the reduced model is the one that the sum of
/// squares of its type compares with: all other terms (type III), or all other terms that do not contain it (type II,
/// where the term and all that contain it are null). Its residuals e = y - fitted are shuffled over all observations;
/// F* is the term's F, of the same type and with the residuals of the whole model below, in fitted + shuffled e.
///
///   p = (1 + #{F* >= F}) / (1 + permutations),
///
/// never 0, and exact for a single term, whose reduced model is the mean alone; otherwise exact in the limit of many
/// observations. The same shuffles serve all terms. Values of F that differ by rounding only count as equal.
///
/// @param permutations  >= 1; 999 resolve p to 0.001.
/// @throws std::invalid_argument as anova() does, or if permutations is 0.
/// Costs one pass over the observations per permutation.
[[nodiscard]] AnovaTable permutation_anova(std::span<const double> response, std::span<const Factor> factors,
                                           std::span<const std::vector<std::size_t>> terms, SumsOfSquares type,
                                           std::size_t permutations, RandomStream random);

/// The response stripped of all effects but those of one term: what lies about the cells' means, plus the term's
/// effect, as a deviation from the grand mean; one value per observation [wobbrock2011].
///
/// A term's effect in a cell is the alternating sum of marginal means. Marginal means are means of cells' means, each
/// counting once. Where all cells have equally many observations this is the source's definition; where they have
/// not, the source's means over observations would let other effects leak in. In the aligned response all other terms
/// of the full factorial model have no effect at all (type III).
///
/// @param factors  one to four. @param term  indices of `factors`.
/// @throws std::invalid_argument if there are no or more factors, shapes differ, a value is not finite, or the term
///         names no factor.
/// Not estimable if a combination of levels has no observations.
[[nodiscard]] Estimable<std::vector<double>> aligned_response(std::span<const double> response,
                                                              std::span<const Factor> factors,
                                                              std::vector<std::size_t> term);

/// Aligned rank transform of the full factorial model of one to four factors: for each term the response is aligned
/// (aligned_response()), ranked with mean ranks for ties, and analysed (type III); the row of that term is kept
/// [wobbrock2011].
///
/// Rows are those of all sets of factors, main effects first; their sums of squares are of ranks, each in its own
/// ranking. The table's residuals and their sum of squares are those of the response itself about the cells' means,
/// which all alignments share. Terms that cannot be aligned (a combination of levels without observations) say why.
/// @throws std::invalid_argument as aligned_response() does.
[[nodiscard]] AnovaTable aligned_rank_anova(std::span<const double> response, std::span<const Factor> factors);

}  // namespace kith
