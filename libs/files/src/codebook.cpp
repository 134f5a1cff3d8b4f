#include "kith/files/codebook.hpp"

#include <array>
#include <nlohmann/json.hpp>

#include "kith/core/error.hpp"
#include "kith/core/text.hpp"

namespace kith {
namespace {

[[noreturn]] void refuse_codebook(const std::string& file, const std::string& message, const std::string& hint) {
  throw Error{{Diagnostic{.id = "E0514", .message = message, .file = file, .line = 1, .column = 1, .hint = hint}}};
}

template <typename Value, std::size_t n>
Value value_named(const std::string& name, const std::array<Value, n>& values, const std::string& file,
                  const std::string& key) {
  const auto word = [](Value value) { return to_string(value); };
  for (const auto value : values) {
    if (word(value) == name) return value;
  }
  refuse_codebook(file, "unknown " + key + " '" + name + "' of a column",
                  "a " + key + " is one of " + joined(values, ", ", word));
}

Column column_of(const nlohmann::json& entry, const std::string& file) {
  constexpr std::array kTypes{ColumnType::kText, ColumnType::kInteger, ColumnType::kReal, ColumnType::kBoolean};
  constexpr std::array kKinds{ColumnKind::kIdentifier, ColumnKind::kCount, ColumnKind::kOrdinal, ColumnKind::kNumber};
  Column column{.name = entry.at("name").get<std::string>()};
  if (entry.contains("type")) column.type = value_named(entry.at("type").get<std::string>(), kTypes, file, "type");
  if (entry.contains("unit") && !entry.at("unit").is_null()) column.unit = entry.at("unit").get<std::string>();
  column.required = entry.value("required", false);
  column.description = entry.value("description", "");
  if (entry.contains("kind")) column.kind = value_named(entry.at("kind").get<std::string>(), kKinds, file, "kind");
  return column;
}

// What is not measured is counted or has no unit; of numbers with a fraction nobody can know.
nlohmann::ordered_json unit_of(const Column& column) {
  if (!column.unit.empty()) return column.unit;
  if (column.type == ColumnType::kReal) return nullptr;
  return column.kind == ColumnKind::kCount ? "count" : "none";
}

}  // namespace

std::vector<TableDescription> read_codebook(std::string_view text, const std::string& file) {
  try {
    const auto document = nlohmann::json::parse(text);
    std::vector<TableDescription> tables;
    for (const auto& entry : document.at("tables")) {
      TableDescription table{.file = entry.at("file").get<std::string>(),
                             .description = entry.value("description", "")};
      for (const auto& column : entry.at("columns")) table.columns.push_back(column_of(column, file));
      tables.push_back(std::move(table));
    }
    return tables;
  } catch (const nlohmann::json::exception& error) {
    refuse_codebook(file, std::string{"not a codebook: "} + error.what(),
                    R"(write {"tables": [{"file": "people.csv", "columns": [{"name": "trust", "kind": "ordinal"}]}]})");
  }
}

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
                         {"unit", unit_of(column)},
                         {"required", column.required},
                         {"description", column.description}});
      if (column.kind != ColumnKind::kUnspecified) columns.back()["kind"] = to_string(column.kind);
    }
    document["tables"].push_back(
        {{"file", table.file}, {"description", table.description}, {"columns", std::move(columns)}});
  }
  return document.dump(2) + '\n';
}

}  // namespace kith
