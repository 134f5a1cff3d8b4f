#include "kith/analysis/dataset.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "kith/core/error.hpp"

namespace kith {
namespace {

constexpr const char* kText =
    "team,strategy,score,done\n"
    "1,joint,0.5,true\n"
    "2,low,NA,false\n"
    "3,joint,,true\n"
    "4,low,2,true\n";

Diagnostic diagnostic_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    if (!error.diagnostics().empty()) return error.diagnostics().front();
  }
  return {};
}

TEST(Dataset, ReadsColumnsByName) {
  const auto data = Dataset::parse(kText, "people.csv");
  EXPECT_EQ(data.num_rows(), 4u);
  EXPECT_EQ(data.columns(), (std::vector<std::string>{"team", "strategy", "score", "done"}));
  EXPECT_EQ(data.factor("strategy").levels, (std::vector<std::string>{"joint", "low"}));
  EXPECT_EQ(data.line(3), 5u);
}

TEST(Dataset, TakesEmptyCellsAndNaAsMissing) {
  const auto data = Dataset::parse(kText, "people.csv");
  EXPECT_EQ(data.numbers("score"), (std::vector<std::optional<double>>{0.5, std::nullopt, std::nullopt, 2.0}));
  EXPECT_EQ(data.complete(std::vector<std::string>{"score"}).num_rows(), 2u);
}

TEST(Dataset, TakesTruthAsOneAndZero) {
  const auto data = Dataset::parse(kText, "people.csv");
  EXPECT_EQ(data.numbers("done"), (std::vector<std::optional<double>>{1.0, 0.0, 1.0, 1.0}));
}

TEST(Dataset, KeepsTheRowsThatPassEveryFilter) {
  const auto data = Dataset::parse(kText, "people.csv");
  const std::vector<RowFilter> filters{parse_row_filter("strategy=joint"), parse_row_filter("team!=3")};
  const auto part = data.where(filters);
  EXPECT_EQ(part.num_rows(), 1u);
  EXPECT_EQ(part.line(0), 2u);
}

TEST(Dataset, ListsTheValuesOfAColumnThatAFilterDoesNotMatch) {
  const auto data = Dataset::parse(kText, "people.csv");
  const auto fault_of = [&](std::initializer_list<const char*> conditions) {
    std::vector<RowFilter> filters;
    for (const auto* condition : conditions) filters.push_back(parse_row_filter(condition));
    return diagnostic_of([&] { (void)data.where(filters); });
  };
  const auto typo = fault_of({"team!=1", "strategy=jiont"});
  EXPECT_EQ(typo.id, "E0909");
  EXPECT_TRUE(typo.infeasible);
  EXPECT_EQ(typo.file, "people.csv");
  EXPECT_EQ(typo.message, "no row has strategy=jiont");
  EXPECT_EQ(typo.hint, "column 'strategy' has the values joint, low; did you mean 'joint'?");
  EXPECT_EQ(fault_of({"score=7"}).hint, "column 'score' has the values 0.5, 2, and empty cells");
  EXPECT_EQ(fault_of({"strategy=low", "team=1"}).message, "no row satisfies all conditions together");
  EXPECT_EQ(fault_of({"strategy=low"}).id, "");
  EXPECT_EQ(Dataset::parse("a\n", "t.csv").where(std::vector{parse_row_filter("a=1")}).num_rows(), 0u);
}

