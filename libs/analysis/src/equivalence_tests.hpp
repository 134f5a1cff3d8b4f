#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "kith/stats/marginal_means.hpp"
#include "model.hpp"

namespace kith {

// A comparison on the scale of the model.
struct Comparison {
  LinearEstimate estimate;
  std::string group;  // the level of the `by` factor; may be empty
};

// Tests comparisons against the smallest difference that matters (options.smallest_effect); does nothing if there is
// none, or if the model compares by ratios.
class EquivalenceTests {
 public:
  EquivalenceTests(const FixedEffects& model, const AnalysisOptions& options);
  [[nodiscard]] explicit operator bool() const { return margin_ > 0.0; }
  void add(const std::vector<Comparison>& comparisons);
  // Adds the table and a sentence about `what` was tested; nothing if nothing could be.
  void finish(const std::string& what, Finding& finding, std::vector<ResultTable>& tables);

 private:
  const AnalysisOptions& options_;
  double margin_ = 0.0;
  std::vector<std::vector<TableCell>> rows_;
  std::size_t equivalent_ = 0, others_ = 0;
};

}  // namespace kith
