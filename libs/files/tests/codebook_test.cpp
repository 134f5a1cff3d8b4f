#include "kith/files/codebook.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "kith/core/error.hpp"

namespace kith {
namespace {

TEST(Codebook, DescribesEveryColumnOfEveryTable) {
  const std::vector<TableDescription> tables{
      {.file = "teams.csv",
       .description = "one team per row",
       .columns = {{.name = "area_sr",
                    .type = ColumnType::kReal,
                    .description = "says \"area\"",
                    .unit = "sr",
                    .required = true},
                   {.name = "status", .type = ColumnType::kText, .description = "how it ended", .unit = ""}}},
      {.file = "empty.csv", .description = "", .columns = {}}};
  const auto document = nlohmann::json::parse(codebook(tables));
  EXPECT_EQ(document.at("schema"), "kith.codebook/1");
  ASSERT_EQ(document.at("tables").size(), 2u);
  const auto& columns = document.at("tables")[0].at("columns");
  EXPECT_EQ(columns[0], nlohmann::json::parse(R"({"name": "area_sr", "type": "real", "unit": "sr", "required": true,
                                                  "description": "says \"area\""})"));
  EXPECT_EQ(columns[1], nlohmann::json::parse(R"({"name": "status", "type": "text", "unit": "none", "required": false,
                                                  "description": "how it ended"})"));
  EXPECT_TRUE(document.at("tables")[1].at("columns").is_array());
  EXPECT_EQ(codebook(tables).back(), '\n');
}

TEST(Codebook, NamesTheKindOfAColumnOnlyWhereItIsSpecified) {
  const std::vector<TableDescription> tables{
      {.file = "t.csv", .columns = {{.name = "team", .kind = ColumnKind::kIdentifier}, {.name = "note"}}}};
  const auto columns = nlohmann::json::parse(codebook(tables)).at("tables")[0].at("columns");
  EXPECT_EQ(columns[0].at("kind"), "identifier");
  EXPECT_FALSE(columns[1].contains("kind"));
}

TEST(Codebook, IsReadAsItWasWritten) {
  const std::vector<TableDescription> tables{
      {.file = "t.csv",
       .description = "d",
       .columns = {{.name = "a", .type = ColumnType::kReal, .description = "x", .unit = "sr", .required = true},
                   {.name = "b", .unit = "none", .kind = ColumnKind::kOrdinal},
                   {.name = "c", .type = ColumnType::kInteger, .unit = "count", .kind = ColumnKind::kCount},
                   {.name = "d", .type = ColumnType::kBoolean, .unit = "none", .kind = ColumnKind::kNumber}}}};
  const auto read = read_codebook(codebook(tables, "run"), "codebook.json");
  ASSERT_EQ(read.size(), 1u);
  EXPECT_EQ(read[0].file, "t.csv");
  EXPECT_EQ(read[0].description, "d");
  EXPECT_EQ(read[0].columns, tables[0].columns);
}

TEST(Codebook, NeedsOnlyNames) {
  const auto read = read_codebook(R"({"tables": [{"file": "t.csv", "columns": [{"name": "a"}]}]})", "codebook.json");
  EXPECT_EQ(read.at(0).columns.at(0), Column{.name = "a"});
}

TEST(Codebook, SaysWhatIsWrong) {
  for (const auto* text : {"", "[]", "{\"tables\": 1}", "{\"tables\": [{\"file\": \"t.csv\"}]}",
                           R"({"tables": [{"file": "t.csv", "columns": [{"name": "a", "kind": "likert"}]}]})",
                           R"({"tables": [{"file": "t.csv", "columns": [{"name": 3}]}]})"}) {
    try {
      (void)read_codebook(text, "codebook.json");
      ADD_FAILURE() << text;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kInvalidInput);
      EXPECT_EQ(error.diagnostics().at(0).id, "E0514") << text;
      EXPECT_EQ(error.diagnostics().at(0).file, "codebook.json");
    }
  }
}

TEST(Codebook, NamesEveryType) {
  EXPECT_EQ(to_string(ColumnType::kText), "text");
  EXPECT_EQ(to_string(ColumnType::kInteger), "integer");
  EXPECT_EQ(to_string(ColumnType::kReal), "real");
  EXPECT_EQ(to_string(ColumnType::kBoolean), "boolean");
}

}  // namespace
}  // namespace kith
