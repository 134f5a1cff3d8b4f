#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "kith/analysis/distributions.hpp"
#include "kith/analysis/moments.hpp"
#include "model_means.hpp"

namespace kith {
namespace {

constexpr double kUnequalSpread = 2.0;   // ratio of standard deviations that people should know about
constexpr double kSkewed = 1.0;          // of residuals
constexpr double kHeavyTails = 2.0;      // excess kurtosis
constexpr std::size_t kFewPerCell = 10;  // below it F tests depend on normal residuals

std::string degrees_text(double df) {
  return df == std::floor(df) ? fmt::format("{:.0f}", df) : fmt::format("{:.1f}", df);
}

// How large an effect is, in the words of [cohen1988, section 8.2].
std::string size_text(double eta_squared) {
  if (eta_squared < 0.01) return "negligible";
  if (eta_squared < 0.06) return "small";
  return eta_squared < 0.14 ? "medium" : "large";
}

// "large", or "small to large" if the data do not tell.
std::string size_text(const Estimable<Interval>& eta_squared) {
  if (!eta_squared) return {};
  const auto least = size_text(eta_squared->low), most = size_text(eta_squared->high);
  return least == most ? least : least + " to " + most;
}

// "strategy and composition"
std::string joined_names(const ModelData& data, std::size_t t) {
  return listed(data.terms[t], [&](std::size_t factor) { return data.factors[factor].name; });
}

// At the start of a sentence. Names of columns that are no words stay as they are.
std::string at_start(std::string text) {
  const bool is_word = text.size() > 2 &&
                       std::all_of(text.begin(), text.end(), [](char c) { return (c >= 'a' && c <= 'z') || c == ' '; });
  if (is_word) text[0] = static_cast<char>(text[0] - 'a' + 'A');
  return text;
}

void add_cell_warnings(const ModelData& data, const CellDesign& design, double alpha,
                       std::vector<std::string>& warnings) {
  const Factor cells{"cell", std::vector<std::string>(design.counts.size()), design.cell_of};
  const auto groups = split_by(data.values, cells);
  std::size_t least = groups.front().size(), most = 0;
  double smallest = std::numeric_limits<double>::infinity(), largest = 0.0;
  for (const auto& group : groups) {
    least = std::min(least, group.size());
    most = std::max(most, group.size());
    if (group.size() < 2) continue;
    smallest = std::min(smallest, *standard_deviation(group));
    largest = std::max(largest, *standard_deviation(group));
  }
  if (least != most)
    warnings.push_back(
        fmt::format("the design is unbalanced (cells have {} to {} {})", least, most, data.observations));
  if (least < kFewPerCell)
    warnings.push_back(fmt::format("the smallest cell has {}, so F tests depend on normal residuals",
                                   counted(least, data.observations.substr(0, data.observations.size() - 1))));
  const auto spread = brown_forsythe(data.values, cells);
  if (spread && spread->p < alpha && largest > kUnequalSpread * smallest) {
    warnings.push_back(fmt::format(
        "standard deviations differ between cells ({} to {}; Brown-Forsythe {}), which F tests assume not to",
        formatted(smallest, ResultKind::kNumber), formatted(largest, ResultKind::kNumber), test_text(*spread)));
  }
}

// The value that is furthest from what the model says of it, if chance hardly explains that: by its studentised
// residual of the model that is fitted without it, with Bonferroni's correction for the search (R: car::outlierTest).
void add_far_value(const ModelData& data, const ModelResult& result, std::vector<std::string>& warnings) {
  const auto& effects = result.table.effects;
  if (!effects || !effects->residual_sd) return;
  const auto& design = effects->design;
  std::vector<double> leverages;
  for (std::size_t cell = 0; cell < design.counts.size(); ++cell) {
    std::vector<double> mean(design.counts.size(), 0.0);
    mean[cell] = 1.0 / static_cast<double>(design.counts[cell]);
    leverages.push_back(design.fitted(mean)[cell]);
  }
  const auto df = static_cast<double>(result.table.residual_df);
  warn_of_far_value(data.values, result.table.residuals, leverages, design.cell_of, df,
                    df * std::pow(*effects->residual_sd, 2), warnings);
}

void add_shape_warnings(const ModelResult& result, double alpha, std::vector<std::string>& warnings) {
  const auto shape = check_normality(result.table.residuals);
  if (!shape || shape->test.p >= alpha) return;
  if (std::abs(shape->skewness) < kSkewed && std::abs(shape->excess_kurtosis) < kHeavyTails) return;
  warnings.push_back(fmt::format("residuals are not normally distributed (skewness {:.2f}, excess kurtosis {:.2f})",
                                 shape->skewness, shape->excess_kurtosis));
}

}  // namespace

void warn_of_far_value(std::span<const double> values, std::span<const double> residuals,
                       std::span<const double> leverages, std::span<const std::size_t> cell_of, double df,
                       double squares, std::vector<std::string>& warnings) {
  constexpr double kHardlyByChance = 0.001;
  constexpr double kExactly = 1e-12;
  if (df < 2.0) return;
  std::size_t furthest = 0;
  double largest = 0.0;
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    const double free = 1.0 - leverages[cell_of[i]];
    if (free < 1e-9) continue;  // fitted exactly, whatever its value
    const double square = std::pow(residuals[i], 2) / free;
    const double rest = (squares - square) / (df - 1.0);
    // What is left of all that is lost in rounding is nothing: the model fits the others exactly.
    const bool fits_others = rest * (df - 1.0) <= kExactly * squares;
    const double size = fits_others ? std::numeric_limits<double>::infinity() : std::sqrt(square / rest);
    if (size <= largest) continue;
    largest = size;
    furthest = i;
  }
  if (std::isinf(largest)) {
    warnings.push_back(fmt::format(
        "the value {} is unlike all others, which the model fits exactly without it, so how far it is from them cannot "
        "be estimated; see whether it is an error, and what is found without it",
        formatted(values[furthest], ResultKind::kNumber)));
    return;
  }
  const double p = std::min(1.0, static_cast<double>(residuals.size()) * student_t_two_sided(largest, df - 1.0));
  if (p >= kHardlyByChance) return;
  warnings.push_back(
      fmt::format("the value {} is far from the others: {:.1f} standard deviations from what the model says without "
                  "it; see whether it is an error, and what is found without it",
                  formatted(values[furthest], ResultKind::kNumber), largest));
}

