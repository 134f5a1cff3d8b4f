// How closely estimates and tests agree with R, on the same designs for every procedure: the data sets of
// reference/make_reference_designs.R. reference/README.md has the table; agreement.mjs writes it there from the
// property "agreement" of these tests.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "common.hpp"
#include "kith/analysis/anova.hpp"
#include "kith/analysis/linear_model.hpp"
#include "kith/analysis/marginal_means.hpp"
#include "reference.hpp"

namespace kith {
namespace {

using nlohmann::json;
using testing::numbered_factor;

constexpr std::size_t kFewestDataSets = 20;
constexpr double kEstimateTolerance = 1e-6;  // relative to the value, or to its standard error if that is larger
constexpr double kTestTolerance = 1e-4;      // of p-values, F and degrees of freedom, relative
constexpr double kNoProbability = 1e-12;     // p-values below it are as good as 0

const json& agreement_reference() {
  static const json read = testing::read_reference("designs.json");
  return read;
}

// What can make a data set difficult.
enum DataKind : std::size_t {
  kUnbalanced,    // cells with unequal numbers of rows
  kConfounded,    // two factors whose Cramer's V is at least .5
  kEmptyCell,     // a combination of levels without rows
  kOneRow,        // a cell with one row
  kNoVariance,    // a cell of several equal values
  kThreeFactors,  // or more
  kNumKinds
};
using DataKinds = std::array<bool, kNumKinds>;

// Of two factors: 0 if they are independent, 1 if one determines the other.
double cramers_v(const Factor& a, const Factor& b) {
  std::map<std::pair<std::size_t, std::size_t>, double> cells;
  std::map<std::size_t, double> rows, columns;
  const auto n = static_cast<double>(a.codes.size());
  for (std::size_t i = 0; i < a.codes.size(); ++i) {
    cells[{a.codes[i], b.codes[i]}] += 1.0;
    rows[a.codes[i]] += 1.0;
    columns[b.codes[i]] += 1.0;
  }
  double share = 0.0;
  for (const auto& [cell, count] : cells) share += count * count / (rows[cell.first] * columns[cell.second]);
  const auto least = static_cast<double>(std::min(rows.size(), columns.size()));
  return least < 2.0 || n == 0.0 ? 0.0 : std::sqrt((share - 1.0) / (least - 1.0));
}

DataKinds kinds_of(const std::vector<Factor>& factors, const std::vector<double>& response) {
  std::map<std::vector<std::size_t>, std::vector<double>> cells;
  for (std::size_t i = 0; i < response.size(); ++i) {
    std::vector<std::size_t> cell;
    for (const auto& factor : factors) cell.push_back(factor.codes[i]);
    cells[cell].push_back(response[i]);
  }
  DataKinds kinds{};
  std::size_t all_cells = 1;
  for (std::size_t f = 0; f < factors.size(); ++f) {
    all_cells *= factors[f].levels.size();
    for (std::size_t g = 0; g < f; ++g)
      kinds[kConfounded] = kinds[kConfounded] || cramers_v(factors[f], factors[g]) >= 0.5;
  }
  for (const auto& [cell, values] : cells) {
    const bool alike = values.size() > 1 && std::set<double>(values.begin(), values.end()).size() == 1;
    kinds[kUnbalanced] = kinds[kUnbalanced] || values.size() != cells.begin()->second.size();
    kinds[kOneRow] = kinds[kOneRow] || values.size() == 1;
    kinds[kNoVariance] = kinds[kNoVariance] || alike;
  }
  kinds[kEmptyCell] = cells.size() < all_cells;
  kinds[kThreeFactors] = factors.size() > 2;
  return kinds;
}

// Of a table within people: groups are cells, people are rows. Without variance, all people have the same mean.
DataKinds kinds_of_people(const std::vector<double>& response, const Factor& group, const Factor& person) {
  std::map<std::size_t, std::set<std::size_t>> people;
  std::map<std::size_t, double> sums;
  double spread = 0.0;
  for (std::size_t i = 0; i < response.size(); ++i) {
    people[group.codes[i]].insert(person.codes[i]);
    sums[person.codes[i]] += response[i];
    spread = std::max(spread, std::abs(response[i]));
  }
  DataKinds kinds{};
  for (const auto& [code, members] : people) {
    kinds[kUnbalanced] = kinds[kUnbalanced] || members.size() != people.begin()->second.size();
    kinds[kOneRow] = kinds[kOneRow] || members.size() == 1;
  }
  kinds[kNoVariance] = std::all_of(sums.begin(), sums.end(), [&](const auto& sum) {
    return std::abs(sum.second - sums.begin()->second) < 1e-12 * spread;
  });
  return kinds;
}

// How a procedure compares: its largest differences, and on how many data sets of each kind.
class Comparison {
 public:
  void add_data(const DataKinds& kinds) {
    ++data_sets_;
    for (std::size_t k = 0; k < kNumKinds; ++k) of_kind_.at(k) += kinds.at(k) ? 1u : 0u;
  }
  // @param scale  what the difference is relative to if `expected` is smaller.
  void estimate(double actual, const json& expected, double scale, const std::string& what) {
    compare(actual, expected, scale, kEstimateTolerance, estimates_, what);
  }
  void test(double actual, const json& expected, const std::string& what) {
    compare(actual, expected, kNoProbability, kTestTolerance, tests_, what);
  }
  // "24|18|...|1.2e-13|3.4e-12"
  [[nodiscard]] std::string text() const {
    std::string text = std::to_string(data_sets_);
    for (const auto count : of_kind_) text += "|" + std::to_string(count);
    for (const double difference : {estimates_, tests_}) text += "|" + json(difference).dump();
    return text;
  }
  [[nodiscard]] std::size_t data_sets() const { return data_sets_; }

