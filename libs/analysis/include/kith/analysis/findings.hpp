#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kith/analysis/effect.hpp"
#include "kith/core/diagnostic.hpp"
#include "kith/study/study_spec.hpp"

namespace kith {

/// A published test.
struct PublishedFinding {
  Effect effect;
  bool significant = false;
  double alpha = 0.05;
  std::optional<double> f, df1, df2;  ///< The published statistic, all three or none.
  std::string source;
};

struct FindingsReading {
  std::optional<std::vector<PublishedFinding>> findings;  ///< Unless there are errors.
  std::vector<Diagnostic> diagnostics;
};
/// Parses the findings of a targets file (schema kith.targets/1, see docs/power.md) and checks them against a study;
/// its targets and parameters are for `research/calibrate.py`. Never throws for bad content.
[[nodiscard]] FindingsReading parse_findings(std::string_view text, const std::string& name, const StudySpec& spec);

}  // namespace kith
