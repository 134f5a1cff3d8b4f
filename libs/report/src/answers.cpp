#include "answers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "kith/analysis/analysis.hpp"
#include "kith/analysis/decimals.hpp"
#include "kith/analysis/effect_size.hpp"
#include "kith/analysis/moments.hpp"
#include "kith/files/column_names.hpp"

namespace kith::detail {
namespace {

const Finding* finding_of(const FirstScreen& screen, const std::string& id) {
  const auto& all = screen.findings;
  const auto found = std::find_if(all.begin(), all.end(), [&](const auto& one) { return one.id == id; });
  return found == all.end() ? nullptr : &*found;
}

// The first comparisons of a finding that are of this kind, at all levels of other factors together.
const ComparisonFamily* comparisons_of(const Finding& finding, ComparisonFamily::Kind kind,
                                       const std::string& factor = "") {
  const auto& all = finding.comparisons;
  const auto found = std::find_if(all.begin(), all.end(), [&](const auto& one) {
    return one.kind == kind && one.factor == factor && one.by.empty();
  });
  return found == all.end() ? nullptr : &*found;
}

std::optional<double> p_of(const ComparisonResult& one) { return one.corrected_p ? one.corrected_p : one.p; }

// The standard deviation of teams of one cell, of all cells together; nothing if no cell has two teams.
std::optional<double> spread_in_cells(const FirstScreen& screen, Quantity quantity) {
  double squares = 0.0, df = 0.0;
  for (auto& values : by_cell(screen.design, screen.data, quantity)) {
    std::erase_if(values, [](double value) { return !std::isfinite(value); });
    const double sd = standard_deviation(values).value_or(0.0),
                 freedom = std::max(static_cast<double>(values.size()), 1.0) - 1.0;
    squares += freedom * sd * sd;
    df += freedom;
  }
  return df > 0.0 ? std::optional{std::sqrt(squares / df)} : std::nullopt;
}

// Where the teams of every cell are alike, more of them would tell nothing: then it is not their number.
double half_width(double low, double high, std::optional<double> spread) {
  constexpr double kRounding = 1e-12;
  if (!(high > low) || (spread && *spread <= kRounding * (high - low))) return 0.0;
  return spread ? (high - low) / 2.0 / *spread : std::numeric_limits<double>::infinity();
}

void set_difference(const ComparisonResult& one, std::optional<double> spread, Answer& answer) {
  answer.estimate = one.estimate;
  answer.low = one.low;
  answer.high = one.high;
  if (one.low && one.high) answer.width = half_width(*one.low, *one.high, spread);
}

// The p-value of a term in the tests that a finding rests on.
std::optional<double> p_of_term(const Finding& finding, const std::string& term) {
  if (finding.tests.empty()) return std::nullopt;
  for (const auto& test : finding.tests.front().tests) {
    if (test.subject == term) return test.p;
  }
  return std::nullopt;
}

std::string two_means(const FirstScreen& screen, const StudyOutcome& outcome, const std::string& between) {
  return means_text({mean(values_of(screen, outcome, false)), mean(values_of(screen, outcome, true))}, outcome.digits,
                    between);
}

// The teams of the level of a factor that has the fewest.
std::size_t fewest_teams(const FirstScreen& screen, const std::string& factor) {
  std::map<std::string, std::size_t> teams;
  for (std::size_t i = 0; i < screen.data.teams.size(); ++i) {
    if (is_alone(screen, i)) continue;
    ++teams[factor == "composition" ? composition_of(screen, i) : series_of(screen, i).strategy];
  }
  std::size_t fewest = screen.data.teams.size();
  for (const auto& [level, count] : teams) fewest = std::min(fewest, count);
  return fewest;
}

std::string not_found(const Answer& answer) {
  return is_of_few(answer) ? "too few teams to tell" : "no difference found";
}

// The same people taught together, whatever the strategy, and alone, or other people.
Estimable<MeanDifference> together_against_alone(const FirstScreen& screen, const StudyOutcome& outcome) {
  const auto taught = [&](bool alone) {
    return by_people(screen, outcome, [&](std::size_t i) { return is_alone(screen, i) == alone; });
  };
  return difference_of_teams(taught(false), taught(true), screen.paired).test;
}

// The least and the greatest of the estimated means of a factor's levels.
struct Extremes {
  std::string means = "";      // "7.1 to 8.5"
  std::string answer = "yes";  // "yes: lowest PPP, highest NNP"
};

Extremes extremes_of(const Finding& finding, const std::string& factor, int digits) {
  const auto& all = finding.means;
  const auto found = std::find_if(all.begin(), all.end(), [&](const auto& one) { return one.factor == factor; });
  if (found == all.end()) return {};
  std::string least_name, most_name;
  double least = std::numeric_limits<double>::infinity(), most = -least;
  for (const auto& mean : found->means) {
    if (!mean.mean) continue;
    if (*mean.mean < least) {
      least = *mean.mean;
      least_name = mean.level;
    }
    if (*mean.mean > most) {
      most = *mean.mean;
      most_name = mean.level;
    }
  }
  if (!(least <= most)) return {};
  return {means_text({least, most}, digits, " to "), "yes: lowest " + least_name + ", highest " + most_name};
}

// Means, where there is nothing to compare.
std::vector<Answer> plain_means(const FirstScreen& screen) {
  std::vector<Answer> list;
  for (const bool alone : {false, true}) {
    for (const auto& outcome : outcomes_of(screen)) {
      const auto values = values_of(screen, outcome, alone);
      if (values.empty()) continue;
      Answer answer{alone ? "Taught one after the other" : "Taught together", std::string{outcome.phrase},
                    outcome.digits};
      answer.means = means_text({mean(values)}, outcome.digits, "");
      const auto interval = mean_interval(values);
      answer.estimate = mean(values);
      if (interval) {
        answer.low = interval->low;
        answer.high = interval->high;
      }
      list.push_back(std::move(answer));
    }
  }
  return list;
}

}  // namespace

std::string means_text(const std::vector<double>& means, int digits, const std::string& between) {
  const int decimals = digits == kPeriods.digits ? digits : share_decimals(means, digits);
  std::string text;
  for (const double mean : means) text += (text.empty() ? "" : between) + fixed_text(mean, decimals);
  return text;
}

bool is_of_few(const Answer& answer) {
  constexpr double kLarge = 0.8;  // standard deviations, Cohen (1988)
  return answer.width > kLarge;
}

bool is_shown(const Answer& answer) { return answer.p && *answer.p < AnalysisOptions{}.alpha; }

Answer answer_about_alone(const FirstScreen& screen, const StudyOutcome& outcome) {
  Answer answer{"Together compared with one after the other", std::string{outcome.phrase}, outcome.digits};
  answer.means = two_means(screen, outcome, " and ");
  answer.teams = std::min(values_of(screen, outcome, false).size(), values_of(screen, outcome, true).size());
  const auto spread = spread_in_cells(screen, outcome.of);

  if (const auto* finding = finding_of(screen, std::string{outcome.column} + "-baseline"); finding != nullptr) {
    answer.finding = finding->id;
    const auto* family = comparisons_of(*finding, ComparisonFamily::Kind::kAlone);
    if (family != nullptr) {
      set_difference(family->comparisons.front(), spread, answer);
      answer.p = p_of(family->comparisons.front());
    }
  } else if (const auto test = together_against_alone(screen, outcome)) {
    answer.estimate = test->difference;
    answer.low = test->low;
    answer.high = test->high;
    answer.width = half_width(test->low, test->high, spread);
    answer.p = test->test.p;
  }

  const double together = mean(values_of(screen, outcome, false)), alone = mean(values_of(screen, outcome, true));

  answer.answer = not_found(answer);
  if (!answer.p) answer.answer = "not tested";
  if (is_shown(answer)) {
    answer.answer = together < alone ? "less together" : "more together";
    if (outcome.digits == 1) answer.answer = together < alone ? "fewer together" : "more together";
  }
  return answer;
}

// A factor with many levels: the largest difference if there is one, else how large one may be.
std::optional<Answer> answer_about(const FirstScreen& screen, const StudyOutcome& outcome, const std::string& factor,
                                   const std::string& question) {
  const auto* finding = finding_of(screen, std::string{outcome.column});
  if (finding == nullptr) return std::nullopt;
  Answer answer{question, std::string{outcome.phrase}, outcome.digits, finding->id};
  answer.p = p_of_term(*finding, factor);
  if (!answer.p) return std::nullopt;
  const auto extremes = extremes_of(*finding, factor, outcome.digits);
  answer.means = extremes.means;
  answer.teams = fewest_teams(screen, factor);
  answer.answer = extremes.answer;

  const auto spread = spread_in_cells(screen, outcome.of);
  double largest = -1.0, bound = 0.0, width = 0.0;
  if (const auto* pairs = comparisons_of(*finding, ComparisonFamily::Kind::kPairs, factor); pairs != nullptr) {
    for (const auto& pair : pairs->comparisons) {
      if (!pair.estimate || !pair.low || !pair.high) continue;
      bound = std::max({bound, std::abs(*pair.low), std::abs(*pair.high)});
      width = std::max(width, half_width(*pair.low, *pair.high, spread));
      if (std::abs(*pair.estimate) <= largest) continue;
      largest = std::abs(*pair.estimate);
      answer.compared = pair.name;
      set_difference(pair, spread, answer);
    }
  }
  if (largest >= 0.0) answer.width = width;
  if (is_shown(answer)) return answer;

  answer.answer = not_found(answer);
  if (largest < 0.0) return answer;
  answer.estimate = answer.low = answer.high = std::nullopt;
  answer.bound = bound;
  answer.compared.clear();
  return answer;
}

std::vector<Answer> planned(const FirstScreen& screen) {
  std::vector<Answer> list;
  const auto* finding = finding_of(screen, "primary");
  const auto* family = finding == nullptr ? nullptr : comparisons_of(*finding, ComparisonFamily::Kind::kPrimary);
  if (family == nullptr) return list;
  for (const auto& comparison : family->comparisons) {
    Answer answer{finding->topic, comparison.name, comparison.response == kPeriods.column ? kPeriods.digits : 2,
                  finding->id};
    const auto* const outcome = find_outcome(comparison.response);
    set_difference(comparison, outcome == nullptr ? std::nullopt : spread_in_cells(screen, outcome->of), answer);
    answer.p = p_of(comparison);
    answer.teams = fewest_teams(screen, "strategy");
    answer.answer = !answer.p ? "not tested" : is_shown(answer) ? "yes" : not_found(answer);
    list.push_back(std::move(answer));
  }
  return list;
}

std::vector<Answer> all_answers(const FirstScreen& screen) {
  auto list = planned(screen);
  const auto outcomes = outcomes_of(screen);
  if (compares_with_alone(screen)) {
    for (const auto& outcome : outcomes) list.push_back(answer_about_alone(screen, outcome));
  }
  const auto add = [&](const std::string& factor, const std::string& question) {
    for (const auto& outcome : outcomes) {
      if (auto answer = answer_about(screen, outcome, factor, question)) list.push_back(*std::move(answer));
    }
  };
  add("strategy", "Among the " + std::to_string(num_together(screen)) + " strategies for a team");
  add("composition", "Who is in the team");
  return list.empty() ? plain_means(screen) : list;
}

}  // namespace kith::detail
