// Data in which nothing has an effect, in the layout of every table that kith writes: an analysis that nobody told
// anything but the codebook finds an effect as often as its level says, and hardly more often.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "kith/analysis/analysis.hpp"
#include "kith/analysis/dataset.hpp"
#include "kith/random/distributions.hpp"
#include "kith/store/session_export.hpp"
#include "kith/study/study_file.hpp"
#include "kith/study/tables.hpp"

namespace kith {
namespace {

constexpr std::size_t kGroups = 10, kMembers = 3, kAnswers = 4;
// What may differ between rows that a user asks about: groups, people, answers.
constexpr std::array kFactors{"of_group", "of_person", "of_answer"};

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

// The table with a response y, in which groups and people differ, and a factor that decides nothing.
std::string null_table(const TableDescription& table, std::size_t factor, RandomStream random) {
  std::string text;
  for (const auto& column : table.columns) text += column.name + ",";
  text += "factor,y\n";
  std::size_t drawn = 0;  // each of the two occurs
  const auto a_or_b = [&] {
    const bool is_a = drawn < 2 ? drawn == 0 : uniform01(random) < 0.5;
    ++drawn;
    return is_a ? "a" : "b";
  };
  for (std::size_t group = 0; group < kGroups; ++group) {
    const double of_group = standard_normal(random);
    std::string level = group % 2 == 0 ? "a" : "b";
    for (std::size_t member = 0; member < (tells_people_apart(table) ? kMembers : 1); ++member) {
      const double of_person = 1.5 * standard_normal(random);
      if (factor == 1) level = a_or_b();
      for (std::size_t answer = 0; answer < (has_answers(table) ? kAnswers : 1); ++answer) {
        if (factor == 2) level = a_or_b();
        for (const auto& column : table.columns) text += cell_of(column.name, {group, member, answer}) + ",";
        text += level + "," + std::to_string(of_group + of_person + standard_normal(random)) + "\n";
      }
    }
  }
  return text;
}

bool is_significant(const TableDescription& table, std::size_t factor, RandomStream random) {
  auto data = Dataset::parse(null_table(table, factor, std::move(random)), table.file);
  data.describe(table);
  AnalysisOptions options;
  options.permutations = 19;
  const auto analysis = analyze_table(data, {.formula = "y ~ factor"}, options);
  const auto& tests = analysis.findings.front().tests;
  return !tests.empty() && tests.front().tests.front().p.value_or(1.0) < 0.05;
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

// In tables that differ in what tells their rows apart; others are analysed alike.
void expect_few_effects(std::size_t each, RandomStream random) {
  std::set<std::set<std::string>> known;
  for (const auto& table : all_tables()) {
    for (const auto& column : table.columns)
      EXPECT_TRUE(column.type != ColumnType::kReal || !column.unit.empty()) << table.file << ": " << column.name;
    std::set<std::string> layout;
    for (const auto& column : table.columns)
      if (!cell_of(column.name, {}).empty()) layout.insert(column.name);
    if (layout.empty() || !known.insert(layout).second) continue;
    std::size_t significant = 0, asked = 0;
    for (std::size_t factor = 0; factor < kFactors.size(); ++factor) {
      if (factor == 1 && !tells_people_apart(table)) continue;
      std::size_t of_factor = 0;
      for (std::size_t i = 0; i < each; ++i)
        of_factor += is_significant(table, factor, random.split(table.file).split(factor).split(i)) ? std::size_t{1}
                                                                                                    : std::size_t{0};
      // By chance more than a fifth of a few is rare, more than a tenth of many.
      EXPECT_LE(of_factor, each / (each < 100 ? 5 : 10)) << table.file << ": " << kFactors.at(factor);
      significant += of_factor;
      asked += each;
    }
    // Of 60 at 5 %, more than 10 are as rare as 1 in 10,000.
    EXPECT_LE(significant, asked / (each < 100 ? 6 : 10)) << table.file << ": " << significant << " of " << asked;
  }
}

TEST(NullData, HasFewEffectsInEveryTable) { expect_few_effects(20, RandomStream{1}); }
TEST(NullDataSlow, HasFewEffectsInEveryTable) { expect_few_effects(400, RandomStream{2}); }

}  // namespace
}  // namespace kith
