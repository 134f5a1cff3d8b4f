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

// Values whose squares leave the range of numbers are refused: nothing about their variances could be computed.
// @throws kith::Error (kInvalidInput, E0911) with file and row.
void check_sizes(const Dataset& data, const std::string& column);

// @throws as analyze_table() does.
[[nodiscard]] PreparedModel prepare_model(const Dataset& data, const ModelQuestion& question,
                                          const AnalysisOptions& options);

}  // namespace kith
