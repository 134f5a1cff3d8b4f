#include "deviation.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace kith::detail {
namespace {

// Expected counts of a choice and what the robot does afterwards, in units of 1 / Domain::count_scale().
IntegerVector counts_of(const Atlas& atlas, MdpIndex world, const Choice& choice) {
  const auto& domain = atlas.domain();
  const auto& mdp = domain.mdp(world);
  const auto rest = [&](const Outcome& outcome) {
    if (mdp.is_terminal(outcome.next)) return IntegerVector(mdp.num_features());
    return atlas.feature_counts(atlas.index({world, outcome.next}));
  };
  const auto outcomes = mdp.outcomes(choice);
  if (domain.is_exact()) return mdp.integer_features(outcomes.front()) + rest(outcomes.front());
  const auto scale = static_cast<double>(domain.count_scale());
  std::array<double, IntegerVector::kMaxDimension> sum{};
  for (const Outcome& outcome : outcomes) {
    const auto features = mdp.features(outcome);
    const auto after = rest(outcome);
    for (std::size_t k = 0; k < features.size(); ++k) {
      sum[k] += outcome.probability * (features[k] * scale + mdp.discount() * static_cast<double>(after[k]));
    }
  }
  IntegerVector counts(mdp.num_features());
  for (std::size_t k = 0; k < counts.size(); ++k) counts[k] = std::llround(sum[k]);
  return counts;
}

}  // namespace

std::optional<Contrast> deviation(const Atlas& atlas, DemoIndex demo, std::size_t at, ActionIndex action) {
  const auto world = atlas.id(demo).mdp;
  const auto& mdp = atlas.domain().mdp(world);
  Contrast result;
  result.demo = demo;
  result.robot = atlas.trajectory(demo);
  result.robot_counts = atlas.feature_counts(demo);
  result.decisive = at;
  const auto s = result.robot.states.at(at);
  const auto choices = mdp.choices(s);
  const auto choice = std::ranges::find(choices, action, &Choice::action);
  if (choice == choices.end()) return std::nullopt;

  const auto there = atlas.index({world, s});
  result.alternative_counts = result.robot_counts - atlas.feature_counts(there) + counts_of(atlas, world, *choice);
  auto& path = result.alternative;
  const auto steps = static_cast<std::ptrdiff_t>(at);
  path.states.assign(result.robot.states.begin(), result.robot.states.begin() + steps + 1);
  path.actions.assign(result.robot.actions.begin(), result.robot.actions.begin() + steps);
  path.actions.push_back(action);
  const auto likeliest = std::ranges::max(mdp.outcomes(*choice), {}, &Outcome::probability).next;
  if (mdp.is_terminal(likeliest)) {
    path.states.push_back(likeliest);
    return result;
  }
  const auto rest = atlas.trajectory(atlas.index({world, likeliest}));
  path.states.insert(path.states.end(), rest.states.begin(), rest.states.end());
  path.actions.insert(path.actions.end(), rest.actions.begin(), rest.actions.end());
  return result;
}

}  // namespace kith::detail
