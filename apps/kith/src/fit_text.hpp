#pragma once

#include <string>
#include <vector>

#include "console.hpp"
#include "kith/fit/accuracy.hpp"
#include "kith/fit/fit.hpp"
#include "kith/fit/grid_search.hpp"

namespace kith::cli {

// What `kith fit` found, as people read it.

[[nodiscard]] std::string text_of(const FitReport& report, const Console& console);
[[nodiscard]] std::string text_of(const AccuracyFit& fit, const Console& console);
[[nodiscard]] std::string text_of(const std::vector<GridSearchGroup>& groups, const Console& console);

}  // namespace kith::cli
