#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string_view>

#include "kith/core/error.hpp"
#include "kith/stats/formula.hpp"
#include "model_means.hpp"
#include "prepared_model.hpp"
#include "row_groups.hpp"

namespace kith {
namespace {

constexpr std::size_t kMostLevelsOfAFactor = 200;
constexpr std::size_t kMostTerms = 63;    // six factors with all their interactions
constexpr std::size_t kMostRatings = 11;  // steps of a scale from 0 to 10

Formula formula_of(const std::string& text) {
  auto reading = parse_formula(text);
  if (reading.errors.empty()) return std::move(reading.formula);
  const auto& error = reading.errors.front();
  throw Error{ErrorKind::kUsage, fmt::format("model '{}', character {}: {}{}", text, error.column, error.message,
                                             error.hint.empty() ? "" : "; " + error.hint)};
}

// A factor needs levels to compare, and not one per row.
void check_factor(const Dataset& data, const Factor& factor) {
  Diagnostic diagnostic{.file = data.file(), .line = 1, .column = 1};
  if (factor.levels.size() < 2) {
    diagnostic.id = "E0904";
    diagnostic.message = fmt::format("column '{}' is '{}' in every row, so there is nothing to compare", factor.name,
                                     factor.levels.front());
    diagnostic.hint = "leave it out of the model";
    diagnostic.infeasible = true;
  } else if (factor.levels.size() > kMostLevelsOfAFactor) {
    diagnostic.id = "E0907";
    diagnostic.message = fmt::format("column '{}' has {} different values; a factor has at most {}", factor.name,
                                     factor.levels.size(), kMostLevelsOfAFactor);
    diagnostic.hint = "use columns with few different values as factors";
  } else {
    return;
  }
  throw Error{{std::move(diagnostic)}};
}

// Every term is tested against all others, again for every permutation.
void check_terms(const Formula& formula) {
  if (formula.terms.size() <= kMostTerms) return;
  Diagnostic diagnostic{.id = "E0908", .infeasible = true};
  diagnostic.message =
      fmt::format("the model has {} terms; the limit is {}, as many as six factors with all interactions have",
                  formula.terms.size(), kMostTerms);
  diagnostic.hint = "use + instead of *, or leave factors out";
  throw Error{{std::move(diagnostic)}};
}

std::vector<bool> observed_of(const Dataset& data, const std::string& column) {
  std::vector<bool> observed;
  for (const auto& value : data.numbers(column)) observed.push_back(*value != 0.0);
  return observed;
}

// What the response is: as the question, the table or --observed says, else a number.
ColumnKind kind_of_response(const Dataset& data, const Formula& formula, const ModelQuestion& question) {
  if (question.response_kind != ColumnKind::kUnspecified) return question.response_kind;
  if (question.observed) return ColumnKind::kCount;  // only counts are cut off
  return data.kind(formula.response);
}

void check_counts(const Dataset& data, const std::string& column, const std::vector<double>& values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (values[i] >= 0.0 && values[i] == std::floor(values[i])) continue;
    throw Error{{Diagnostic{.id = "E0910",
                            .message = fmt::format("{} in column '{}' is no count", values[i], column),
                            .file = data.file(),
                            .line = data.line(i),
                            .column = 1,
                            .hint = "counts are whole numbers from 0; leave out --count, or mend the codebook"}}};
  }
}

// "1e+200": the power of ten next to a value.
std::string power_of_ten(double value) { return fmt::format("{:.0e}", std::pow(10.0, std::round(std::log10(value)))); }

// "minutes: 4, team: 1": how many values the columns lack.
std::string missing_text(const Dataset& data, const std::vector<std::string>& columns) {
  std::string text;
  for (const auto& column : columns) {
    const auto& cells = data.cells(column);
    const auto missing = std::count(cells.begin(), cells.end(), std::nullopt);
    if (missing > 0) text += fmt::format("{}{}: {}", text.empty() ? "" : ", ", column, missing);
  }
  return text;
}

bool is_constant(const std::vector<double>& values) {
  return values.size() > 1 &&
         std::all_of(values.begin(), values.end(), [&](double value) { return value == values[0]; });
}

bool is_binary(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double value) { return value == 0.0 || value == 1.0; });
}

