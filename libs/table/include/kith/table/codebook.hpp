#pragma once

#include <span>
#include <string>
#include <vector>

#include "kith/table/column.hpp"

namespace kith {

/// A table of a codebook.
struct TableDescription {
  std::string file = {};         ///< Such as "teams.csv".
  std::string description = {};  ///< What one row is.
  std::vector<Column> columns = {};
};

/// The JSON document that describes every column of every table, indented, with
/// a newline at the end:
///   {"schema": "kith.codebook/1", "run": RUN (unless empty), "tables": [{"file", "description",
///     "columns": [{"name", "type", "unit" (null if none), "required", "description"}]}]}
/// @param run  what tells the run that the tables are of.
[[nodiscard]] std::string codebook(std::span<const TableDescription> tables, const std::string& run = {});

}  // namespace kith
