#pragma once

#include <set>
#include <span>
#include <stdexcept>
#include <string>

#include "kith/files/column.hpp"

namespace kith::detail {

// @throws std::invalid_argument in the name of `function` if there is no column, or names are empty or repeated.
inline void check_columns(std::span<const Column> columns, const std::string& function) {
  if (columns.empty()) throw std::invalid_argument(function + ": a table has at least one column");
  std::set<std::string> names;
  for (const Column& column : columns) {
    if (column.name.empty()) throw std::invalid_argument(function + ": a column needs a name");
    if (!names.insert(column.name).second) {
      throw std::invalid_argument(function + ": column \"" + column.name + "\" is there twice");
    }
  }
}

}  // namespace kith::detail
