#include "read_study_spec.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>

#include "kith/files/column_names.hpp"
#include "kith/study/outcomes.hpp"

namespace kith {
namespace {

// `weights`, or the mean of the levels `of` less that of the levels `against`.
std::vector<std::pair<std::string, double>> read_weights(TomlReader& table) {
  std::vector<std::pair<std::string, double>> weights;
  if (table.has("weights")) {
    auto levels = table.table("weights", Presence::kRequired);
    if (!levels) return weights;
    for (const auto& entry : levels->content().entries()) {
      if (const auto weight = levels->real(entry.key, Presence::kRequired)) weights.emplace_back(entry.key, *weight);
    }
    return weights;
  }
  const auto of = table.strings("of", Presence::kRequired), against = table.strings("against", Presence::kRequired);
  if (!of || !against) return weights;
  for (const auto& level : *of) weights.emplace_back(level, 1.0 / static_cast<double>(of->size()));
  for (const auto& level : *against) weights.emplace_back(level, -1.0 / static_cast<double>(against->size()));
  return weights;
}

std::vector<std::string> levels_of(const std::string& factor, const StudySpec& spec) {
  if (factor == columns::kComposition) return spec.compositions;
  std::vector<std::string> levels;
  for (const auto& strategy : spec.strategies) levels.push_back(strategy.name);
  return levels;
}

bool check_weights(const StudyContrast& contrast, const TomlPlace& place, const StudySpec& spec, TomlReport& report) {
  const auto levels = levels_of(contrast.factor, spec);
  double sum = 0.0, largest = 0.0;
  std::set<std::string> seen;
  bool is_good = true;
  for (const auto& [level, weight] : contrast.weights) {
    sum += weight;
    largest = std::max(largest, std::abs(weight));
    if (std::find(levels.begin(), levels.end(), level) == levels.end()) {
      report.error("E0420", place,
                   "contrast '" + contrast.name + "' names '" + level + "', no " + contrast.factor + " of this study",
                   suggestion(level, levels));
      is_good = false;
    } else if (!seen.insert(level).second) {
      report.error("E0420", place, "contrast '" + contrast.name + "' names '" + level + "' twice");
      is_good = false;
    }
  }
  constexpr double kZeroSum = 1e-6;  // of the largest weight
  if (is_good && (largest == 0.0 || std::abs(sum) > kZeroSum * largest)) {
    report.error("E0420", place, "contrast '" + contrast.name + "' compares nothing: its weights do not sum to 0",
                 "write of = [...] and against = [...], or weights that sum to 0");
    is_good = false;
  }
  return is_good;
}

}  // namespace

std::vector<StudyContrast> read_contrasts(const TomlArray& list, const StudySpec& spec, TomlReport& report) {
  std::vector<StudyContrast> contrasts;
  std::vector<std::string> responses;
  for (const auto* outcome : analysed_outcomes(true, false)) responses.emplace_back(outcome->column);
  for (const auto& element : list) {
    const auto* content = read_table(element, "an element of 'contrast'", report);
    if (content == nullptr) continue;
    TomlReader table{*content, element.place(), "[[contrast]]", report};
    StudyContrast contrast;
    if (auto name = table.string("name", Presence::kRequired)) contrast.name = *std::move(name);
    if (const auto factor = table.word("factor", Presence::kOptional, kContrastFactorWords))
      contrast.factor = kContrastFactorWords[*factor];
    if (const auto response = table.word("response", Presence::kOptional, responses))
      contrast.response = responses[*response];
    if (!contrast.response.empty() && outcome_named(contrast.response).needs_exam && spec.exam == ExamLevel::kNone) {
      report.error("E0420", element.place(),
                   "contrast '" + contrast.name + "' is about an exam, but nobody is examined",
                   "write exam = \"end\" under [record]");
    }
    contrast.primary = table.boolean("primary", Presence::kOptional).value_or(false);
    contrast.weights = read_weights(table);
    table.finish();
    const auto is_alone = [](const auto& weight) { return weight.first == kBaseline; };
    if (contrast.primary && std::any_of(contrast.weights.begin(), contrast.weights.end(), is_alone)) {
      report.error("E0420", element.place(),
                   "contrast '" + contrast.name + "' is primary, but compares with the baseline",
                   "primary contrasts compare teams that are taught together; kith analyze always compares these with "
                   "the baseline, as a finding of its own");
    }
    const auto same = [&](const auto& other) { return other.name == contrast.name; };
    if (std::any_of(contrasts.begin(), contrasts.end(), same))
      report.error("E0403", element.place(), "contrast '" + contrast.name + "' is listed twice");
    if (check_weights(contrast, element.place(), spec, report)) contrasts.push_back(std::move(contrast));
  }
  return contrasts;
}

}  // namespace kith