std::string test_text(const TestResult& test) {
  const auto brackets =
      test.df.empty() ? "" : "(" + joined(test.df, ", ", [](double df) { return degrees_text(df); }) + ")";
  return fmt::format("{}{} = {:.2f}, {}", test.statistic_name, brackets, test.statistic, p_text(test.p));
}

std::string term_sentence(const ModelData& data, std::size_t t, const Estimable<TestResult>& test,
                          const Estimable<Interval>& eta_squared, const FixedEffects& means, double alpha) {
  const auto& term = data.terms[t];
  if (!test)
    return fmt::format("The {} of {} cannot be tested: {}.", term.size() > 1 ? "interaction" : "effect",
                       joined_names(data, t), test.reason());
  const auto p = p_text(test->p);
  const bool found = test->p < alpha;
  const auto size = size_text(eta_squared);
  if (term.size() > 1) {
    if (!found) return fmt::format("No interaction of {} was found ({}).", joined_names(data, t), p);
    return fmt::format("{} interact ({}{}).", at_start(joined_names(data, t)), size.empty() ? "" : size + " effect, ",
                       p);
  }
  const auto& factor = data.factors[term.front()];
  if (!found) return fmt::format("No effect of {} was found ({}).", factor.name, p);
  const auto range = range_of_means(means, factor.name);
  const bool are_raw = data.factors.size() == 1 && data.groups.empty();
  return fmt::format("{} has {} effect ({}){}.", at_start(factor.name), size.empty() ? "an" : "a " + size, p,
                     range.empty() ? ""
                     : are_raw     ? ": means range " + range
                                   : ": estimated marginal means range " + range);
}

std::string sentence_of(const ModelData& data, const ModelResult& result, double alpha) {
  std::string text;
  for (std::size_t t = 0; t < data.terms.size(); ++t)
    text +=
        " " + term_sentence(data, t, result.table.terms[t].test, result.eta_squared[t], *result.table.effects, alpha);
  return text;
}

std::vector<std::string> warnings_of(const ModelData& data, const ModelResult& result, double alpha) {
  std::vector<std::string> warnings;
  if (data.factors.empty()) return warnings;
  add_cell_warnings(data, result.table.effects->design, alpha, warnings);
  add_shape_warnings(result, alpha, warnings);
  add_far_value(data, result, warnings);
  return warnings;
}

}  // namespace kith