// Levels that whoever reads them takes for the same word: "joint" and "Joint ".
std::optional<std::string> note_on_similar_levels(const Factor& factor) {
  std::map<std::string, std::string> seen;
  for (const std::string& level : factor.levels) {
    std::string plain;
    for (const char c : level) {
      if (c != ' ' && c != '\t') plain += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    }
    const auto [at, is_new] = seen.try_emplace(plain, level);
    if (is_new) continue;
    return fmt::format(
        "{} has the levels '{}' and '{}', which differ only in capitals or blanks: mend the table if they "
        "mean the same",
        factor.name, at->second, level);
  }
  return std::nullopt;
}

// Numbers on the right are levels as all others are: no trend is fitted.
std::optional<std::string> note_on_numbers_as_levels(const Factor& factor) {
  constexpr std::size_t kFewestOfATrend = 3;
  if (factor.levels.size() < kFewestOfATrend) return std::nullopt;
  const auto is_number = [](const std::string& text) {
    double value = 0.0;
    const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
    return result.ec == std::errc{} && result.ptr == text.data() + text.size();
  };
  if (!std::all_of(factor.levels.begin(), factor.levels.end(), is_number)) return std::nullopt;
  return fmt::format("{} holds numbers, which are compared as {} levels of a factor; no trend is fitted", factor.name,
                     factor.levels.size());
}

// Whole numbers are not taken for counts or ratings unless somebody says so, but people should know that they can.
std::optional<std::string> note_on_whole_numbers(const std::string& response, const std::vector<double>& values) {
  std::set<double> distinct;
  for (const double value : values) {
    if (value < 0.0 || value != std::floor(value)) return std::nullopt;
    if (distinct.size() <= kMostRatings) distinct.insert(value);
  }
  if (distinct.size() < 3) return std::nullopt;
  const bool may_be_ratings = distinct.size() <= kMostRatings && *distinct.rbegin() <= kMostRatings;
  return fmt::format("{} holds whole numbers, which are analysed as measurements; use --count if they are counts{}",
                     response, may_be_ratings ? ", --ordinal if they are ratings" : "");
}

// "trust_likert", "rating of ease".
bool is_named_rating(const std::string& column) {
  constexpr std::array<std::string_view, 3> kRatings{"likert", "rating", "ratings"};
  return has_word(column, kRatings);
}

bool are_ratings(const std::vector<double>& values) {
  std::set<double> distinct;
  for (const double value : values) {
    if (value < 0.0 || value > kMostRatings || value != std::floor(value)) return false;
    distinct.insert(value);
  }
  return distinct.size() >= 3;
}

// Intercepts of the formula replace those that were found, so the latter have to be written with the new one.
std::vector<std::vector<std::string>> with_item(std::vector<std::vector<std::string>> intercepts,
                                                const std::string& item) {
  intercepts.push_back({item});
  return intercepts;
}

// The random intercepts: those of the formula, or of identifiers that repeat.
void find_groups(const Dataset& data, const Formula& formula, const ModelQuestion& question, PreparedModel& prepared) {
  for (const auto& column : question.identifiers) prepared.rows.set_kind(column, ColumnKind::kIdentifier);
  auto used = formula.factors;
  used.push_back(formula.response);
  auto groups = find_row_groups(prepared.rows, used);
  auto& notes = prepared.notes;

  const bool is_asked = !formula.random_intercepts.empty();
  for (const auto& item : groups.items) {
    const auto in_intercept = [&](const auto& columns) {
      return std::find(columns.begin(), columns.end(), item) != columns.end();
    };
    const auto& asked = formula.random_intercepts;
    if (std::any_of(asked.begin(), asked.end(), in_intercept) || question.independent) continue;
    notes.push_back(fmt::format(
        "rows with the same {0} may be alike, too, which the model ignores: the tests are about these values of {0} "
        "only; to draw conclusions about others, write + {1} into the formula",
        item,
        intercepts_text(is_asked || groups.intercepts.empty() ? std::vector<std::vector<std::string>>{{item}}
                                                              : with_item(groups.intercepts, item))));
  }

  if (!is_asked) notes.insert(notes.end(), groups.notes.begin(), groups.notes.end());
  if (is_asked) {
    prepared.intercepts = formula.random_intercepts;
  } else if (groups.intercepts.empty()) {
    return;
  } else if (question.independent) {
    prepared.warnings.push_back(fmt::format(
        "identifiers repeat ({}), but rows are analysed as independent, as requested: if rows of a group are "
        "alike, p-values are too small",
        intercepts_text(groups.intercepts)));
    return;
  } else {
    prepared.intercepts = groups.intercepts;
    notes.push_back(fmt::format(
        "identifiers repeat in {}, so the model has random intercepts, {}; to choose others, write them into "
        "the formula, or use --independent",
        data.file(), intercepts_text(groups.intercepts)));
  }
  for (const auto& columns : prepared.intercepts) prepared.model.groups.push_back(row_factor(prepared.rows, columns));
}

}  // namespace

