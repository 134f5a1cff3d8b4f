// What is told of a policy beside the weights that explain it.
#include <algorithm>
#include <optional>
#include <set>
#include <unordered_map>
#include <utility>

#include "policy_fit.hpp"
#include "robot_plan.hpp"

namespace kith::detail {
namespace {

constexpr std::size_t kMostClashes = 3;

using ShownBy = std::unordered_map<HalfSpace, StartId>;  // a state that shows a side of the region

std::vector<UnexplainedState> unexplained_states(const PolicyFit& fit, const Look& look) {
  std::vector<UnexplainedState> result;
  const auto w = at_length_1(look.weights);
  for (std::size_t m = 0; m < fit.domain().num_mdps(); ++m) {
    for (std::size_t s = 0; s < fit.likeliest(m).size(); ++s) {
      if (!fit.is_seen(m, s) || fit.is_explained(look, m, s)) continue;
      const auto choices = fit.mdp(m).choices(StateIndex{s});
      UnexplainedState one{{MdpIndex{m}, StateIndex{s}}, std::nullopt, choices[look.plans[m].choice[s]].action, 0.0};
      if (fit.likeliest(m)[s] != kNoChoice) {
        one.does = choices[fit.likeliest(m)[s]].action;
        one.loss = look.plans[m].values[s] - fit.worth(look, m, w, choices[fit.likeliest(m)[s]]);
      }
      result.push_back(one);
    }
  }
  return result;
}

ShownBy describe_sides(const PolicyFit& fit, const Look& look, const Cone& region, WeightInference& result) {
  ShownBy shown_by;
  for (const HalfSpace& facet : region.facets()) result.sides.push_back({facet, 0});
  std::unordered_map<HalfSpace, std::size_t> place;
  for (std::size_t i = 0; i < result.sides.size(); ++i) place.emplace(result.sides[i].half_space, i);
  for (std::size_t m = 0; m < fit.domain().num_mdps(); ++m) {
    for (std::size_t s = 0; s < fit.likeliest(m).size(); ++s) {
      if (!fit.is_explained(look, m, s)) continue;
      std::set<std::size_t> shown;
      for (const HalfSpace& half_space : fit.demands(m, s, look.plans[m].counts, fit.likeliest(m)[s])) {
        if (const auto at = place.find(half_space); at != place.end()) shown.insert(at->second);
      }
      for (const std::size_t i : shown) {
        ++result.sides[i].support;
        shown_by.try_emplace(result.sides[i].half_space, StartId{MdpIndex{m}, StateIndex{s}});
      }
    }
  }
  std::stable_sort(result.sides.begin(), result.sides.end(),
                   [](const RegionSide& a, const RegionSide& b) { return a.support < b.support; });
  return shown_by;
}

void describe_clashes(const PolicyFit& fit, const Look& look, const Cone& region, const ShownBy& shown_by,
                      WeightInference& result) {
  auto worst = result.unexplained;
  std::stable_sort(worst.begin(), worst.end(),
                   [](const UnexplainedState& a, const UnexplainedState& b) { return a.loss > b.loss; });
  for (const UnexplainedState& one : worst) {
    if (!one.does || result.clashes.size() >= kMostClashes) break;
    const auto m = one.state.mdp.value();
    const auto s = one.state.start.value();
    std::vector<HalfSpace> wanted;
    for (const HalfSpace& half_space : fit.demands(m, s, look.plans[m].counts, fit.likeliest(m)[s])) {
      if (margin_of(half_space, look.weights) < 0.0) wanted.push_back(half_space);
    }
    if (wanted.empty()) continue;
    std::vector<HalfSpace> all{region.facets().begin(), region.facets().end()};
    all.push_back(wanted.front());
    auto conflict = irreducible_conflict(all);
    if (conflict.empty()) continue;
    std::rotate(conflict.begin(), std::find(conflict.begin(), conflict.end(), wanted.front()), conflict.end());
    Clash clash{{one.state}, conflict};
    for (const HalfSpace& half_space : conflict) {
      const auto at = shown_by.find(half_space);
      if (at == shown_by.end()) continue;
      if (std::find(clash.states.begin(), clash.states.end(), at->second) == clash.states.end())
        clash.states.push_back(at->second);
    }
    result.clashes.push_back(std::move(clash));
  }
}

std::vector<StartId> not_explained(const PolicyFit& fit, const Look& look) {
  std::vector<StartId> result;
  for (std::size_t m = 0; m < fit.domain().num_mdps(); ++m) {
    for (std::size_t s = 0; s < fit.likeliest(m).size(); ++s) {
      if (!fit.is_explained(look, m, s)) result.push_back({MdpIndex{m}, StateIndex{s}});
    }
  }
  return result;
}

// From the states that are not explained or not seen back to all from which the robot, or what is best, most likely
// comes there: these are the paths that are shown.
std::vector<StartId> left_out(const PolicyFit& fit, const Look& look, const std::vector<StartId>& not_explained) {
  std::vector<StartId> result;
  for (std::size_t m = 0; m < fit.domain().num_mdps(); ++m) {
    const auto& best = look.plans[m].choice;
    auto own = fit.likeliest(m);
    for (std::size_t s = 0; s < own.size(); ++s) own[s] = own[s] == kNoChoice ? best[s] : own[s];
    std::vector<std::vector<std::uint32_t>> into(own.size());
    for (const auto& next : {likeliest_next(fit.mdp(m), own), likeliest_next(fit.mdp(m), best)}) {
      for (std::uint32_t s = 0; s < next.size(); ++s) {
        if (next[s] < into.size()) into[next[s]].push_back(s);
      }
    }
    std::vector<bool> is_out(own.size(), false);
    std::vector<std::uint32_t> queue;
    for (const StartId& id : not_explained) {
      if (id.mdp.value() != m) continue;
      is_out[id.start.value()] = true;
      queue.push_back(static_cast<std::uint32_t>(id.start.value()));
    }
    while (!queue.empty()) {
      const auto s = queue.back();
      queue.pop_back();
      for (const std::uint32_t from : into[s]) {
        if (is_out[from]) continue;
        is_out[from] = true;
        queue.push_back(from);
      }
    }
    for (const StateIndex start : fit.domain().starts(MdpIndex{m})) {
      if (is_out[start.value()]) result.push_back({MdpIndex{m}, start});
    }
  }
  return result;
}

}  // namespace

void describe_fit(const PolicyFit& fit, const Look& look, const Cone& region, WeightInference& result) {
  result.share = look.share;
  result.loss = look.loss;
  result.num_seen = fit.num_seen();
  result.unexplained = unexplained_states(fit, look);
  const ShownBy shown_by = describe_sides(fit, look, region, result);
  describe_clashes(fit, look, region, shown_by, result);
  result.not_explained = not_explained(fit, look);
  result.left_out = left_out(fit, look, result.not_explained);
}

}  // namespace kith::detail
