#pragma once

#include <string>
#include <vector>

#include "kith/analysis/marginal_means.hpp"
#include "model.hpp"

namespace kith {

// "from 6.70 (PPP) to 8.53 (NNN)": the estimated marginal means of a factor.
[[nodiscard]] std::string range_of_means(const FixedEffects& model, const std::string& factor);

// Adds the estimated marginal means of every factor, if asked for; all pairs of them (Tukey-Kramer), also at each level
// of the factors in options.by; and the planned contrasts.
void add_marginal_results(const FixedEffects& model, const AnalysisOptions& options, bool with_means, Finding& finding,
                          std::vector<ResultTable>& tables);

// Adds the planned contrasts only.
void add_contrast_results(const FixedEffects& model, const AnalysisOptions& options, Finding& finding,
                          std::vector<ResultTable>& tables);

// One planned contrast of the marginal means of its factor, uncorrected. @pre is_testable().
[[nodiscard]] LinearEstimate contrast_estimate(const FixedEffects& model, const PlannedContrast& contrast,
                                               double confidence);

// Whether a term contains both factors; if not, differences between levels of one are the same at all levels of the
// other.
[[nodiscard]] bool interact(const std::vector<std::vector<std::size_t>>& terms, std::size_t a, std::size_t b);

// Whether some factor has all levels of a contrast.
[[nodiscard]] bool is_testable(const std::vector<Factor>& factors, const PlannedContrast& contrast);

// @throws kith::Error (kUsage) if the options name a factor or levels that the model does not have.
void check_comparisons(const std::vector<Factor>& factors, const AnalysisOptions& options);

}  // namespace kith
