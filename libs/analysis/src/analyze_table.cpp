#include <fmt/format.h>
#include <cmath>

#include "kith/analysis/analysis.hpp"
#include "kith/core/error.hpp"
#include "kith/stats/formula.hpp"
#include "model.hpp"

namespace kith {
namespace {

constexpr std::size_t kMostLevelsOfAFactor = 200;
constexpr std::size_t kMostTerms = 63;  // six factors with all their interactions

Formula formula_of(const std::string& text) {
  auto reading = parse_formula(text);
  if (!reading.formula.random_intercepts.empty()) {
    throw Error{ErrorKind::kUsage, fmt::format("model '{}': random intercepts cannot be fitted yet; leave out (1|{})",
                                               text, fmt::join(reading.formula.random_intercepts.front(), ":"))};
  }
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

// Every term is tested against all others, again for every permutation and resample.
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

}  // namespace

Analysis analyze_table(const Dataset& data, const ModelQuestion& question, const AnalysisOptions& options) {
  const auto formula = formula_of(question.formula);
  check_terms(formula);
  std::vector<std::string> columns = formula.factors;
  columns.push_back(formula.response);
  if (question.observed) columns.push_back(*question.observed);
  const auto complete = data.complete(columns);
  if (complete.num_rows() == 0) {
    throw Error{{Diagnostic{.id = "E0905",
                            .message = "no row has a value in every column of the model",
                            .file = data.file(),
                            .hint = "the model uses the columns " + with_and(columns),
                            .infeasible = true}}};
  }
  ModelData model{.response = formula.response, .terms = formula.terms};
  for (const auto& value : complete.numbers(formula.response)) model.values.push_back(*value);
  for (const auto& name : formula.factors) {
    model.factors.push_back(complete.factor(name));
    check_factor(complete, model.factors.back());
  }
  if (question.observed) model.observed = observed_of(complete, *question.observed);
  Analysis analysis{data.file(), {}};
  if (const auto dropped = data.num_rows() - complete.num_rows(); dropped > 0)
    analysis.notes.push_back(
        fmt::format("{} of {} rows were left out because they lack a value", dropped, data.num_rows()));
  analysis.findings.push_back(analyze_model(model, options, RandomStream{options.seed}.split("model")));
  return analysis;
}

}  // namespace kith
