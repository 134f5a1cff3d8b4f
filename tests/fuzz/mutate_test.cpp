#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "kith/files/csv_reader.hpp"
#include "kith/files/csv_writer.hpp"
#include "kith/files/document.hpp"
#include "mutate/csv_edit.hpp"
#include "mutate/mutate.hpp"
#include "mutate/structure.hpp"

namespace kith::fuzzing {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::UnorderedElementsAre;

constexpr const char* kToml = R"(a = 1 # one
list = [1, "x", { b = 2.5 }]
[table]
c.d = true
[[row]]
text = """
two
lines"""
)";
constexpr const char* kCsv = "name,count,real\n\"a,b\",1,0.5\nc,2,\n\"d\"\"e\",3,1e9\n";
constexpr const char* kJson = R"({"a": [1, 2.5, "x", null], "b": {"c": true, "d": {}}, "e": "]"})";

template <typename Ranges>
std::vector<std::string> texts_of(const Ranges& ranges, std::string_view text) {
  std::vector<std::string> texts;
  for (const auto& range : ranges) texts.emplace_back(range.of(text));
  return texts;
}

std::vector<std::string> values_of(const Structure& structure, std::string_view text, ValueKind kind) {
  std::vector<std::string> texts;
  for (const auto& value : structure.values) {
    if (value.kind == kind) texts.emplace_back(value.range.of(text));
  }
  return texts;
}

using Mutation = std::string (*)(std::string_view, const Vocabulary&, Dice&);

// Of a thousand mutations of the text, each of one change, how many are still of its format.
template <typename IsWellFormed>
std::size_t well_formed_of_1000(std::string_view text, Mutation mutate, const IsWellFormed& is_well_formed) {
  const Vocabulary vocabulary{"toml"};
  std::size_t count = 0;
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    Dice dice{seed};
    count += is_well_formed(mutate(text, vocabulary, dice)) ? 1U : 0U;
  }
  return count;
}

bool is_toml(const std::string& text) { return parse_toml(text, "file").document.has_value(); }
bool is_json(const std::string& text) { return nlohmann::json::accept(text); }
bool is_csv(const std::string& text) {
  const std::vector<Column> columns{{.name = "name", .type = ColumnType::kText}};
  return read_csv(
             text, "file", columns, [](const CsvRow&) {}, OtherColumns::kIgnore)
      .empty();
}

TEST(Structure, OfTomlKnowsNamesValuesAndTables) {
  const auto structure = structure_of_toml(kToml);
  EXPECT_THAT(texts_of(structure.names, kToml), ElementsAre("a", "list", "b", "table", "c", "d", "row", "text"));
  EXPECT_THAT(values_of(structure, kToml, ValueKind::kText), ElementsAre("\"x\"", "\"\"\"\ntwo\nlines\"\"\""));
  EXPECT_THAT(values_of(structure, kToml, ValueKind::kReal), ElementsAre("2.5"));
  EXPECT_THAT(values_of(structure, kToml, ValueKind::kInteger), ElementsAre("1", "1"));
  EXPECT_THAT(values_of(structure, kToml, ValueKind::kBoolean), ElementsAre("true"));
  EXPECT_THAT(texts_of(structure.lists.back().items, kToml), testing::SizeIs(3)) << "what is in front, and two tables";
}

TEST(Structure, OfCsvKnowsCellsBetweenQuotes) {
  const auto structure = structure_of_csv(kCsv);
  EXPECT_THAT(texts_of(structure.names, kCsv), ElementsAre("name", "count", "real"));
  EXPECT_THAT(values_of(structure, kCsv, ValueKind::kText), Contains("\"a,b\""));
  EXPECT_THAT(values_of(structure, kCsv, ValueKind::kInteger), UnorderedElementsAre("1", "2", "3"));
}

TEST(Structure, LiesWithinAnyText) {
  Dice dice{1};
  for (int i = 0; i < 2000; ++i) {
    std::string text{kToml};
    for (int j = 0; j < 20; ++j) text = mutate_bytes(text, dice);
    for (const auto structure_of : {structure_of_toml, structure_of_json, structure_of_csv, structure_of_lines}) {
      const auto structure = structure_of(text);
      for (const auto& value : structure.values) ASSERT_LE(value.range.end, text.size());
      for (const auto& list : structure.lists) {
        for (std::size_t k = 0; k < list.items.size(); ++k) {
          ASSERT_LE(list.items[k].begin, list.items[k].end);
          ASSERT_TRUE(k == 0 || list.items[k - 1].end <= list.items[k].begin) << text;
        }
      }
    }
  }
}

TEST(Mutation, FollowsFromTheSeed) {
  const Vocabulary vocabulary{"toml"};
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    Dice a{seed};
    Dice b{seed};
    EXPECT_EQ(mutate_toml(kToml, vocabulary, a), mutate_toml(kToml, vocabulary, b));
    EXPECT_EQ(mutate_bytes(kToml, a), mutate_bytes(kToml, b));
    EXPECT_EQ(cross_toml(kToml, "x = 1\n", a), cross_toml(kToml, "x = 1\n", b));
  }
}

TEST(Mutation, LeavesMostTextsWellFormed) {
  EXPECT_GE(well_formed_of_1000(kToml, mutate_toml, is_toml), 800U);
  EXPECT_GE(well_formed_of_1000(kJson, mutate_json, is_json), 800U);
  EXPECT_GE(well_formed_of_1000(kCsv, mutate_csv, is_csv), 600U);
}

TEST(Mutation, ChangesSomething) {
  const Vocabulary vocabulary{"toml"};
  for (const auto mutate : {mutate_toml, mutate_json, mutate_csv, mutate_lines}) {
    std::size_t changed = 0;
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
      Dice dice{seed};
      changed += mutate(kToml, vocabulary, dice) != kToml ? 1U : 0U;
    }
    EXPECT_GE(changed, 190U);
  }
}

TEST(Mutation, TakesAnyTextAndNone) {
  const Vocabulary vocabulary;
  Dice dice{1};
  for (const std::string text : {"", "=", "[", "\"", "{", "a=[{", ",,\n\"", "\n\n", "a b"}) {
    for (int i = 0; i < 200; ++i) {
      for (const auto mutate : {mutate_toml, mutate_json, mutate_csv, mutate_lines}) {
        static_cast<void>(mutate(text, vocabulary, dice));
      }
      static_cast<void>(mutate_bytes(text, dice));
      static_cast<void>(mutate_vectors(text, 1, 3, dice));
      static_cast<void>(cross_toml(text, kToml, dice));
      static_cast<void>(cross_csv(text, kCsv, dice));
    }
  }
}

TEST(Crossing, PutsATableOfOneTextIntoAnother) {
  std::size_t taken = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Dice dice{seed};
    const auto text = cross_toml(kToml, "[other]\nx = 7\n", dice);
    taken += text.find("x = 7") != std::string::npos && is_toml(text) ? 1U : 0U;
  }
  EXPECT_GE(taken, 20U);
}

TEST(Columns, AreExchangedInEveryRow) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Dice dice{seed};
    const auto text = edit_columns(kCsv, Vocabulary{}, dice);
    const auto lines = lines_of_csv(text);
    ASSERT_FALSE(lines.empty());
    for (const auto& line : lines) EXPECT_EQ(line.cells.size(), lines.front().cells.size()) << text;
  }
}

}  // namespace
}  // namespace kith::fuzzing
