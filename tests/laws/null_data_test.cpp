// The layout of every table that kith writes: by the codebook alone, an analysis knows which rows are of the same group
// and of the same person, without which it would find effects that do not exist.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "kith/analysis/table_model.hpp"
#include "kith/store/session_export.hpp"
#include "kith/study/study_file.hpp"
#include "kith/study/tables.hpp"

namespace kith {
namespace {

constexpr std::size_t kGroups = 10, kMembers = 3, kAnswers = 4;

// Whose row it is. People have the same numbers in every group.
struct Place {
  std::size_t group, member, answer;
};

// What a column that says so shows; empty of all others.
std::string cell_of(const std::string& column, const Place& at) {
  static const std::map<std::string, std::size_t Place::*, std::less<>> kNumbers{
      {"session", &Place::group}, {"group", &Place::group},   {"team", &Place::group},     {"replicate", &Place::group},
      {"seat", &Place::member},   {"member", &Place::member}, {"user_id", &Place::member}, {"period", &Place::answer},
      {"test", &Place::answer},   {"key", &Place::answer},    {"question", &Place::answer}};
  const auto found = kNumbers.find(column);
  return found == kNumbers.end() ? "" : "n" + std::to_string(at.*found->second + 1);
}

bool tells_people_apart(const TableDescription& table) {
  return std::ranges::any_of(table.columns, [](const Column& column) {
    return column.name == "seat" || column.name == "member" || column.name == "user_id";
  });
}
// Without people or answers of which there are several in a group nothing repeats.
bool has_answers(const TableDescription& table) {
  return std::ranges::any_of(table.columns, [](const Column& column) {
    return column.name == "period" || column.name == "question" || column.name == "user_id";
  });
}

// A table of this layout, and whose rows are of the same group and of the same person.
std::string null_table(const TableDescription& table, std::vector<std::size_t>& groups,
                       std::vector<std::size_t>& people) {
  std::string text;
  for (const auto& column : table.columns) text += column.name + ",";
  text += "y\n";
  for (std::size_t group = 0; group < kGroups; ++group) {
    for (std::size_t member = 0; member < (tells_people_apart(table) ? kMembers : 1); ++member) {
      for (std::size_t answer = 0; answer < (has_answers(table) ? kAnswers : 1); ++answer) {
        for (const auto& column : table.columns) text += cell_of(column.name, {group, member, answer}) + ",";
        text += std::to_string(answer) + "\n";
        groups.push_back(group);
        people.push_back(tells_people_apart(table) ? group * kMembers + member : group);
      }
    }
  }
  return text;
}

// Which rows are alike in these columns, "group:member".
std::vector<std::size_t> rows_alike(const Dataset& data, const std::string& identifier) {
  std::vector<std::string> keys(data.num_rows());
  for (std::size_t begin = 0; begin <= identifier.size();) {
    const auto end = std::min(identifier.find(':', begin), identifier.size());
    const auto& cells = data.cells(identifier.substr(begin, end - begin));
    for (std::size_t i = 0; i < keys.size(); ++i) keys[i] += cells[i].value_or("") + ":";
    begin = end + 1;
  }
  std::map<std::string, std::size_t> known;
  std::vector<std::size_t> codes;
  for (const auto& key : keys) codes.push_back(known.emplace(key, known.size()).first->second);
  return codes;
}

std::vector<TableDescription> all_tables() {
  auto reading = parse_study(R"(schema = "kith.study/1"
id = "null"
domain = "item-delivery"
seed = 1
[design]
strategies = ["common", "joint"]
compositions = ["NNN"]
[learner.N]
ability = { mean = 0.7, sd = 0.03 }
confirm_gain = { half_normal = 0.03 }
correct_gain = { half_normal = 0.05 }
[teacher]
hypotheses = "kinds"
[record]
exam = "period"
estimates = true
)",
                             "null.toml", {});
  EXPECT_TRUE(reading.study) << (reading.diagnostics.empty() ? "" : reading.diagnostics.front().message);
  std::vector<TableDescription> tables;
  if (reading.study) tables = study_tables(*reading.study);
  for (auto& table : export_tables({.with_discussions = true})) tables.push_back(std::move(table));
  return tables;
}

// What repeats in a table, groups and people, is a random intercept of a model of it.
TEST(NullData, HasIdentifiersOfGroupsAndPeople) {
  std::set<std::set<std::string>> known;
  for (const auto& table : all_tables()) {
    for (const auto& column : table.columns)
      EXPECT_TRUE(column.type != ColumnType::kReal || !column.unit.empty()) << table.file << ": " << column.name;
    std::set<std::string> layout;
    for (const auto& column : table.columns)
      if (!cell_of(column.name, {}).empty()) layout.insert(column.name);
    if (layout.empty() || !known.insert(layout).second) continue;

    std::vector<std::size_t> groups, people;
    auto data = Dataset::parse(null_table(table, groups, people), table.file);
    data.describe(table);
    std::set<std::vector<std::size_t>> found;
    for (const auto& identifier : identifiers_of(data, {})) found.insert(rows_alike(data, identifier));
    const auto repeats = [&](const std::vector<std::size_t>& codes) {
      return *std::max_element(codes.begin(), codes.end()) + 1 < codes.size();
    };
    if (repeats(groups)) {
      EXPECT_TRUE(found.contains(groups)) << table.file << ": groups";
    }
    if (repeats(people) && people != groups) {
      EXPECT_TRUE(found.contains(people)) << table.file << ": people";
    }
  }
}

}  // namespace
}  // namespace kith
