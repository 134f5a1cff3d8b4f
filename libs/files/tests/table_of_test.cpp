#include "kith/files/table_of.hpp"

#include <gtest/gtest.h>

namespace kith {
namespace {

struct Answer {
  std::size_t person = 1;
  std::string path = "left, right";
  std::optional<double> seconds{};
  bool right = true;
};

std::string csv(const TableOf<Answer>& table, const Answer& answer) {
  std::string text;
  CsvWriter writer{table.description().columns, [&](std::string_view piece) { text += piece; }};
  table.write(writer, answer);
  writer.flush();
  return text;
}

TEST(TableOf, GivesTheCodebookItsEntryAndTheRowItsCellFromOneLine) {
  TableOf<Answer> table{"answers.csv", "One answer."};
  table.column(&Answer::person, columns::identifier("person", "Who answered."));
  table.column(&Answer::path, {"path", "What was answered."});
  table.column(&Answer::seconds, {"rt", "How long it took.", "s"});
  table.column([](const Answer& answer) { return !answer.right; }, {"wrong", "Whether it is wrong."});
  const std::vector<Column> expected{
      {"person", ColumnType::kInteger, "Who answered.", "", true, ColumnKind::kIdentifier},
      {"path", ColumnType::kText, "What was answered.", "", true},
      {"rt", ColumnType::kReal, "How long it took.", "s", false},
      {"wrong", ColumnType::kBoolean, "Whether it is wrong.", "", true}};
  EXPECT_EQ(table.description().file, "answers.csv");
  EXPECT_EQ(table.description().columns, expected);
  EXPECT_EQ(csv(table, {}), "person,path,rt,wrong\n1,\"left, right\",,false\n");
  EXPECT_EQ(csv(table, {.seconds = 0.5}), "person,path,rt,wrong\n1,\"left, right\",0.5,false\n");
}

TEST(TableOf, PutsAColumnInFrontOfAnotherIfThatIsThere) {
  TableOf<Answer> table{"answers.csv", "One answer."};
  table.column(&Answer::right, {"right", "Whether it is right."});
  table.column(&Answer::person, {"person", "Who answered."}, {.required = false, .before = "right"});
  table.column(&Answer::path, {"path", "What was answered."}, {.before = "nothing"});
  EXPECT_EQ(csv(table, {}), "person,right,path\n1,true,\"left, right\"\n");
  EXPECT_FALSE(table.description().columns.front().required);
}

}  // namespace
}  // namespace kith
