#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "kith/stats/moments.hpp"
#include "kith/stats/tests.hpp"
#include "kith/teaching/strategy.hpp"
#include "outcomes.hpp"
#include "sentences.hpp"

namespace kith::detail {
namespace {

Json difference_json(const Values& values, const Values& reference, bool paired) {
  const auto test = paired ? paired_t_test(values, reference) : welch_t_test(values, reference);
  Json json{{"estimate", number(mean(values) - mean(reference))}, {"low", nullptr}, {"high", nullptr}};
  if (test) {
    json["low"] = number(test->low);
    json["high"] = number(test->high);
  }
  json["n"] = values.size();
  return json;
}

// The values of the teams of a level, in the order of people: those of the same composition and replicate are one
// group.
using Level = std::map<std::pair<std::string, std::size_t>, std::size_t>;

Json difference_of(const FirstScreen& screen, const StudyOutcome& outcome, const Level& level, const Level& reference,
                   bool paired) {
  Values values, others;
  for (const auto& [people, team] : level) {
    const auto other = reference.find(people);
    if (paired && other == reference.end()) continue;
    values.push_back(outcome.of(screen.data.teams[team]));
    if (paired) others.push_back(outcome.of(screen.data.teams[other->second]));
  }
  if (!paired) {
    for (const auto& [people, team] : reference) others.push_back(outcome.of(screen.data.teams[team]));
  }
  const auto missing = [](double value) { return !std::isfinite(value); };
  if (values.empty() || others.empty() || std::any_of(values.begin(), values.end(), missing) ||
      std::any_of(others.begin(), others.end(), missing)) {
    return {{"estimate", nullptr}, {"low", nullptr}, {"high", nullptr}, {"n", values.size()}};
  }
  return difference_json(values, others, paired);
}

Json strategy_differences(const FirstScreen& screen, const std::vector<StudyOutcome>& outcomes) {
  const auto& series = screen.design.series;
  std::vector<Level> levels(series.size());
  for (std::size_t i = 0; i < screen.data.teams.size(); ++i) {
    const auto of = screen.design.cells[screen.design.cell_of_team[i]].series;
    levels[of][{composition_of(screen, i), screen.data.teams[i].address.replicate}] = i;
  }
  // Each is compared with teaching alone at the same setting, or with the first strategy there, or else with the first.
  const auto reference_of = [&](std::size_t s) {
    std::size_t first = s;
    for (std::size_t r = 0; r < series.size(); ++r) {
      if (series[r].variant != series[s].variant) continue;
      if (series[r].strategy == kBaseline) return r;
      first = std::min(first, r);
    }
    return first == s && num_together(screen) == 1 ? std::size_t{0} : first;
  };
  Json rows = Json::array();
  std::set<std::string> against;
  for (std::size_t s = 0; s < series.size(); ++s) {
    const auto reference = reference_of(s);
    if (reference == s) continue;
    against.insert(num_together(screen) == 1 && series[reference].strategy != kBaseline ? series[reference].code
                                                                                        : series[reference].strategy);
    Json differences = Json::array();
    const bool paired = screen.paired && series[reference].variant == series[s].variant;
    for (const auto& outcome : outcomes)
      differences.push_back(difference_of(screen, outcome, levels[s], levels[reference], paired));
    rows.push_back({{"code", series[s].code}, {"differences", std::move(differences)}});
  }
  if (rows.empty()) return nullptr;
  return {{"factor", "strategy"}, {"against", *against.begin()}, {"rows", std::move(rows)}};
}

Json composition_differences(const FirstScreen& screen, const std::vector<StudyOutcome>& outcomes) {
  std::vector<std::string> codes;
  for (const auto& cell : screen.design.cells) {
    if (std::find(codes.begin(), codes.end(), cell.composition) == codes.end()) codes.push_back(cell.composition);
  }
  // A group of people counts once, with its mean over strategies.
  const auto values_in = [&](const std::string& code, const StudyOutcome& outcome) {
    std::map<std::pair<std::size_t, std::size_t>, Values> people;
    for (std::size_t i = 0; i < screen.data.teams.size(); ++i) {
      const double value = outcome.of(screen.data.teams[i]);
      if (composition_of(screen, i) != code || !std::isfinite(value)) continue;
      if (is_alone(screen, i) && compares_with_alone(screen)) continue;
      const auto group = screen.paired ? screen.data.teams[i].address.replicate : i;
      people[{screen.paired ? series_of(screen, i).variant : 0, group}].push_back(value);
    }
    Values means;
    for (const auto& [key, values] : people) means.push_back(mean(values));
    return means;
  };
  Json rows = Json::array();
  for (std::size_t c = 1; c < codes.size(); ++c) {
    Json differences = Json::array();
    for (const auto& outcome : outcomes) {
      const auto values = values_in(codes[c], outcome), first = values_in(codes.front(), outcome);
      differences.push_back(values.empty() || first.empty()
                                ? Json{{"estimate", nullptr}, {"low", nullptr}, {"high", nullptr}, {"n", 0}}
                                : difference_json(values, first, false));
    }
    rows.push_back({{"code", codes[c]}, {"differences", std::move(differences)}});
  }
  if (rows.empty()) return nullptr;
  return {{"factor", "composition"}, {"against", codes.front()}, {"rows", std::move(rows)}};
}

}  // namespace

Json differences(const FirstScreen& screen) {
  const auto outcomes = outcomes_of(screen);
  Json groups = Json::array();
  for (auto group : {strategy_differences(screen, outcomes), composition_differences(screen, outcomes)}) {
    if (!group.is_null()) groups.push_back(std::move(group));
  }
  if (groups.empty()) return nullptr;
  Json names = Json::array();
  for (const auto& outcome : outcomes)
    names.push_back({{"name", capitalised(std::string{outcome.phrase})}, {"digits", outcome.digits}});
  return {{"interval", screen.paired ? "t intervals of differences within the same people" : "Welch's t intervals"},
          {"outcomes", std::move(names)},
          {"groups", std::move(groups)}};
}

}  // namespace kith::detail