 private:
  static void compare(double actual, const json& expected, double scale, double tolerance, double& largest,
                      const std::string& what) {
    const double value = expected;
    const double difference = std::abs(actual - value) / std::max(std::abs(value), scale);
    EXPECT_LE(difference, tolerance) << what << ": " << actual << " where R has " << value;
    largest = std::max(largest, difference);
  }
  std::size_t data_sets_ = 0;
  std::array<std::size_t, kNumKinds> of_kind_{};
  double estimates_ = 0.0, tests_ = 0.0;
};

// Comparisons by the name of the procedure, in the order in which they first occur.
class Agreement {
 public:
  Comparison& of(const std::string& procedure) {
    const auto found = std::find_if(all_.begin(), all_.end(), [&](const auto& one) { return one.first == procedure; });
    return found == all_.end() ? all_.emplace_back(procedure, Comparison{}).second : found->second;
  }
  // Every procedure was compared on enough data sets; records a line for each.
  void finish() const {
    std::string text;
    for (const auto& [procedure, comparison] : all_) {
      EXPECT_GE(comparison.data_sets(), kFewestDataSets) << procedure;
      text += procedure + "|" + comparison.text() + "\n";
    }
    ::testing::Test::RecordProperty("agreement", text);
  }

 private:
  std::deque<std::pair<std::string, Comparison>> all_;  // references stay valid
};

// Where R cannot estimate something, neither can kith.
void compare_estimate(const LinearEstimate& actual, const json& expected, Comparison& comparison) {
  ASSERT_EQ(static_cast<bool>(actual.estimate), !expected.at("estimate").is_null()) << actual.name;
  if (!actual.estimate) return;
  ASSERT_TRUE(actual.inference) << actual.name << ": " << actual.inference.reason();
  comparison.estimate(*actual.estimate, expected.at("estimate"), expected.at("se"), actual.name);
  comparison.estimate(actual.inference->standard_error, expected.at("se"), 0.0, actual.name + ", standard error");
  comparison.test(actual.inference->p, expected.at("p"), actual.name + ", p");
  if (expected.at("df").is_null()) {
    EXPECT_EQ(actual.inference->df, testing::kInfinity) << actual.name;
  } else {
    comparison.test(actual.inference->df, expected.at("df"), actual.name + ", df");
  }
}

// What follows from the fixed effects of a model.
void compare_means(const FixedEffects& model, const json& fitted, const std::string& of_model, const DataKinds& kinds,
                   Agreement& agreement) {
  auto& means = agreement.of("Marginal means and contrasts, " + of_model);
  auto& tukey = agreement.of("Tukey-Kramer, " + of_model);
  for (auto* const one : {&means, &tukey}) one->add_data(kinds);
  for (const auto& expected : fitted.at("comparisons")) {
    const std::vector<std::size_t> over{expected.at("over").get<std::size_t>()};
    const auto group = marginal_means(model, over).groups.at(0);
    ASSERT_EQ(group.means.size(), expected.at("means").size());
    for (std::size_t i = 0; i < group.means.size(); ++i)
      compare_estimate(group.means[i], expected.at("means")[i], means);
    const auto compare_contrasts = [&](const std::vector<MeanContrast>& contrasts, const json& rows, bool is_family) {
      const auto plain = estimate_contrasts(model, group, contrasts, Adjustment::kNone);
      ASSERT_EQ(plain.size(), rows.size());
      for (std::size_t i = 0; i < plain.size(); ++i) compare_estimate(plain[i], rows[i], means);
      if (!is_family) return;
      const auto adjusted = estimate_contrasts(model, group, contrasts, Adjustment::kTukey);
      for (std::size_t i = 0; i < adjusted.size(); ++i) {
        if (!adjusted[i].inference || rows[i].at("tukey").is_null()) continue;
        tukey.estimate(*adjusted[i].estimate, rows[i].at("estimate"), rows[i].at("se"), adjusted[i].name);
        tukey.test(adjusted[i].inference->p, rows[i].at("tukey"), adjusted[i].name + ", adjusted p");
      }
    };
    compare_contrasts(pairwise_contrasts(group), expected.at("pairs"), true);
    compare_contrasts({{"planned", expected.at("weights")}}, expected.at("contrast"), false);
  }
}

struct TestedDesign {
  std::string name;
  std::vector<Factor> factors;
  std::vector<std::vector<std::size_t>> terms;
};

template <typename Check>
void for_every_design(Check check) {
  for (const auto& entry : agreement_reference().at("designs")) {
    SCOPED_TRACE(entry.at("name").get<std::string>());
    check(TestedDesign{entry.at("name"), testing::read_factors(entry.at("factors")), entry.at("terms")}, entry);
  }
}

TEST(Agreement, OfLinearModels) {
  Agreement agreement;
  for_every_design([&](const TestedDesign& design, const json& entry) {
    const auto& fitted = entry.at("linear");
    const std::vector<double> response = fitted.at("y");
    const auto model = fit_linear_model(response, design.factors, design.terms);
    ASSERT_TRUE(model) << model.reason();
    compare_means(model->effects, fitted, "linear model", kinds_of(design.factors, response), agreement);
  });
  agreement.finish();
}

TEST(Agreement, OfCorrectionsForSphericity) {
  Agreement agreement;
  for (const auto& entry : agreement_reference().at("within_people")) {
    SCOPED_TRACE(entry.at("name").get<std::string>());
    const std::vector<double> response = entry.at("y");
    const auto within = numbered_factor("within", entry.at("within"));
    const auto group = numbered_factor("group", entry.at("group"));
    const auto person = numbered_factor("person", entry.at("person"));
    const auto sphericity = check_sphericity(response, within, group, person);
    ASSERT_TRUE(sphericity) << sphericity.reason();
    const auto table = blocked_anova(response, within, group, person);
    ASSERT_TRUE(table) << table.reason();
    auto& comparison = agreement.of("Greenhouse-Geisser and Huynh-Feldt");
    comparison.add_data(kinds_of_people(response, group, person));
    comparison.estimate(sphericity->mauchly_w, entry.at("w"), 0.0, "Mauchly's W");
    comparison.estimate(sphericity->greenhouse_geisser, entry.at("gg"), 0.0, "Greenhouse-Geisser");
    comparison.estimate(sphericity->huynh_feldt, entry.at("hf"), 0.0, "Huynh-Feldt");
    for (std::size_t t = 0; t < entry.at("tests").size(); ++t) {
      const auto& expected = entry.at("tests")[t];
      const auto& test = table->terms.at(t).test.value();
      comparison.test(test.statistic, expected.at("f"), "F");
      comparison.test(test.p, expected.at("p"), "p");
      comparison.test(correct_for_sphericity(test, sphericity->greenhouse_geisser).p, expected.at("p_gg"), "p, GG");
      comparison.test(correct_for_sphericity(test, sphericity->huynh_feldt).p, expected.at("p_hf"), "p, HF");
    }
  }
  agreement.finish();
}

}  // namespace
}  // namespace kith
