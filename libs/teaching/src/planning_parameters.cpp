#include "planning_parameters.hpp"

#include <algorithm>
#include <array>
#include <numeric>

#include "kith/teaching/team_bank.hpp"
#include "whole_components.hpp"

namespace kith {
namespace {

constexpr double kAbilityMax = 0.95;
// U is a share of tests, which are spread over the constraints of a component: of more constraints each adds less.
constexpr double kConstraintsOfGain = 4.0;
constexpr std::size_t kFewestFeatures = 3;

const std::array kParameters{
    Parameter{.name = "people",
              .default_value = std::int64_t{16},
              .description = "people imagined from the prior to find out what a demonstration can convey, and as many "
                             "from the beliefs about the members",
              .min = 1,
              .max = 1000},
    Parameter{.name = "points",
              .default_value = std::int64_t{250},
              .description = "points drawn from the belief about each member to judge a unit by",
              .min = 1,
              .max = 100'000},
    Parameter{.name = "expected_gain",
              .default_value = 0.0325,
              .description = "gain of ability by the time of the feedback that is expected of everybody",
              .max = 0.5},
    Parameter{.name = "demonstrations",
              .default_value = std::int64_t{0},
              .description =
                  "demonstrations per lesson at most, 0: as many as the domain has features, at least three; "
                  "teacher.max_demonstrations takes precedence",
              .max = 100},
    Parameter{.name = "capacity",
              .default_value = std::int64_t{0},
              .description = "different constraints of a lesson that members are assumed to take in; 0: all",
              .max = 1000},
    Parameter{.name = "min_gain",
              .default_value = 0.005,
              .description = "a further demonstration is added to a lesson only if it raises U by more than this; in "
                             "proportion less for a component with more than four constraints"},
};

// What is best for people who imitate harms all others, and what is best on average is nearly that, as imitators have
// so much more at stake: of the two sorts only the likelier is left.
void leave_likelier_sort(std::vector<MemberHypothesis>& hypotheses) {
  const auto imitates = [](const MemberHypothesis& one) { return one.imitation.probability > 0.0; };
  double imitators = 0.0;
  for (const auto& one : hypotheses) imitators += imitates(one) ? one.weight : 0.0;
  const bool left = imitators > 0.5;
  for (auto& one : hypotheses) {
    one.weight = imitates(one) == left ? one.weight / (left ? imitators : 1.0 - imitators) : 0.0;
  }
}

}  // namespace

Lookahead::Lookahead(const ParameterValues& values)
    : people{static_cast<std::size_t>(values.count("people"))},
      points{static_cast<std::size_t>(values.count("points"))},
      expected_gain{values.real("expected_gain")},
      plan{.max_demonstrations = static_cast<std::size_t>(values.count("demonstrations")),
           .min_gain = values.real("min_gain"),
           .capacity = static_cast<std::size_t>(values.count("capacity"))} {}

std::span<const Parameter> Lookahead::parameters() { return kParameters; }

PlanOptions Lookahead::plan_for(const TeachingView& view) const {
  auto options = plan;
  const auto& component = view.atlas.knowledge_components()[view.component];
  const auto constraints = static_cast<double>(component.constraints.count());
  options.min_gain *= kConstraintsOfGain / std::max(constraints, kConstraintsOfGain);
  if (options.max_demonstrations == 0) {
    options.max_demonstrations = std::max(view.atlas.domain().num_features(), kFewestFeatures);
  }
  if (view.options.max_demonstrations > 0) options.max_demonstrations = view.options.max_demonstrations;
  return options;
}

std::vector<std::vector<MemberHypothesis>> Lookahead::believed(const TeachingView& view) const {
  const double ability = view.options.assumed_ability;
  const double after = std::max(ability, std::min(ability + expected_gain, kAbilityMax));
  std::vector<std::vector<MemberHypothesis>> members(view.belief.num_members());
  for (std::size_t i = 0; i < members.size(); ++i) {
    if (view.belief.present()[i]) members[i].push_back({1.0, &view.belief.member(i), ability, after});
  }
  return members;
}

std::vector<std::vector<MemberHypothesis>> Lookahead::mixed(const TeachingView& view, double answers,
                                                            Weighing weighing) {
  std::vector<std::vector<MemberHypothesis>> members(view.bank->size());
  for (std::size_t i = 0; i < members.size(); ++i) {
    if (!view.belief.present()[i]) continue;
    const auto& bank = view.bank->member(i);
    MemberHypothesis mean{answers, &view.bank->informed(i), 0.0, 0.0};
    const auto beforehand = bank.weights_beforehand();
    double temperature = 0.0;  // summed over the answers that are imitations
    auto hypotheses = bank.as_members(view.bank->begins(view.component));
    if (weighing == Weighing::kPosterior) leave_likelier_sort(hypotheses);
    for (std::size_t h = 0; h < hypotheses.size(); ++h) {
      auto& one = hypotheses[h];
      if (weighing == Weighing::kBeforehand) one.weight = beforehand[h];
      mean.shown_ability += one.weight * one.shown_ability;
      mean.feedback_ability += one.weight * one.feedback_ability;
      mean.imitation.probability += one.weight * one.imitation.probability;
      temperature += one.weight * one.imitation.probability * one.imitation.temperature;
      one.weight *= 1.0 - answers;
      members[i].push_back(one);
    }
    if (mean.imitation.probability > 0.0) mean.imitation.temperature = temperature / mean.imitation.probability;
    members[i].push_back(mean);
  }
  return members;
}

UnitValue Lookahead::value(TeachingCache& cache, const TeachingView& view,
                           std::span<const std::vector<MemberHypothesis>> members, RandomStream random) const {
  return UnitValue{cache,
                   view.component,
                   members,
                   view.tie_breaks,
                   {.objective = view.options.objective, .likelihood = view.options.likelihood, .points = points},
                   random};
}

Unit Lookahead::best_unit(TeachingCache& cache, const TeachingView& view,
                          std::span<const std::vector<MemberHypothesis>> members, RandomStream random) const {
  auto units = value(cache, view, members, random.split("points"));
  std::vector<std::size_t> order(members.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return view.tie_breaks[a] < view.tie_breaks[b]; });
  std::vector<const ParticleBelief*> beliefs;  // of every member the likeliest
  for (const auto i : order) {
    const auto likeliest = std::max_element(members[i].begin(), members[i].end(),
                                            [](const auto& a, const auto& b) { return a.weight < b.weight; });
    if (likeliest != members[i].end()) beliefs.push_back(likeliest->belief);
  }
  auto imagined = imagine_people(cache, beliefs, people, random.split("people"));
  const auto& atlas = cache.atlas();
  if (teaches_whole_components(atlas)) {
    const auto& facets = atlas.knowledge_components()[view.component].constraints;
    imagine_near_misses(cache, facets | atlas.prior(), facets, kMiss, imagined);
  }
  return plan_unit(cache, view, units, imagined, plan_for(view), random.split("looks"));
}

}  // namespace kith
