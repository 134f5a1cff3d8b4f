#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "kith/random/distributions.hpp"
#include "kith/stats/resampling.hpp"
#include "reference.hpp"

namespace kith {
namespace {

using testing::kRounding;
using testing::read_factors;
using testing::relative_error;

double largest_size(const std::vector<double>& values) {
  double largest = 0.0;
  for (const double value : values) largest = std::max(largest, std::abs(value));
  return largest;
}

// The script computes the transform from its definition, ranks by R's rank, tests by lm and drop1 (type III).
TEST(AlignedRanks, AgreeWithTheDefinitionInR) {
  const auto reference = testing::read_reference("models.json");
  for (const auto& one : reference.at("aligned")) {
    SCOPED_TRACE(one.at("name").get<std::string>());
    const auto response = one.at("response").get<std::vector<double>>();
    const auto factors = read_factors(one.at("factors"));
    const auto table = aligned_rank_anova(response, factors);
    ASSERT_EQ(table.terms.size(), one.at("terms").size());
    for (std::size_t t = 0; t < table.terms.size(); ++t) {
      const auto& term = table.terms[t];
      const auto& expected = one.at("terms")[t];
      EXPECT_EQ(term.name, expected.at("name"));
      EXPECT_EQ(term.df, expected.at("df"));
      EXPECT_LE(relative_error(term.sum_of_squares, expected.at("sum_of_squares")), kRounding);
      ASSERT_TRUE(term.test) << term.test.reason();
      EXPECT_LE(relative_error(term.test->statistic, expected.at("f")), kRounding);
      EXPECT_LE(relative_error(term.test->p, expected.at("p")), kRounding);
    }
  }
}

std::vector<std::vector<std::size_t>> all_terms(std::size_t num_factors) {
  std::vector<std::vector<std::size_t>> terms;
  for (std::size_t mask = 1; mask < (std::size_t{1} << num_factors); ++mask) {
    terms.emplace_back();
    for (std::size_t f = 0; f < num_factors; ++f) {
      if ((mask >> f & 1U) != 0) terms.back().push_back(f);
    }
  }
  return terms;
}

TEST(AlignedRanks, AlignAsTheDefinitionInR) {
  const auto reference = testing::read_reference("models.json");
  for (const auto& one : reference.at("aligned")) {
    const auto response = one.at("response").get<std::vector<double>>();
    const auto factors = read_factors(one.at("factors"));
    for (const auto& expected : one.at("terms")) {
      for (const auto& term : all_terms(factors.size())) {
        std::string name;
        for (const auto f : term) name += (name.empty() ? "" : ":") + factors[f].name;
        if (name != expected.at("name")) continue;
        const auto aligned = aligned_response(response, factors, term);
        ASSERT_TRUE(aligned);
        for (std::size_t i = 0; i < response.size(); ++i)
          EXPECT_NEAR((*aligned)[i], expected.at("aligned")[i], 1e-11 * largest_size(response));
      }
    }
  }
}

// A response aligned for a term has no other effect, and of its own the F that the response has: the alignment law,
// in designs that need not be balanced.
TEST(AlignedRanks, AlignmentLeavesTheTermAloneAndNothingElse) {
  auto random = RandomStream{1}.split("alignment");
  const std::vector<std::size_t> num_levels{2, 3, 2, 2};
  for (std::size_t num_factors = 1; num_factors <= 4; ++num_factors) {
    std::vector<Factor> factors;
    std::size_t cells = 1;
    for (std::size_t f = 0; f < num_factors; ++f) {
      factors.push_back({std::string(1, static_cast<char>('a' + f)), {"1", "2", "3"}, {}});
      factors.back().levels.resize(num_levels[f]);
      cells *= num_levels[f];
    }
    std::vector<double> response;
    for (std::size_t cell = 0; cell < cells; ++cell) {
      const auto observations = 2 + uniform_index(3, random);
      const double mean = 5.0 * standard_normal(random);
      for (std::size_t i = 0; i < observations; ++i) {
        response.push_back(mean + standard_normal(random));
        auto rest = cell;
        for (auto& factor : factors) {
          factor.codes.push_back(rest % factor.levels.size());
          rest /= factor.levels.size();
        }
      }
    }
    const auto terms = all_terms(num_factors);
    const auto original = anova(response, factors, terms, SumsOfSquares::kTypeIII);
    for (std::size_t t = 0; t < terms.size(); ++t) {
      const auto table = anova(*aligned_response(response, factors, terms[t]), factors, terms, SumsOfSquares::kTypeIII);
      for (std::size_t other = 0; other < terms.size(); ++other) {
        const double f = table.terms[other].test->statistic;
        if (other == t) {
          EXPECT_LE(relative_error(f, original.terms[t].test->statistic), 1e-9);
        } else {
          EXPECT_LE(f, 1e-20);
        }
      }
    }
  }
}

TEST(AlignedRanks, AlignAsPublishedInABalancedDesign) {
  // Means 1 2 / 3 8, so rows 1.5 and 5.5, columns 2 and 5, all 3.5.
  const std::vector<Factor> factors{{"a", {"1", "2"}, {0, 0, 0, 0, 1, 1, 1, 1}},
                                    {"b", {"1", "2"}, {0, 0, 1, 1, 0, 0, 1, 1}}};
  const std::vector<double> response{0, 2, 1, 3, 2, 4, 6, 10};
  const auto expect = [&](std::vector<std::size_t> term, const std::vector<double>& expected) {
    const auto aligned = aligned_response(response, factors, std::move(term));
    ASSERT_TRUE(aligned);
    for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR((*aligned)[i], expected[i], 1e-12);
  };
  expect({0}, {-3, -1, -3, -1, 1, 3, 0, 4});
  expect({1}, {-2.5, -0.5, 0.5, 2.5, -2.5, -0.5, -0.5, 3.5});
  expect({1, 0}, {0, 2, -2, 0, -2, 0, -1, 3});
}

TEST(AlignedRanks, OfOneFactorAreThoseOfTheResponse) {
  const Factor factor{"f", {"a", "b", "c"}, {0, 1, 2, 0, 1, 2, 0, 1}};
  const std::vector<double> response{1, 5, 5, 2, 80, 3, 1, 0.1};
  const auto ranks = mid_ranks(response);
  const auto expected = anova(ranks, std::vector{factor}, all_terms(1), SumsOfSquares::kTypeIII);
  const auto table = aligned_rank_anova(response, std::vector{factor});
  EXPECT_NEAR(table.terms[0].test->statistic, expected.terms[0].test->statistic, 1e-12);
}

TEST(AlignedRanks, TieWhatDiffersByRoundingOnly) {
  // Thirds and tenths: aligned values of equal observations in different cells are equal up to their last digits.
  const Factor factor{"f", {"a", "b"}, {0, 0, 0, 1, 1, 1}};
  const Factor other{"g", {"a"}, {0, 0, 0, 0, 0, 0}};
  const std::vector<double> response{0.1, 0.2, 0.4, 10.1, 10.2, 10.4};
  const auto aligned = aligned_response(response, std::vector{other}, {0});
  ASSERT_TRUE(aligned);
  const auto within = aligned_response(response, std::vector{factor, other}, {1});
  ASSERT_TRUE(within);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ((*within)[i], (*within)[i + 3]);
}

TEST(AlignedRanks, CountNoLevelThatNobodyHas) {
  const Factor used{"f", {"a", "b"}, {0, 0, 0, 1, 1, 1}};
  const Factor unused{"f", {"a", "none", "b"}, {0, 0, 0, 2, 2, 2}};
  const std::vector<double> response{1, 4, 2, 3, 6, 7};
  EXPECT_EQ(aligned_rank_anova(response, std::vector{used}).terms[0].test->statistic,
            aligned_rank_anova(response, std::vector{unused}).terms[0].test->statistic);
}

TEST(AlignedRanks, SayWhyATermCannotBeTested) {
  const std::vector<Factor> factors{{"a", {"1", "2"}, {0, 0, 0, 1, 1}}, {"b", {"1", "2"}, {0, 0, 1, 1, 1}}};
  const std::vector<double> response{1, 2, 3, 4, 5};
  const std::string reason = "a combination of levels has no observations, so that nothing can be aligned";
  const auto table = aligned_rank_anova(response, factors);
  ASSERT_EQ(table.terms.size(), 3U);
  for (const auto& term : table.terms) {
    EXPECT_EQ(term.test.reason(), reason);
    EXPECT_EQ(term.partial_eta_squared.reason(), reason);
  }
  EXPECT_EQ(aligned_response(response, factors, {0}).reason(), reason);
  const auto equal =
      aligned_rank_anova(std::vector<double>{3, 3, 3, 3}, std::vector{Factor{"a", {"1", "2"}, {0, 0, 1, 1}}});
  EXPECT_EQ(equal.terms[0].test.reason(), "no spread of the ranks within the cells");
  const auto alone = aligned_rank_anova(std::vector<double>{3, 4}, std::vector{Factor{"a", {"1", "2"}, {0, 1}}});
  EXPECT_FALSE(alone.terms[0].test);
  EXPECT_FALSE(aligned_rank_anova({}, std::vector{Factor{"a", {"1", "2"}, {}}}).terms[0].test);
}

TEST(AlignedRanks, NameWhatTheyCannotTake) {
  const std::vector<double> response{1, 2};
  const Factor factor{"f", {"a", "b"}, {0, 1}};
  EXPECT_THROW((void)aligned_rank_anova(response, {}), std::invalid_argument);
  EXPECT_THROW((void)aligned_rank_anova(response, std::vector<Factor>(5, factor)), std::invalid_argument);
  EXPECT_THROW((void)aligned_rank_anova(std::vector<double>{1}, std::vector{factor}), std::invalid_argument);
  EXPECT_THROW((void)aligned_rank_anova(std::vector<double>{1, std::nan("")}, std::vector{factor}),
               std::invalid_argument);
  EXPECT_THROW((void)aligned_response(response, std::vector{factor}, {}), std::invalid_argument);
  EXPECT_THROW((void)aligned_response(response, std::vector{factor}, {1}), std::invalid_argument);
}

}  // namespace
}  // namespace kith
