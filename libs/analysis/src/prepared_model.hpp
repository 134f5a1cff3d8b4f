#pragma once

#include <string>
#include <vector>

#include "kith/analysis/analysis.hpp"
#include "model.hpp"

namespace kith {

// What a question asks of a table: the rows and the model that answer it.
struct PreparedModel {
  Dataset rows;  // complete, with the kinds of their columns
  ModelData model{};
  std::vector<std::vector<std::string>> intercepts{};  // the columns of every random intercept, as model.groups
  std::vector<std::string> notes{};                    // on the rows
  std::vector<std::string> warnings{};                 // on the finding
};

// @throws as analyze_table() does.
[[nodiscard]] PreparedModel prepare_model(const Dataset& data, const ModelQuestion& question,
                                          const AnalysisOptions& options);

}  // namespace kith
