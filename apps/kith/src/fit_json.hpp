#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "kith/fit/accuracy.hpp"
#include "kith/fit/fit.hpp"
#include "kith/fit/grid_search.hpp"
#include "kith/present/json.hpp"

namespace kith::cli {

// Documents of schema kith.fit/1; "method" says which of them it is.

[[nodiscard]] Json to_json(const FitReport& report, const std::vector<Diagnostic>& notes);
[[nodiscard]] Json to_json(const AccuracyFit& fit);
[[nodiscard]] Json to_json(const std::vector<GridSearchGroup>& groups);

}  // namespace kith::cli