void check_sizes(const Dataset& data, const std::string& column) {
  constexpr double kSmallest = 1e-100, kLargest = 1e100;  // of the largest value
  const auto numbers = data.numbers(column);
  double largest = 0.0;
  std::size_t row = 0;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const double size = std::abs(numbers[i].value_or(0.0));
    if (size <= largest) continue;
    largest = size;
    row = i;
  }
  if (largest == 0.0 || (largest >= kSmallest && largest <= kLargest)) return;
  throw Error{
      {Diagnostic{.id = "E0911",
                  .message = fmt::format("{:g} in column '{}' is too {} for a variance to be computed", *numbers[row],
                                         column, largest > kLargest ? "large" : "small"),
                  .file = data.file(),
                  .line = data.line(row),
                  .column = 1,
                  .hint = fmt::format("divide the column by {}, which changes no test", power_of_ten(largest))}}};
}

PreparedModel prepare_model(const Dataset& data, const ModelQuestion& question, const AnalysisOptions& options) {
  const auto formula = formula_of(question.formula);
  check_terms(formula);

  std::vector<std::string> columns = formula.factors;
  columns.push_back(formula.response);
  if (question.observed) columns.push_back(*question.observed);
  for (const auto& intercept : formula.random_intercepts) {
    for (const auto& column : intercept) {
      if (std::find(columns.begin(), columns.end(), column) == columns.end()) columns.push_back(column);
    }
  }

  PreparedModel prepared{.rows = data.complete(columns)};
  const auto& complete = prepared.rows;
  if (complete.num_rows() == 0) {
    throw Error{{Diagnostic{.id = "E0905",
                            .message = "no row has a value in every column of the model",
                            .file = data.file(),
                            .hint = "the model uses the columns " + with_and(columns),
                            .infeasible = true}}};
  }

  auto& model = prepared.model;
  model.response = formula.response;
  model.terms = formula.terms;
  check_sizes(complete, formula.response);
  for (const auto& value : complete.numbers(formula.response)) model.values.push_back(*value);
  for (const auto& name : formula.factors) {
    model.factors.push_back(complete.factor(name));
    check_factor(complete, model.factors.back());
  }
  check_comparisons(model.factors, options);
  if (question.observed) model.observed = observed_of(complete, *question.observed);

  if (const auto dropped = data.num_rows() - complete.num_rows(); dropped > 0)
    prepared.notes.push_back(fmt::format("{} of {} rows left out because of missing values ({})", dropped,
                                         data.num_rows(), missing_text(data, columns)));
  if (is_constant(model.values))
    prepared.notes.push_back(
        fmt::format("{} is {} in every row, so there is nothing to explain", formula.response, model.values.front()));
  for (const auto& factor : model.factors) {
    if (auto note = note_on_numbers_as_levels(factor)) prepared.notes.push_back(std::move(*note));
    if (auto note = note_on_similar_levels(factor)) prepared.notes.push_back(std::move(*note));
  }
  find_groups(data, formula, question, prepared);

  auto kind = kind_of_response(data, formula, question);
  if (kind == ColumnKind::kUnspecified && is_named_rating(formula.response) && are_ratings(model.values)) {
    kind = ColumnKind::kOrdinal;
    prepared.notes.push_back(fmt::format(
        "{} is taken for ratings because of its name, so only their order counts; a codebook with \"kind\": "
        "\"number\" makes them measurements",
        formula.response));
  }
  model.is_count = kind == ColumnKind::kCount;
  model.is_ordinal = kind == ColumnKind::kOrdinal;
  if (model.is_count) check_counts(complete, formula.response, model.values);

  model.is_binary = is_binary(model.values);
  if (model.is_binary) {
    prepared.notes.push_back(
        fmt::format("{} is true or false (1 or 0), so its means are proportions, but a linear model is fitted: its "
                    "limits can be below 0 or above 1; if proportions are near 0 or 1, use a logistic regression, as "
                    "the script for R (--r) suggests",
                    formula.response));
  }
  if (kind == ColumnKind::kUnspecified) {
    if (auto note = note_on_whole_numbers(formula.response, model.values)) prepared.notes.push_back(std::move(*note));
  }
  return prepared;
}

}  // namespace kith
