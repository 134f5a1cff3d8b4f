#pragma once

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace kith::detail {

using Json = nlohmann::ordered_json;

// A number, or null for what is missing or not finite.
[[nodiscard]] inline Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }
[[nodiscard]] inline Json number(std::optional<double> value) { return value ? number(*value) : Json(nullptr); }

// A table of the document: {"columns": [...], "rows": [[...]]}.
class JsonTable {
 public:
  explicit JsonTable(std::vector<std::string> columns) : columns_(std::move(columns)) {}
  void add(Json row) { rows_.push_back(std::move(row)); }
  [[nodiscard]] std::size_t num_rows() const { return rows_.size(); }
  [[nodiscard]] Json take() && { return Json{{"columns", columns_}, {"rows", std::move(rows_)}}; }

 private:
  std::vector<std::string> columns_;
  Json rows_ = Json::array();
};

}  // namespace kith::detail
