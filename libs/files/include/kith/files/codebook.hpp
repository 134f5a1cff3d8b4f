#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kith/files/column.hpp"

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
///     "columns": [{"name", "type", "unit" (null if none), "required", "description", "kind" (where specified)}]}]}
/// @param run  what tells the run that the tables are of.
[[nodiscard]] std::string codebook(std::span<const TableDescription> tables, const std::string& run = {});

/// Reads such a document. Fields that are missing have their defaults, others are ignored: a codebook that people write
/// needs only "tables", "file", "columns" and "name".
/// @param file  how errors name the document.
/// @throws kith::Error (kInvalidInput, E0514) if it is no codebook, or a type or kind is unknown.
[[nodiscard]] std::vector<TableDescription> read_codebook(std::string_view text, const std::string& file);

}  // namespace kith
