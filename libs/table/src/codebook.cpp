#include "kith/table/codebook.hpp"

#include <nlohmann/json.hpp>

namespace kith {

std::string codebook(std::span<const TableDescription> tables, const std::string& run) {
  using Json = nlohmann::ordered_json;
  Json document{{"schema", "kith.codebook/1"}};
  if (!run.empty()) document["run"] = run;
  document["tables"] = Json::array();
  for (const TableDescription& table : tables) {
    Json columns = Json::array();
    for (const Column& column : table.columns) {
      columns.push_back({{"name", column.name},
                         {"type", to_string(column.type)},
                         {"unit", column.unit.empty() ? Json{} : Json(column.unit)},
                         {"required", column.required},
                         {"description", column.description}});
    }
    document["tables"].push_back(
        {{"file", table.file}, {"description", table.description}, {"columns", std::move(columns)}});
  }
  return document.dump(2) + '\n';
}

}  // namespace kith
