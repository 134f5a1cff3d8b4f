// Error rates of analyses of tables; see error_rates.hpp.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "error_rates.hpp"
#include "kith/analysis/analysis.hpp"
#include "kith/random/distributions.hpp"
#include "kith/stats/equivalence.hpp"
#include "kith/stats/multiple.hpp"

namespace kith {
namespace {

using testing::binomial;
using testing::few_permutations;
using testing::kStudies;
using testing::p_of;
using testing::Rates;

Finding analyse(const std::string& table, const ModelQuestion& question,
                const AnalysisOptions& how = few_permutations()) {
  return analyze_table(Dataset::parse(table, "t.csv"), question, how).findings.front();
}

std::size_t poisson(double mean, RandomStream& random) {
  const double limit = std::exp(-mean);
  std::size_t n = 0;
  double product = uniform01(random);
  while (product > limit) {
    ++n;
    product *= uniform01(random);
  }
  return n;
}

// Negative binomial with theta 2: a Poisson mean that varies as the sum of two exponentials.
std::size_t negative_binomial(double mean, RandomStream& random) {
  const double rate = -0.5 * mean * (std::log1p(-uniform01(random)) + std::log1p(-uniform01(random)));
  return poisson(rate, random);
}

// A table of factors a (2 levels) and b (3 levels) with `sizes` rows per cell, whose response does not depend on them.
std::string crossed(const std::array<std::size_t, 6>& sizes, const std::function<std::string()>& response,
                    const std::string& columns = "y") {
  std::string text = "a,b," + columns + "\n";
  for (std::size_t cell = 0; cell < 6; ++cell) {
    for (std::size_t i = 0; i < sizes.at(cell); ++i)
      text += fmt::format("a{},b{},{}\n", cell / 3, cell % 3, response());
  }
  return text;
}

// Tests whose suites CTest labels `slow`.
TEST(FalsePositivesSlow, OfLinearModels) {
  Rates rates;
  for (std::size_t study = 0; study < kStudies; ++study) {
    auto random = RandomStream{101}.split(study);
    const auto normal = [&] { return fmt::format("{}", standard_normal(random)); };
    const auto two_way = analyse(crossed({8, 8, 8, 8, 8, 8}, normal), {"y ~ a*b"});
    for (const auto* term : {"a", "b", "a:b"}) {
      const std::string name = term;
      rates.add("Analysis of variance, type II: " + name, p_of(two_way, "Analysis of variance (type II)", name));
      rates.add("Permutation test: " + name, p_of(two_way, "Permutation", name, "p-value, permutation"));
      rates.add("Aligned ranks: " + name, p_of(two_way, "Permutation", name, "p-value, aligned ranks"));
    }
    rates.add("Tukey-Kramer, any of three pairs", p_of(two_way, "Pairs of b", "", "adjusted p-value"));
    rates.add("t test of a pair", p_of(two_way, "Pairs of a", ""));
    const auto unbalanced = analyse(crossed({4, 12, 6, 10, 5, 9}, normal), {"y ~ a*b"});
    for (const auto* term : {"a", "b", "a:b"}) {
      const std::string name = term;
      rates.add("Analysis of variance, type II, unbalanced: " + name,
                p_of(unbalanced, "Analysis of variance (type II)", name));
      rates.add("Analysis of variance, type III, unbalanced: " + name,
                p_of(unbalanced, "Analysis of variance (type III)", name));
    }
    rates.add("Tukey-Kramer, any of three pairs, unbalanced", p_of(unbalanced, "Pairs of b", "", "adjusted p-value"));
    auto of_shares = random.split("shares");
    const auto share = [&] { return std::string{uniform01(of_shares) < 0.4 ? "true" : "false"}; };
    const auto proportions = analyse(crossed({16, 16, 16, 16, 16, 16}, share), {"y ~ a*b"});
    for (const auto* term : {"a", "b", "a:b"})
      rates.add(std::string{"Analysis of variance of true or false: "} + term,
                p_of(proportions, "Analysis of variance (type II)", term));
    const auto one_way = analyse(crossed({5, 5, 5, 5, 5, 5}, normal), {"y ~ b"});
    rates.add("Kruskal-Wallis", p_of(one_way, "Permutation", "b", "p-value, Kruskal-Wallis"));
  }
  rates.expect_nominal();
}

TEST(FalsePositivesSlow, OfUnequalVariances) {
  Rates rates;
  for (std::size_t study = 0; study < kStudies; ++study) {
    auto random = RandomStream{102}.split(study);
    std::string text = "b,y\n";
    constexpr std::array<std::size_t, 3> kSizes{20, 10, 15};
    constexpr std::array<double, 3> kSpreads{1.0, 4.0, 2.0};
    for (std::size_t level = 0; level < 3; ++level) {
      for (std::size_t i = 0; i < kSizes.at(level); ++i)
        text += fmt::format("b{},{}\n", level, kSpreads.at(level) * standard_normal(random));
    }
    rates.add("Welch's analysis of variance, unequal variances",
              p_of(analyse(text, {"y ~ b"}), "Test that does not assume equal variances", "b"));
  }
  rates.expect_nominal();
}

TEST(FalsePositivesSlow, OfContrastsAndFamilies) {
  Rates rates;
  auto planned = few_permutations();
  planned.contrasts = {parse_contrast("one: b1 - b0")};
  planned.by = {"a"};
  auto family = few_permutations();
  family.contrasts = {parse_contrast("c0 [b]: b1 - b0"), parse_contrast("c1 [b]: b2 - b0"),
                      parse_contrast("c2 [b]: b2 - b1")};
  for (std::size_t study = 0; study < kStudies; ++study) {
    auto random = RandomStream{103}.split(study);
    const auto table = crossed({6, 9, 7, 8, 6, 10}, [&] { return fmt::format("{}", standard_normal(random)); });
    const auto found = analyse(table, {"y ~ a*b"}, planned);
    rates.add("Planned contrast", p_of(found, "Planned contrasts of b", "one"));
    rates.add("Simple effects, any of three pairs at one level",
              p_of(found, "Pairs of b (at each level of a", "a0", "adjusted p-value"));
    rates.add("Planned contrast at each level, Bonferroni, any",
              p_of(found, "Planned contrasts of b at each level of a", "", "corrected p-value"));
    for (const auto& [correction, name] : {std::pair{Correction::kBonferroni, "Bonferroni"},
                                           std::pair{Correction::kHolm, "Holm"}, std::pair{Correction::kFdr, "FDR"}}) {
      family.correction = correction;
      rates.add(fmt::format("Three contrasts that depend on each other, {}, any", name),
                p_of(analyse(table, {"y ~ a*b"}, family), "Planned contrasts of b", "", "adjusted p-value"));
    }
  }
  rates.expect_nominal();
}

// The difference is as large as the smallest one that matters: claiming equivalence is an error.
TEST(FalsePositivesSlow, OfEquivalenceTests) {
  Rates rates;
  auto margin = few_permutations();
  margin.smallest_effect = SmallestEffect{0.5, false};
  for (std::size_t study = 0; study < kStudies; ++study) {
    auto random = RandomStream{104}.split(study);
    std::string text = "g,y\n";
    for (std::size_t i = 0; i < 80; ++i)
      text += fmt::format("g{},{}\n", i % 2, 0.5 * standard_normal(random) + (i % 2 == 0 ? 0.0 : 0.5));
    rates.add("Equivalence (two one-sided tests), true difference at the margin",
              p_of(analyse(text, {"y ~ g"}, margin), "Equivalence within", ""));
  }
  rates.expect_nominal();
}

TEST(FalsePositivesSlow, OfMixedModels) {
  Rates rates;
  for (std::size_t study = 0; study < kStudies; ++study) {
    auto random = RandomStream{105}.split(study);
    // Teams of three with an intraclass correlation of .6, as the p_bec of learners; every team has one strategy.
    std::string learners = "team,member,strategy,type,y\n";
    for (std::size_t team = 0; team < 32; ++team) {
      const double common = 1.2 * standard_normal(random);
      for (std::size_t member = 0; member < 3; ++member)
        learners += fmt::format("{},{},s{},{},{}\n", team, member + 1, team % 4, team / 4 % 3 > member ? "N" : "P",
                                common + standard_normal(random));
    }
    const auto found = analyse(learners, {"y ~ strategy*type"});
    for (const auto* term : {"strategy", "type", "strategy:type"})
      rates.add(std::string{"Mixed model of learners in teams: "} + term, p_of(found, "Tests of the fixed", term));
    // The same people under every strategy: kith's own tables.
    std::string paired = "strategy,composition,replicate,team,y\n", addressed = "strategy,composition,seed_address,y\n";
    for (std::size_t people = 0; people < 16; ++people) {
      const double common = standard_normal(random);
      for (std::size_t strategy = 0; strategy < 4; ++strategy) {
        const double value = common + standard_normal(random);
        paired += fmt::format("s{},{},{},{},{}\n", strategy, people % 2 == 0 ? "NNN" : "PPP", people / 2,
                              people * 4 + strategy, value);
        addressed += fmt::format("s{},{},7/{},{}\n", strategy, people % 2 == 0 ? "NNN" : "PPP", people, value);
      }
    }
    const auto by_replicate = analyse(paired, {"y ~ strategy*composition"});
    const auto by_address = analyse(addressed, {"y ~ strategy*composition"});
    for (const auto* term : {"strategy", "composition", "strategy:composition"}) {
      rates.add(std::string{"Mixed model of teams of the same people: "} + term,
                p_of(by_address, "Tests of the fixed", term));
      rates.add(std::string{"The same without seed addresses: "} + term,
                p_of(by_replicate, "Tests of the fixed", term));
    }
    // Several periods of every learner of every team.
    std::string progress = "team,member,type,y\n";
    for (std::size_t team = 0; team < 12; ++team) {
      const double common = 0.7 * standard_normal(random);
      for (std::size_t member = 0; member < 3; ++member) {
        const double own = common + 0.7 * standard_normal(random);
        for (std::size_t period = 0; period < 4; ++period)
          progress += fmt::format("{},{},{},{}\n", team, member + 1, (team + member) % 2 == 0 ? "N" : "P",
                                  own + standard_normal(random));
      }
    }
    rates.add("Mixed model of periods of learners in teams: type",
              p_of(analyse(progress, {"y ~ type"}), "Tests of the fixed", "type"));
    // Every person under every condition.
    std::string within = "person,condition,y\n";
    for (std::size_t person = 0; person < 15; ++person) {
      const double own = 1.5 * standard_normal(random);
      for (std::size_t condition = 0; condition < 3; ++condition)
        within += fmt::format("{},c{},{}\n", person, condition, own + standard_normal(random));
    }
    const auto repeated = analyse(within, {"y ~ condition"});
    rates.add("Mixed model of repeated people: condition", p_of(repeated, "Tests of the fixed", "condition"));
    rates.add("Mixed model of repeated people: Tukey-Kramer, any of three pairs",
              p_of(repeated, "Pairs of condition", "", "adjusted p-value"));
  }
  rates.expect_nominal();
}

// Tables of repeated people as they come: rows are missing, people are crossed with items, responses are whole numbers.
TEST(FalsePositivesSlow, OfRepeatedPeople) {
  Rates rates;
  auto how = few_permutations();
  how.contrasts = {parse_contrast("one: c1 - c0")};
  auto margin = few_permutations();
  margin.smallest_effect = SmallestEffect{0.5, false};
  for (std::size_t study = 0; study < kStudies; ++study) {
    auto random = RandomStream{111}.split(study);
    // A fifth of the rows is missing; the group differs between people, the condition within them.
    std::string missing = "person,group,condition,y\n", counts = "person,condition,y\n", ratings = counts;
    for (std::size_t person = 0; person < 24; ++person) {
      const double own = standard_normal(random);
      for (std::size_t condition = 0; condition < 3; ++condition) {
        const double value = own + standard_normal(random);
        if (uniform01(random) > 0.2)
          missing += fmt::format("{},g{},c{},{}\n", person, person % 3 == 0 ? 0 : 1, condition, value);
        counts += fmt::format("{},c{},{}\n", person, condition, poisson(std::exp(1.5 + 0.4 * own), random));
        ratings += fmt::format("{},c{},{}\n", person, condition, std::clamp(std::lround(4.0 + value), 1L, 7L));
      }
    }
    const auto unbalanced = analyse(missing, {"y ~ group*condition"}, how);
    for (const auto* term : {"group", "condition", "group:condition"}) {
      rates.add(std::string{"Mixed model with missing rows, type II: "} + term,
                p_of(unbalanced, "Tests of the fixed effects (type II", term));
      rates.add(std::string{"Mixed model with missing rows, type III: "} + term,
                p_of(unbalanced, "Tests of the fixed effects (type III", term));
    }
    rates.add("Mixed model with missing rows: planned contrast", p_of(unbalanced, "Planned contrasts of con", "one"));
    rates.add("Mixed model of counts of repeated people: condition",
              p_of(analyse(counts, {.formula = "y ~ condition", .response_kind = ColumnKind::kCount}),
                   "Tests of the fixed", "condition"));
    rates.add("Mixed model of ratings of repeated people: condition",
              p_of(analyse(ratings, {.formula = "y ~ condition", .response_kind = ColumnKind::kOrdinal}),
                   "Tests of the fixed", "condition"));
    // The true difference is the margin of equivalence, and the people do not differ in the next table.
    std::string shifted = "person,condition,y\n", alike = "person,y\n";
    for (std::size_t person = 0; person < 30; ++person) {
      const double own = standard_normal(random);
      for (std::size_t condition = 0; condition < 2; ++condition) {
        shifted += fmt::format("{},c{},{}\n", person, condition,
                               own + 0.5 * static_cast<double>(condition) + 0.5 * standard_normal(random));
        alike += fmt::format("{},{}\n", person, standard_normal(random));
      }
    }
    rates.add("Equivalence in a mixed model, true difference at the margin",
              p_of(analyse(shifted, {"y ~ condition"}, margin), "Equivalence within", ""));
    rates.add(
        "Test of a variance between groups", p_of(analyse(alike, {"y ~ 1"}), "Variances", "person"),
        "the variance is not negative, which makes the p-values of its likelihood-ratio test up to twice as large "
        "as they need to be");
    // The difficulty differs between items, and every person solves all of them.
    std::string solved = "person,item,difficulty,y\n";
    std::array<double, 8> of_item{};
    for (auto& one : of_item) one = 0.5 * standard_normal(random);
    for (std::size_t person = 0; person < 10; ++person) {
      const double own = standard_normal(random);
      for (std::size_t item = 0; item < of_item.size(); ++item)
        solved +=
            fmt::format("{},{},d{},{}\n", person, item, item % 2, own + of_item.at(item) + standard_normal(random));
    }
    rates.add("Mixed model of people crossed with items: difficulty of items",
              p_of(analyse(solved, {"y ~ difficulty + (1|person) + (1|item)"}), "Tests of the fixed", "difficulty"));
  }
  rates.expect_nominal();
}

TEST(FalsePositivesSlow, OfCounts) {
  Rates rates;
  const std::array<std::size_t, 6> sizes{15, 15, 15, 15, 15, 15};
  const ModelQuestion counts{.formula = "y ~ a*b", .response_kind = ColumnKind::kCount};
  const ModelQuestion main_effects{.formula = "y ~ a + b", .response_kind = ColumnKind::kCount};
  const ModelQuestion censored{.formula = "y ~ a + b", .observed = "done"};
  auto how = few_permutations();
  how.permutations = 1;
  for (std::size_t study = 0; study < kStudies; ++study) {
    auto random = RandomStream{106}.split(study);
    // Periods are underdispersed: 2 and more, with a variance of about .3 times the mean.
    const auto periods = [&] { return 2 + binomial(8, 0.7, random); };
    const auto under = analyse(crossed(sizes, [&] { return fmt::format("{}", periods()); }), counts, how);
    for (const auto* term : {"a", "b", "a:b"})
      rates.add(std::string{"Quasi-Poisson, underdispersed: "} + term, p_of(under, "F tests of the quasi", term));
    rates.add("Quasi-Poisson: Tukey-Kramer, any of three ratios",
              p_of(under, "Ratios of means: Pairs of b", "", "adjusted p-value"));
    const auto over =
        analyse(crossed(sizes, [&] { return fmt::format("{}", negative_binomial(8.0, random)); }), main_effects, how);
    for (const auto* term : {"a", "b"})
      rates.add(std::string{"Negative binomial: "} + term, p_of(over, "Likelihood-ratio tests of the neg", term));
    const auto cut = [&](std::size_t value, std::size_t limit) {
      return fmt::format("{},{}", std::min(value, limit), value <= limit ? "true" : "false");
    };
    const auto cut_over = analyse(crossed(
                                      sizes, [&] { return cut(1 + negative_binomial(8.0, random), 16); }, "y,done"),
                                  censored, how);
    const auto cut_under = analyse(crossed(
                                       sizes, [&] { return cut(periods(), 8); }, "y,done"),
                                   censored, how);
    for (const auto* term : {"a", "b"}) {
      rates.add(std::string{"Negative binomial, censored: "} + term,
                p_of(cut_over, "Likelihood-ratio tests of the censored", term));
      rates.add(std::string{"Poisson, censored and underdispersed: "} + term,
                p_of(cut_under, "Likelihood-ratio tests of the censored", term),
                "Poisson's variance is about three times the true one, and nothing estimates it where counts are cut "
                "off; use the log-rank test");
      rates.add(std::string{"Log-rank, stratified: "} + term, p_of(cut_over, "Log-rank", term));
      rates.add(std::string{"Log-rank, stratified, underdispersed: "} + term, p_of(cut_under, "Log-rank", term));
    }
  }
  rates.expect_nominal();
}

TEST(FalsePositivesSlow, OfRatings) {
  Rates rates;
  const ModelQuestion ratings{.formula = "y ~ a*b", .response_kind = ColumnKind::kOrdinal};
  auto how = few_permutations();
  how.contrasts = {parse_contrast("one: b1 - b0")};
  for (std::size_t study = 0; study < kStudies; ++study) {
    auto random = RandomStream{107}.split(study);
    const auto rating = [&] {
      const double value = 3.4 + 1.1 * standard_normal(random);
      return fmt::format("{}", static_cast<int>(std::clamp(std::round(value), 1.0, 5.0)));
    };
    const auto found = analyse(crossed({15, 15, 15, 15, 15, 15}, rating), ratings, how);
    for (const auto* term : {"a", "b", "a:b"})
      rates.add(std::string{"Cumulative logit: "} + term, p_of(found, "Likelihood-ratio tests", term));
    rates.add("Cumulative logit: Tukey-Kramer, any of three odds ratios",
              p_of(found, "Pairs of b", "", "adjusted p-value"));
    rates.add("Cumulative logit: planned contrast", p_of(found, "Planned contrasts of b", "one"));
  }
  rates.expect_nominal();
}

}  // namespace
}  // namespace kith
