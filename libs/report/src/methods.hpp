#pragma once

#include "kith/analysis/finding.hpp"
#include "run_data.hpp"

namespace kith::detail {

// A paragraph for a paper that says how the run was made and evaluated, and the references that it cites:
// {"paragraph", "references": [{"key", "text", "bibtex"}]}. Every number comes from the resolved study and the
// manifest.
[[nodiscard]] Json methods_of(const RunFiles& run, const ReportDesign& design, const RunData& data,
                              const Analysis& analysis);

}  // namespace kith::detail
