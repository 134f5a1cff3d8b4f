// Laws over random small tables: whatever is in them, an analysis says what can be said, with numbers that are numbers,
// or refuses with a diagnostic.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "findings.hpp"
#include "kith/analysis/exports.hpp"
#include "kith/random/distributions.hpp"

namespace kith {
namespace {

// A value of a column of one kind.
double value_of(std::size_t kind, double scale, RandomStream& random) {
  switch (kind) {
    case 0:
      return scale * standard_normal(random);
    case 1:
      return scale;  // constant
    case 2:
      return static_cast<double>(uniform_index(2, random));
    case 3:
      return static_cast<double>(uniform_index(7, random));
    case 4:
      return uniform_index(8, random) == 0 ? scale : 0.0;  // nearly constant
    case 5:
      return scale + scale * 1e-14 * standard_normal(random);  // less spread than rounding
    case 6:
      return scale * std::pow(10.0, 20.0 * standard_normal(random));  // from tiny to huge
    default:
      return 1.0 - 1e-3 * std::floor(3.0 * uniform01(random) * uniform01(random));  // near the ceiling
  }
}

struct RandomTable {
  std::string text;
  ModelQuestion question;
};

RandomTable random_table(RandomStream random) {
  constexpr std::array kScales{1.0, 1.0, 1e-8, 1e12, 1e99, 1e-99, 1e-150, 1e150, 1e300, 1e-300};
  constexpr std::array kFormulas{"y ~ a",           "y ~ a*b",           "y ~ a + b",
                                 "y ~ a + (1|who)", "y ~ a*b + (1|who)", "y ~ b + (1|who) + (1|b:who)"};
  constexpr std::array kResponses{"y", "exam_regret", "exam_share_right", "periods"};
  const auto rows = 2 + uniform_index(30, random);
  const auto levels_a = 1 + uniform_index(4, random), levels_b = 1 + uniform_index(3, random);
  const auto people = 1 + uniform_index(8, random);
  const auto kind = uniform_index(8, random);
  const double scale = kScales.at(uniform_index(kScales.size(), random)) * (uniform01(random) < 0.8 ? 1.0 : -1.0);
  const std::string response = kResponses.at(uniform_index(kResponses.size(), random));
  RandomTable table{"a,b,who," + response + "\n", {}};
  for (std::size_t i = 0; i < rows; ++i) {
    // One row per cell, or as it comes.
    const auto a = kind % 2 == 0 ? i % levels_a : uniform_index(levels_a, random);
    const auto b = kind % 2 == 0 ? i / levels_a % levels_b : uniform_index(levels_b, random);
    table.text += fmt::format("a{},b{},w{},{}\n", a, b, uniform_index(people, random), value_of(kind, scale, random));
  }
  std::string formula = kFormulas.at(uniform_index(kFormulas.size(), random));
  formula.replace(0, 1, response);
  constexpr std::array kKinds{ColumnKind::kUnspecified, ColumnKind::kUnspecified, ColumnKind::kCount,
                              ColumnKind::kOrdinal};
  table.question = {.formula = formula,
                    .response_kind = kKinds.at(uniform_index(kKinds.size(), random)),
                    .independent = uniform01(random) < 0.5};
  return table;
}

const double* number_in(const ResultTable& table, const std::vector<TableCell>& row, const std::string& column) {
  for (std::size_t c = 0; c < row.size(); ++c) {
    if (table.columns[c].name == column) return std::get_if<double>(&row[c]);
  }
  return nullptr;
}

void expect_sound(const Analysis& analysis, const std::string& about) {
  for (const auto& finding : analysis.findings) {
    auto words = finding.sentence + finding.results;
    for (const auto& warning : finding.warnings) words += warning;
    for (const auto* wrong : {"nan", "NaN", "inf ", "inf]", "inf,", "-inf", "internal error"})
      EXPECT_EQ(words.find(wrong), std::string::npos) << wrong << ": " << words << about;
    for (const auto& table : finding.tables) {
      for (const auto& row : table.rows) {
        ASSERT_EQ(row.size(), table.columns.size()) << about;
        for (std::size_t c = 0; c < row.size(); ++c) {
          const auto* const number = std::get_if<double>(&row[c]);
          if (number == nullptr) continue;
          EXPECT_TRUE(std::isfinite(*number)) << table.caption << '/' << table.columns[c].name << about;
          if (table.columns[c].kind != ResultKind::kP) continue;
          EXPECT_TRUE(*number >= 0.0 && *number <= 1.0) << table.caption << about;
        }
        const auto* const low = number_in(table, row, "lower limit");
        const auto* const high = number_in(table, row, "upper limit");
        if (low == nullptr || high == nullptr) continue;
        EXPECT_LE(*low, *high) << table.caption << about;
        // Limits of an intraclass correlation stand beside the variance, and those of sizes of effects beside p.
        for (const auto* name : {"mean", "difference", "ratio", "odds ratio", "estimate", "share",
                                 "partial eta squared", "intraclass correlation", "variance ratio"}) {
          const auto* const estimate = number_in(table, row, name);
          if (estimate == nullptr || (std::string{name} == "ratio" && number_in(table, row, "estimate"))) continue;
          const double rounding = 1e-9 * (std::abs(*low) + std::abs(*high));
          EXPECT_LE(*low - rounding, *estimate) << table.caption << ' ' << name << about;
          EXPECT_GE(*high + rounding, *estimate) << table.caption << ' ' << name << about;
        }
      }
    }
  }
}

TEST(AnalyzeTable, OfAnySmallTableSaysSoundNumbersOrRefuses) {
  AnalysisOptions options;
  options.permutations = 19;
  std::size_t analysed = 0, refused = 0;
  for (std::uint64_t i = 0; i < 300; ++i) {
    const auto table = random_table(RandomStream{36}.split(i));
    const auto about = fmt::format("\ntable {}: {}\n{}", i, table.question.formula, table.text);
    try {
      const auto analysis = analyze_table(Dataset::parse(table.text, "t.csv"), table.question, options);
      expect_sound(analysis, about);
      (void)findings_json(analysis);
      (void)csv_tables(analysis);
      ++analysed;
    } catch (const Error& error) {
      ASSERT_FALSE(error.diagnostics().empty()) << error.what() << about;
      EXPECT_FALSE(error.diagnostics().front().hint.empty()) << error.what() << about;
      ++refused;
    } catch (const std::exception& error) {
      ADD_FAILURE() << "an internal error: " << error.what() << about;
    }
    if (HasFailure()) return;
  }
  EXPECT_GT(analysed, 100u);
  EXPECT_GT(refused, 30u);
}

TEST(AnalyzeTable, RefusesValuesWhoseVarianceLeavesTheRangeOfNumbers) {
  const std::vector<std::pair<std::string, std::size_t>> tables{{"g,y\na,1e200\na,2e200\nb,3e200\nb,5e200\n", 5},
                                                                {"g,y\na,0\na,2e-200\nb,0\nb,1e-201\n", 3}};
  for (const auto& [text, line] : tables) {
    try {
      (void)analyze_table(Dataset::parse(text, "t.csv"), {"y ~ g"}, testing::quick());
      ADD_FAILURE() << text;
    } catch (const Error& error) {
      const auto& first = error.diagnostics().front();
      EXPECT_EQ(first.id, "E0911");
      EXPECT_EQ(first.line, line);
      EXPECT_NE(first.hint.find("divide the column by"), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace kith
