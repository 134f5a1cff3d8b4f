// What is told of a policy beside the weights that explain it.
#include <algorithm>
#include <optional>

#include "policy_fit.hpp"
#include "robot_plan.hpp"

namespace kith::detail {
namespace {

constexpr std::size_t kMostClashes = 3;

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

void describe_sides(const ShownRegion& shown, WeightInference& result) {
  for (const HalfSpace& facet : shown.region.facets()) result.sides.push_back({facet, shown.support_of(facet)});
  std::stable_sort(result.sides.begin(), result.sides.end(),
                   [](const RegionSide& a, const RegionSide& b) { return a.support < b.support; });
}

void describe_clashes(const PolicyFit& fit, const Look& look, const ShownRegion& shown, WeightInference& result) {
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
    std::vector<HalfSpace> all{shown.region.facets().begin(), shown.region.facets().end()};
    all.push_back(wanted.front());
    auto conflict = irreducible_conflict(all);
    if (conflict.empty()) continue;
    std::rotate(conflict.begin(), std::find(conflict.begin(), conflict.end(), wanted.front()), conflict.end());
    Clash clash{{one.state}, conflict};
    for (const HalfSpace& half_space : conflict) {
      const auto at = shown.shown_by.find(half_space);
      if (at != shown.shown_by.end() && std::ranges::count(clash.states, *at->second.begin()) == 0)
        clash.states.push_back(*at->second.begin());
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

// Adds all states from which there is a way to one of them.
void spread(const std::vector<std::vector<std::uint32_t>>& into, std::vector<std::uint32_t> queue,
            std::vector<bool>& is_out) {
  for (const auto s : queue) is_out[s] = true;
  while (!queue.empty()) {
    const auto s = queue.back();
    queue.pop_back();
    for (const std::uint32_t from : into[s]) {
      if (!is_out[from]) queue.push_back(from);
      is_out[from] = true;
    }
  }
}

// From the states that are not explained back to all from which the robot, or what is best, most likely comes there:
// these are the paths that are shown. From those in which it was not seen back to all from which it may come there:
// nobody knows what that counts.
std::vector<StartId> left_out(const PolicyFit& fit, const Look& look, const std::vector<StartId>& not_explained) {
  std::vector<StartId> result;
  for (std::size_t m = 0; m < fit.domain().num_mdps(); ++m) {
    const auto& mdp = fit.mdp(m);
    const auto& best = look.plans[m].choice;
    auto own = fit.likeliest(m);
    for (std::size_t s = 0; s < own.size(); ++s) own[s] = own[s] == kNoChoice ? best[s] : own[s];
    std::vector<std::vector<std::uint32_t>> into(own.size()), perhaps_into(own.size());
    std::vector<std::uint32_t> odd, unseen;
    for (const auto& next : {likeliest_next(mdp, own), likeliest_next(mdp, best)}) {
      for (std::uint32_t s = 0; s < next.size(); ++s) {
        if (next[s] < into.size()) into[next[s]].push_back(s);
      }
    }
    for (std::uint32_t s = 0; s < own.size(); ++s) {
      for (const auto choice : {own[s], best[s]}) {
        for (const Outcome& outcome : mdp.outcomes(mdp.choices(StateIndex{s})[choice])) {
          if (outcome.next.value() < own.size()) perhaps_into[outcome.next.value()].push_back(s);
        }
      }
    }
    for (const StartId& id : not_explained) {
      if (id.mdp.value() == m)
        (fit.is_seen(m, id.start.value()) ? odd : unseen).push_back(static_cast<std::uint32_t>(id.start.value()));
    }
    std::vector<bool> is_out(own.size(), false);
    spread(perhaps_into, unseen, is_out);
    std::vector<bool> is_odd(own.size(), false);
    spread(into, odd, is_odd);
    for (const StateIndex start : fit.domain().starts(MdpIndex{m})) {
      if (is_out[start.value()] || is_odd[start.value()]) result.push_back({MdpIndex{m}, start});
    }
  }
  return result;
}

}  // namespace

void describe_fit(const PolicyFit& fit, const Look& look, const ShownRegion& shown, WeightInference& result) {
  result.share = look.share;
  result.loss = look.loss;
  result.num_seen = fit.num_seen();
  result.unexplained = unexplained_states(fit, look);
  describe_sides(shown, result);
  describe_clashes(fit, look, shown, result);
  result.not_explained = not_explained(fit, look);
  result.left_out = left_out(fit, look, result.not_explained);
}

}  // namespace kith::detail
