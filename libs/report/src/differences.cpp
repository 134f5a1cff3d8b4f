#include <algorithm>
#include <set>

#include "kith/teaching/strategy.hpp"
#include "outcomes.hpp"
#include "sentences.hpp"

namespace kith::detail {
namespace {

Json difference_json(const TeamValues& values, const TeamValues& reference, bool same_people) {
  const auto [n, estimate, test] = difference_of_teams(values, reference, same_people);
  return {{"estimate", number(estimate)},
          {"low", test ? number(test->low) : Json{}},
          {"high", test ? number(test->high) : Json{}},
          {"n", n}};
}

Json strategy_differences(const FirstScreen& screen, const std::vector<StudyOutcome>& outcomes) {
  const auto& series = screen.design.series;
  const auto values_of = [&](std::size_t s, const StudyOutcome& outcome) {
    return by_people(screen, outcome, [&](std::size_t i) { return &series_of(screen, i) == &series[s]; });
  };
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
      differences.push_back(difference_json(values_of(s, outcome), values_of(reference, outcome), paired));
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
    return by_people(screen, outcome, [&](std::size_t i) {
      return composition_of(screen, i) == code && !(is_alone(screen, i) && compares_with_alone(screen));
    });
  };
  Json rows = Json::array();
  for (std::size_t c = 1; c < codes.size(); ++c) {
    Json differences = Json::array();
    for (const auto& outcome : outcomes)
      differences.push_back(difference_json(values_in(codes[c], outcome), values_in(codes.front(), outcome), false));
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
  const bool paired = screen.paired && (num_together(screen) > 1 || compares_with_alone(screen));
  return {{"interval", paired ? "t intervals of differences within the same people" : "Welch's t intervals"},
          {"outcomes", std::move(names)},
          {"groups", std::move(groups)}};
}

}  // namespace kith::detail
