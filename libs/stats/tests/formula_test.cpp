#include "kith/stats/formula.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace kith {
namespace {

std::string canonical(const std::string& text) {
  const auto reading = parse_formula(text);
  EXPECT_TRUE(reading.errors.empty()) << text << ": " << reading.errors.front().message;
  return to_string(reading.formula);
}

TEST(Formula, ReadsResponseFactorsAndTerms) {
  const auto formula = parse_formula("knowledge ~ strategy*composition").formula;
  EXPECT_EQ(formula.response, "knowledge");
  EXPECT_THAT(formula.factors, ::testing::ElementsAre("strategy", "composition"));
  EXPECT_THAT(formula.terms, ::testing::ElementsAre(::testing::ElementsAre(0), ::testing::ElementsAre(1),
                                                    ::testing::ElementsAre(0, 1)));
}

TEST(Formula, OperatorsMeanWhatWilkinsonAndRogersSay) {
  EXPECT_EQ(canonical("y~a"), "y ~ a");
  EXPECT_EQ(canonical("y ~ a + b"), "y ~ a + b");
  EXPECT_EQ(canonical("y ~ a*b"), "y ~ a + b + a:b");
  EXPECT_EQ(canonical("y ~ a:b"), "y ~ a:b");
  EXPECT_EQ(canonical("y ~ a*b*c"), "y ~ a + b + c + a:b + a:c + b:c + a:b:c");
  EXPECT_EQ(canonical("y ~ (a + b):c"), "y ~ a:c + b:c");
  EXPECT_EQ(canonical("y ~ (a + b)*c"), "y ~ a + b + c + a:c + b:c");
  EXPECT_EQ(canonical("y ~ a*b:c"), "y ~ a + b:c + a:b:c");
  EXPECT_EQ(canonical("y ~ ((a))"), "y ~ a");
  EXPECT_EQ(canonical("y ~ 1"), "y ~ 1");
  EXPECT_EQ(canonical("y ~ 1 + a"), "y ~ a");
}

TEST(Formula, TermsAppearOnceAndMainEffectsFirst) {
  EXPECT_EQ(canonical("y ~ a:b + b + a + a + b:a + a:a"), "y ~ b + a + a:b");
}

TEST(Formula, NamesMayBeQuoted) {
  const auto formula = parse_formula("`time to learn` ~ `1` + team.size_2 + 2nd").formula;
  EXPECT_EQ(formula.response, "time to learn");
  EXPECT_THAT(formula.factors, ::testing::ElementsAre("1", "team.size_2", "2nd"));
  EXPECT_EQ(to_string(formula), "`time to learn` ~ `1` + team.size_2 + 2nd");
}

TEST(Formula, ReadsItsOwnText) {
  for (const std::string text : {"y ~ a*b + c", "`a b` ~ `c:d`*e", "y ~ 1", "y ~ a + (1|g/`h i`)", "y ~ b:a + a"}) {
    const auto once = canonical(text);
    EXPECT_EQ(canonical(once).size(), once.size());
  }
}

TEST(Formula, ReadsRandomIntercepts) {
  const auto formula = parse_formula("knowledge ~ strategy + (1|team/member) + (1 | item)").formula;
  EXPECT_THAT(formula.factors, ::testing::ElementsAre("strategy"));
  EXPECT_THAT(formula.terms, ::testing::ElementsAre(::testing::ElementsAre(0)));
  EXPECT_THAT(formula.random_intercepts,
              ::testing::ElementsAre(::testing::ElementsAre("team"), ::testing::ElementsAre("team", "member"),
                                     ::testing::ElementsAre("item")));
}

TEST(Formula, RandomInterceptsMeanWhatLme4Says) {
  EXPECT_EQ(canonical("y ~ (1|g)"), "y ~ 1 + (1|g)");
  EXPECT_EQ(canonical("y~a*b+(1|g)"), "y ~ a + b + a:b + (1|g)");
  EXPECT_EQ(canonical("y ~ (1|g) + a"), "y ~ a + (1|g)");
  EXPECT_EQ(canonical("y ~ a + (1|a:g)"), "y ~ a + (1|a:g)");
  EXPECT_EQ(canonical("y ~ a + (1|f/g/h)"), "y ~ a + (1|f) + (1|f:g) + (1|f:g:h)");
  EXPECT_EQ(canonical("y ~ a + (1|f/g:h)"), "y ~ a + (1|f) + (1|f:g:h)");
  EXPECT_EQ(canonical("y ~ a + (b + (1|g))"), "y ~ a + b + (1|g)");
  EXPECT_EQ(canonical("y ~ a + ((1|g))"), "y ~ a + (1|g)");
  EXPECT_EQ(canonical("y ~ a + (1|`team name`)"), "y ~ a + (1|`team name`)");
}

TEST(Formula, RandomInterceptsAppearOnce) {
  EXPECT_EQ(canonical("y ~ a + (1|g:h) + (1|g) + (1|g) + (1|h:g) + (1|g/h)"), "y ~ a + (1|g:h) + (1|g)");
}

void expect_error(const std::string& text, std::size_t column, const std::string& part) {
  const auto reading = parse_formula(text);
  ASSERT_EQ(reading.errors.size(), 1u) << text;
  EXPECT_EQ(reading.errors[0].column, column) << text << ": " << reading.errors[0].message;
  EXPECT_THAT(reading.errors[0].message, ::testing::HasSubstr(part)) << text;
  EXPECT_TRUE(reading.formula.terms.empty());
  EXPECT_TRUE(reading.formula.random_intercepts.empty());
}

TEST(Formula, ErrorsHaveTheirColumn) {
  expect_error("", 1, "response is missing");
  expect_error("y", 2, "'~' is missing");
  expect_error("y a", 3, "'~' is missing");
  expect_error("~ a", 1, "response is missing");
  expect_error("y ~", 4, "missing at the end");
  expect_error("y ~ a +", 8, "missing at the end");
  expect_error("y ~ a + * b", 9, "missing before '*'");
  expect_error("y ~ a b", 7, "operator is missing before 'b'");
  expect_error("y ~ (a + b", 5, "'(' without ')'");
  expect_error("y ~ a)", 6, "')' without '('");
  expect_error("y ~ (a b)", 8, "operator is missing before 'b'");
  expect_error("y ~ a - b", 7, "'-' has no meaning");
  expect_error("y ~ a^2", 6, "'^' has no meaning");
  expect_error("y ~ a ~ b", 7, "second '~'");
  expect_error("y ~ a + y", 9, "cannot be a factor");
  expect_error("y ~ 0 + a", 5, "'0' is not a factor");
  expect_error("y ~ `a", 5, "does not end");
  expect_error("y ~ ``", 5, "empty name");
}

TEST(Formula, ErrorsOfRandomInterceptsHaveTheirColumn) {
  expect_error("y ~ 1|g", 6, "'|' outside parentheses");
  expect_error("y ~ a + b|g", 10, "'|' outside parentheses");
  expect_error("y ~ (a|g)", 7, "only intercepts can be random");
  expect_error("y ~ (1 + a|g)", 11, "only intercepts can be random");
  expect_error("y ~ (0 + a|g)", 6, "'0' is not a factor");
  expect_error("y ~ (1||g)", 8, "name of a column is missing");
  expect_error("y ~ (1|)", 8, "name of a column is missing");
  expect_error("y ~ (1|g", 5, "'(' without ')'");
  expect_error("y ~ (1|g/)", 10, "name of a column is missing");
  expect_error("y ~ (1|g*h)", 9, "'*' in the groups");
  expect_error("y ~ (1|g h)", 10, "'h' in the groups");
  expect_error("y ~ (1|2)", 8, "name of a column is missing");
  expect_error("y ~ (1|y)", 8, "response 'y'");
  expect_error("y ~ a/b", 6, "'/' outside a random intercept");
  expect_error("y ~ (1|g)/b", 10, "'/' outside a random intercept");
  expect_error("y ~ a*(1|g)", 7, "cannot be part of a product");
  expect_error("y ~ (1|g):a", 5, "cannot be part of a product");
  expect_error("y ~ (a + (1|g))*b", 10, "cannot be part of a product");
  expect_error("y ~ a + (1|a)", 9, "both a term and a random intercept");
  expect_error("y ~ a*b + (1|b:a)", 11, "both a term and a random intercept");
}

TEST(Formula, ColumnsCountCharactersNotBytes) {
  expect_error(
      "gr\xC3\xB6\xC3\x9F"
      "e ~ a -",
      11, "'-'");
}

TEST(Formula, ErrorsHaveHints) {
  EXPECT_THAT(parse_formula("y ~ a - b").errors.at(0).hint, ::testing::HasSubstr("parentheses"));
  EXPECT_THAT(parse_formula("y ~ 0").errors.at(0).hint, ::testing::HasSubstr("mean"));
  EXPECT_THAT(parse_formula("y ~ 1|g").errors.at(0).hint, ::testing::HasSubstr("(1|team)"));
  EXPECT_THAT(parse_formula("y ~ a/b").errors.at(0).hint, ::testing::HasSubstr("a + a:b"));
}

TEST(Formula, SizeIsLimited) {
  std::string many = "y ~ a0";
  for (int i = 1; i < 30; ++i) many += "*a" + std::to_string(i);
  expect_error(many, 1, "more than 1000 terms");
  std::string random = "y ~ a";
  for (int i = 0; i < 11; ++i) random += "+(1|g" + std::to_string(i) + ")";
  expect_error(random, 77, "more than 10 random intercepts");
  expect_error("y ~ " + std::string(200, '(') + "a" + std::string(200, ')'), 105, "too many parentheses");
}

}  // namespace
}  // namespace kith
