#include "runners_up.hpp"

#include <algorithm>

namespace kith {
namespace {

// The belief that a lesson was chosen for; null if it was chosen for all of them, or that one is not kept.
const ParticleBelief* find(const TeamBelief& team, const SourceBelief& source) {
  const bool is_one = team.num_members() == 1;
  if (source.is_member()) return is_one || team.options().members ? &team.member(source.member) : nullptr;
  const auto& rules = team.options().rules;
  const auto is_kept = [&](const AggregationRule& rule) { return rule.name == source.rule; };
  return std::any_of(rules.begin(), rules.end(), is_kept) ? &team.aggregate(source.rule) : nullptr;
}

}  // namespace

std::vector<RunnerUp> runners_up(const Session& before, const Lesson& lesson, TeachingCache& cache, std::size_t n) {
  std::vector<RunnerUp> found;
  if (n == 0 || lesson.repeats || lesson.demonstrations.empty()) return found;
  const auto& team = before.belief();
  const auto* belief = find(team, lesson.source);
  if (belief == nullptr) return found;
  const auto& options = before.options();
  const SelectionOptions selection{.counterfactuals = options.counterfactuals,
                                   .sampling = options.sampling,
                                   .likelihood = team.options().likelihood};
  VisitedStarts excluded{before.atlas().num_states()};
  for (const auto& past : before.history()) {
    for (const auto& shown : past.lesson.demonstrations) excluded.insert(shown.start);
    for (const auto& test : past.lesson.tests) excluded.insert(test.start);
  }
  excluded.insert(lesson.demonstrations.front().start);
  const auto& component = before.atlas().knowledge_components()[lesson.component];
  const RandomStream random{lesson.period};
  while (found.size() < n) {
    auto unit = select_demonstrations(cache, *belief, component, before.taught_region(), excluded, selection, random);
    if (unit.demonstrations.empty()) break;
    auto& first = unit.demonstrations.front();
    excluded.insert(first.start);
    found.push_back({first.start, first.gain, std::move(first.half_spaces)});
  }
  return found;
}

}  // namespace kith
