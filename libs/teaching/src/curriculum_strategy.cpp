#include "curriculum_strategy.hpp"

#include <array>

#include "kith/core/distributions.hpp"

namespace kith {
namespace {

const std::array kCurriculumParameters{
    Parameter{.name = "people",
              .default_value = std::int64_t{8},
              .description =
                  "people imagined from the prior to find out what a demonstration conveys, and as many from "
                  "the beliefs about the members",
              .min = 1,
              .max = 1000},
    Parameter{.name = "demonstrations",
              .default_value = std::int64_t{3},
              .description = "demonstrations per lesson; teacher.max_demonstrations takes precedence",
              .min = 1,
              .max = 100},
};

}  // namespace

std::span<const Parameter> curriculum_parameters() { return kCurriculumParameters; }

std::vector<StartIndex> CurriculumStrategy::candidates(const TeachingView& view) {
  const auto& component = view.atlas.knowledge_components()[view.component];
  std::vector<StartIndex> demos;
  for (StartIndex start{0}; start.value() < view.atlas.num_states(); ++start) {
    if (!view.atlas.is_candidate(start) || !component.uses_mdp[view.atlas.id(start).mdp.value()]) continue;
    if (!view.atlas.one_step(start).empty()) demos.push_back(start);
  }
  return demos;
}

UnitProposal CurriculumStrategy::propose(const TeachingView& view, UnitSelector& select, RandomStream random) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < view.belief.num_members(); ++i) {
    if (view.belief.present()[i]) order.push_back(i);
  }
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return view.tie_breaks[a] < view.tie_breaks[b]; });
  std::vector<const ParticleBelief*> beliefs;
  for (const auto i : order) beliefs.push_back(&view.belief.member(i));
  const auto drawn = random.split("people");
  auto of_prior = drawn.split("prior");
  const auto people =
      imagine_people(select.cache(), beliefs, {people_, people_}, uniform01(of_prior), drawn.split("beliefs"));
  const auto most = view.options.max_demonstrations > 0 ? view.options.max_demonstrations : demonstrations_;
  const auto ranked = ranking(view, random.split("ranking"));
  Unit unit;
  for (const bool again : {false, true}) {  // what was met already only if there is nothing else
    for (const auto start : ranked) {
      if (view.visited.contains(start) != again) continue;
      std::vector<StartIndex> demos;
      for (const auto& shown : unit.demonstrations) demos.push_back(shown.start);
      demos.push_back(start);
      unit = unit_of(select.cache(), view, demos, people);
      if (unit.demonstrations.size() == most) return {SourceBelief::of_everybody(), std::move(unit)};
    }
  }
  return {SourceBelief::of_everybody(), std::move(unit)};
}

}  // namespace kith