TEST(Dataset, ListsAFewOfManyValues) {
  std::string text = "a\n";
  for (int i = 0; i < 1'000; ++i) text += std::to_string(i) + "\n";
  const auto fault = diagnostic_of(
      [&] { (void)Dataset::parse(text, "t.csv").where(std::vector{parse_row_filter("a=none of these")}); });
  EXPECT_THAT(fault.hint, ::testing::EndsWith("18, 19 and others"));
}

TEST(Dataset, ReadsSemicolonsDecimalCommasAndTruthOfR) {
  const auto data = Dataset::parse("g;y;done\na;1,5;TRUE\nb;2;FALSE\n", "people.csv");
  EXPECT_EQ(data.numbers("y"), (std::vector<std::optional<double>>{1.5, 2.0}));
  EXPECT_EQ(data.numbers("done"), (std::vector<std::optional<double>>{1.0, 0.0}));
  EXPECT_EQ(data.where(std::vector{parse_row_filter("g=b")}).numbers("y").front(), 2.0);
  // Where commas separate the cells, they are no decimal points.
  EXPECT_EQ(diagnostic_of([] { (void)Dataset::parse("y\n\"1,5\"\n", "t.csv").numbers("y"); }).id, "E0902");
}

TEST(Dataset, FiltersAreColumnSignValue) {
  EXPECT_EQ(parse_row_filter("a!=b=c").value, "b=c");
  EXPECT_FALSE(parse_row_filter("a!=b").equal);
  EXPECT_TRUE(parse_row_filter("a=").equal);
  for (const auto* text : {"strategy", "=x", "!=x"}) EXPECT_THROW((void)parse_row_filter(text), Error) << text;
}

TEST(Dataset, NamesTheNearestColumnForAMissingOne) {
  const auto found = diagnostic_of([] { (void)Dataset::parse(kText, "people.csv").cells("stratgy"); });
  EXPECT_EQ(found.id, "E0901");
  EXPECT_EQ(found.hint, "did you mean 'strategy'?");
}

TEST(Dataset, NamesFileAndRowOfATextAmongNumbers) {
  const auto found = diagnostic_of([] { (void)Dataset::parse("score\n1\ntwo\n", "people.csv").numbers("score"); });
  EXPECT_EQ(found.id, "E0902");
  EXPECT_EQ(found.file, "people.csv");
  EXPECT_EQ(found.line, 3u);
}

TEST(Dataset, ComplainsOnceOfAColumnOfText) {
  try {
    (void)Dataset::parse(kText, "people.csv").numbers("strategy");
    FAIL();
  } catch (const Error& error) {
    ASSERT_EQ(error.diagnostics().size(), 1u);
    EXPECT_EQ(error.diagnostics()[0].message, "column 'strategy' holds text, such as 'joint', no numbers");
  }
}

TEST(Dataset, RefusesNumbersThatAreNotFinite) {
  for (const auto* cell : {"nan", "inf", "1e999", "1,5", "0x10"}) {
    const auto text = "score\n\"" + std::string{cell} + "\"\n";
    EXPECT_EQ(diagnostic_of([&] { (void)Dataset::parse(text, "people.csv").numbers("score"); }).id, "E0902") << cell;
  }
}

TEST(Dataset, NamesTheRowOfALevelThatIsMissing) {
  const auto found = diagnostic_of([] { (void)Dataset::parse("a,b\n1,x\n2,\n", "people.csv").factor("b"); });
  EXPECT_EQ(found.id, "E0903");
  EXPECT_EQ(found.line, 3u);
}

TEST(Dataset, NamesAFewOfManyColumnsAndTheBeginningOfLongNames) {
  std::string header(1'000, 'x');
  header.replace(39, 2, "\xC3\xA9");  // a letter of two bytes, which is not cut in two
  for (int i = 0; i < 1'000; ++i) header += ",column" + std::to_string(i);
  const auto data = Dataset::parse(header + "\n", "t.csv");
  try {
    static_cast<void>(data.cells("nothing of the kind"));
    ADD_FAILURE() << "there is no such column";
  } catch (const Error& error) {
    const auto hint = error.diagnostics().at(0).hint;
    EXPECT_LT(hint.size(), 500u);
    EXPECT_THAT(hint, ::testing::HasSubstr(std::string(39, 'x') + "..., column0, "));
    EXPECT_THAT(hint, ::testing::HasSubstr(" and 981 more"));
  }
}

TEST(Dataset, ThatDoesNotFitIntoMemoryIsNotKept) {
  std::string text = "a,b,c,d,e,f,g,h\n";
  for (int i = 0; i < 150'000; ++i) text += "1,1,1,1,1,1,1,1\n";
  setenv("KITH_MEMORY", "60M", 1);  // the text has 2.4 MB, its cells about 70
  try {
    static_cast<void>(Dataset::parse(text, "t.csv"));
    ADD_FAILURE() << "there was memory";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kInfeasible);
    EXPECT_EQ(error.diagnostics().at(0).id, "E1201");
  }
  unsetenv("KITH_MEMORY");
}

}  // namespace
}  // namespace kith
