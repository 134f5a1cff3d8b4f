#include "kith/table/codebook.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

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
  EXPECT_EQ(columns[1], nlohmann::json::parse(R"({"name": "status", "type": "text", "unit": null, "required": false,
                                                  "description": "how it ended"})"));
  EXPECT_TRUE(document.at("tables")[1].at("columns").is_array());
  EXPECT_EQ(codebook(tables).back(), '\n');
}

TEST(Codebook, NamesEveryType) {
  EXPECT_EQ(to_string(ColumnType::kText), "text");
  EXPECT_EQ(to_string(ColumnType::kInteger), "integer");
  EXPECT_EQ(to_string(ColumnType::kReal), "real");
  EXPECT_EQ(to_string(ColumnType::kBoolean), "boolean");
}

}  // namespace
}  // namespace kith
