#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "kith/core/option_key.hpp"

namespace kith {

/// How p-values of a family of tests are adjusted: so that the chance of any false claim stays below alpha (Bonferroni,
/// Holm), or the expected share of false claims among all claims (false discovery rate) [benjamini1995].
enum class Correction { kNone, kBonferroni, kHolm, kFdr };
[[nodiscard]] std::string_view to_string(Correction correction) noexcept;
/// As options and plans name them.
template <>
inline constexpr std::array kWordsFor<Correction>{WordFor{Correction::kBonferroni, "bonferroni"},
                                                  WordFor{Correction::kHolm, "holm"}, WordFor{Correction::kFdr, "fdr"},
                                                  WordFor{Correction::kNone, "none"}};

/// Adjusted p-values, in the order given, in [0, 1] (R: p.adjust).
[[nodiscard]] std::vector<double> adjust(std::span<const double> p_values, Correction correction);

/// P(Q > q) of the studentised range of `groups` means with `df` degrees of freedom, which may be infinite. The
/// integral that defines it, within 1e-10 relative for up to 1000 groups, however small. R's
/// ptukey(lower.tail = FALSE) agrees within 1e-6 where it is accurate itself; for few degrees of freedom or large q it
/// is off by up to two percent, and 0 for large q. Costs a fraction of a millisecond.
/// @throws std::invalid_argument unless q >= 0, groups >= 2, df >= 2 (R's limits).
[[nodiscard]] double studentized_range_upper(double q, std::size_t groups, double df);
/// The q with studentized_range_upper(q, groups, df) = p, for p in (0, 1).
[[nodiscard]] double studentized_range_quantile(double p, std::size_t groups, double df);

}  // namespace kith
