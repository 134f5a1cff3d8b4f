#pragma once

#include <string>
#include <vector>

#include "console.hpp"
#include "kith/explain/json.hpp"
#include "kith/fit/fit.hpp"
#include "kith/fit/recovery.hpp"

namespace kith::cli {

// What `kith fit` found, as people read it, and as a document of schema kith.fit/1.

[[nodiscard]] std::string text_of(const FitReport& report, const std::vector<ParameterRecovery>& recovered,
                                  const Console& console);
[[nodiscard]] Json to_json(const FitReport& report, const std::vector<ParameterRecovery>& recovered,
                           const std::vector<Diagnostic>& notes);

}  // namespace kith::cli
