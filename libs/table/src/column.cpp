#include "kith/table/column.hpp"

namespace kith {

std::string_view to_string(ColumnType type) noexcept {
  switch (type) {
    case ColumnType::kText:
      return "text";
    case ColumnType::kInteger:
      return "integer";
    case ColumnType::kReal:
      return "real";
    case ColumnType::kBoolean:
      return "boolean";
  }
  return "text";
}

}  // namespace kith
