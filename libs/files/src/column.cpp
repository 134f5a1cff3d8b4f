#include "kith/files/column.hpp"

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

std::string_view to_string(ColumnKind kind) noexcept {
  switch (kind) {
    case ColumnKind::kIdentifier:
      return "identifier";
    case ColumnKind::kCount:
      return "count";
    case ColumnKind::kOrdinal:
      return "ordinal";
    case ColumnKind::kNumber:
      return "number";
    case ColumnKind::kUnspecified:
      break;
  }
  return "";
}

}  // namespace kith
