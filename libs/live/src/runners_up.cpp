#include "runners_up.hpp"

namespace kith {

std::vector<RunnerUp> runners_up(const Session& before, const Lesson& lesson, TeachingCache& cache, std::size_t n) {
  std::vector<RunnerUp> found;
  if (n == 0 || lesson.repeats || lesson.demonstrations.empty()) return found;
  const auto& team = before.belief();
  const bool is_known = !lesson.source.is_member() || team.options().members || team.num_members() == 1;
  if (!is_known) return found;
  const auto& belief =
      lesson.source.is_member() ? team.member(lesson.source.member) : team.aggregate(lesson.source.rule);
  const auto& options = before.options();
  const SelectionOptions selection{.counterfactuals = options.counterfactuals,
                                   .sampling = options.sampling,
                                   .likelihood = team.options().likelihood};
  VisitedStarts excluded{before.atlas().num_states()};
  for (const auto& past : before.history()) {
    for (const auto& shown : past.lesson.demonstrations) excluded.insert(shown.demo);
    for (const auto& test : past.lesson.tests) excluded.insert(test.demo);
  }
  excluded.insert(lesson.demonstrations.front().demo);
  const auto& component = before.atlas().knowledge_components()[lesson.component];
  const RandomStream random{lesson.period};
  while (found.size() < n) {
    auto unit = select_demonstrations(cache, belief, component, before.taught_region(), excluded, selection, random);
    if (unit.demonstrations.empty()) break;
    auto& first = unit.demonstrations.front();
    excluded.insert(first.demo);
    found.push_back({first.demo, first.gain, std::move(first.half_spaces)});
  }
  return found;
}

}  // namespace kith
