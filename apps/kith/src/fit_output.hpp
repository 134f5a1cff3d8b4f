#pragma once

#include <string>
#include <vector>

#include "console.hpp"
#include "kith/fit/accuracy.hpp"
#include "kith/fit/fit.hpp"
#include "kith/fit/grid_search.hpp"
#include "kith/fit/kinds_fit.hpp"
#include "kith/fit/predict_answers.hpp"
#include "kith/fit/recovery.hpp"
#include "kith/present/json.hpp"

namespace kith::cli {

// What `kith fit` found, as people read it, and as documents of schema kith.fit/1, whose "method" says which of them it
// is.

[[nodiscard]] std::string text_of(const FitReport& report, const std::vector<ParameterRecovery>& recovered,
                                  const Console& console);
[[nodiscard]] std::string text_of(const AccuracyFit& fit, const Console& console);
[[nodiscard]] std::string text_of(const std::vector<GridSearchGroup>& groups, const Console& console);
[[nodiscard]] std::string text_of(const KindsReport& report, const Console& console);
[[nodiscard]] Json to_json(const KindsReport& report);
[[nodiscard]] std::string text_of(const PredictionReport& report, const Console& console);
[[nodiscard]] Json to_json(const PredictionReport& report);
[[nodiscard]] Json to_json(const FitReport& report, const std::vector<ParameterRecovery>& recovered,
                           const std::vector<Diagnostic>& notes);
[[nodiscard]] Json to_json(const AccuracyFit& fit);
[[nodiscard]] Json to_json(const std::vector<GridSearchGroup>& groups);

}  // namespace kith::cli
