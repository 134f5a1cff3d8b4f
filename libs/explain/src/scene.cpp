#include "scene.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "kith/bec/behaviours.hpp"
#include "kith/explain/words.hpp"
#include "walk.hpp"

namespace kith::detail {

std::string Scene::name_of(const Happening& happening) const {
  return happening.action ? "'" + action(*happening.action) + "'" : domain_.wording(happening.feature).one;
}

std::string Scene::spot() const {
  if (question_.state) return " in state '" + *question_.state + "'";
  return question_.cell ? " at " + cell_text(*map_, *question_.cell) : "";
}

std::string Scene::context() const {
  std::string text = spot();
  if (question_.carried) text += " carrying " + map_->item_names()[*question_.carried];
  if (question_.world) text += " in " + name_of(*question_.world);
  return text + condition();
}

std::string Scene::condition() const {
  std::string text;
  for (const auto& [present, thing, cell, place] : question_.conditions) {
    text += (text.empty() ? "" : " and") + std::string{present ? " with the " : " without the "} + thing +
            (cell ? " at " + cell_text(*map_, *cell) : "");
  }
  return text;
}

bool Scene::is_asked_about(MdpIndex world) const {
  const auto groups = domain_.optional_groups();
  const auto present = domain_.present_things(world);
  return std::ranges::all_of(question_.conditions, [&](const WorldCondition& condition) {
    bool is_there = false;
    for (std::size_t g = 0; g < groups.size(); ++g) {
      const bool is_meant = groups[g].name == condition.thing &&
                            (!condition.cell || std::ranges::count(groups[g].cells, *condition.cell) > 0);
      is_there = is_there || (present[g] && is_meant);
    }
    return is_there == condition.present;
  });
}

bool Scene::was_seen(StartIndex start) const {
  if (!domain_.inferred()) return true;
  const auto world = atlas_.id(start).mdp;
  const auto& unknown = domain_.inferred()->not_explained;
  return std::ranges::none_of(atlas_.trajectory(start).states, [&](StateIndex s) {
    return std::binary_search(unknown.begin(), unknown.end(), StartId{world, s});
  });
}

std::optional<StartIndex> Scene::start_in(MdpIndex world) const {
  const bool changes_worlds = question_.kind == Question::Kind::kWhatIf;
  if (!changes_worlds && !is_asked_about(world)) return std::nullopt;
  const auto start = place_in(world);
  return start && was_seen(*start) ? start : std::nullopt;
}

std::optional<StartIndex> Scene::place_in(MdpIndex world) const {
  const auto initial = domain_.initial_state(world);
  if (question_.state) return state_called(world, *question_.state);
  if (!question_.cell) return atlas_.index({world, initial});
  auto state = map_->state(world, initial);
  state.robot = *question_.cell;
  if (question_.carried) {
    const auto items = map_->items_in(world);
    const auto place = std::find(items.begin(), items.end(), *question_.carried);
    if (place == items.end()) return std::nullopt;
    const auto i = static_cast<std::size_t>(place - items.begin());
    state.items[i] = state.robot;
    state.carried[i] = true;
  }
  const auto& mdp = domain_.mdp(world);
  const auto found = map_->find_state(world, state);
  if (found && !mdp.is_terminal(*found)) return atlas_.index({world, *found});
  const auto fits = [&](StateIndex s) {
    if (mdp.is_terminal(s)) return false;
    const auto there = map_->state(world, s);
    return there.robot == state.robot && there.carried == state.carried;
  };
  const auto path = atlas_.trajectory(atlas_.index({world, initial}));
  const auto passed = std::find_if(path.states.begin(), path.states.end(), fits);
  if (passed != path.states.end()) return atlas_.index({world, *passed});
  for (StateIndex s{0}; s.value() < mdp.num_states(); ++s) {
    if (fits(s)) return atlas_.index({world, s});
  }
  return std::nullopt;
}

std::optional<StartIndex> Scene::state_called(MdpIndex world, const std::string& name) const {
  for (StateIndex s{0}; s.value() < domain_.mdp(world).num_states(); ++s) {
    if (domain_.state_name(world, s) == name) return atlas_.index({world, s});
  }
  return std::nullopt;
}

StartIndex Scene::needed_start(MdpIndex world) const {
  const auto start = start_in(world);
  if (start) return *start;
  const bool changes_worlds = question_.kind == Question::Kind::kWhatIf;
  if (!changes_worlds && !is_asked_about(world))
    fail(text_, question_.conditions.front().place, "E1108", "no world is like that", Remedy::kShowMap);
  if (place_in(world)) {
    fail(text_, question_.spot, "E1104",
         "nobody knows: the robot was not seen on all of its way from there in " + name_of(world) +
             ", or did what its weights do not explain",
         "ask about a place or a world in which it was seen, or run 'kith infer' with more of what it does");
  }
  if (question_.state) {
    fail(text_, question_.spot, "E1104", "the robot is never in state '" + *question_.state + "' in " + name_of(world),
         "name another world: 'in world N'");
  }
  fail(text_, question_.spot, "E1104",
       "the robot is never " +
           (question_.carried ? "carrying " + map_->item_names()[*question_.carried] + " " : std::string{}) + "at " +
           cell_text(*map_, *question_.cell) + " in " + name_of(world),
       "there may be a wall, or the episode ends there");
}

bool Scene::is_at(MdpIndex world, StateIndex s, ActionIndex a, const Happening& happening) const {
  if (happening.action) return *happening.action == a;
  const auto& mdp = domain_.mdp(world);
  const auto choices = mdp.choices(s);
  const auto choice = std::ranges::find(choices, a, &Choice::action);
  return choice != choices.end() && std::ranges::any_of(mdp.outcomes(*choice), [&](const Outcome& outcome) {
           return mdp.features(outcome)[happening.feature] != 0.0;
         });
}

std::optional<std::size_t> Scene::step_of(MdpIndex world, const Trajectory& path, const Happening& happening) const {
  const auto steps = question_.is_about_a_step() ? std::min<std::size_t>(1, path.actions.size()) : path.actions.size();
  for (std::size_t t = 0; t < steps; ++t) {
    if (is_at(world, path.states[t], path.actions[t], happening)) return t;
  }
  return std::nullopt;
}

std::optional<Contrast> Scene::contrast_to(StartIndex start_index, const Happening& happening, bool happens) const {
  const auto id = atlas_.id(start_index);
  const auto world = id.mdp;  // no structured binding, which clang 14 does not let a lambda capture
  const auto start = id.start;
  if (question_.is_about_a_step()) {
    return best_deviation(atlas_, start_index, 0, 1, [&](const Contrast& other) {
      return is_at(world, start, other.alternative.actions.front(), happening) == happens;
    });
  }
  const auto admits = [&](const Contrast& other) {
    if (domain_.is_exact() || happening.action)
      return step_of(world, other.alternative, happening).has_value() == happens;
    const auto more = other.alternative_counts[happening.feature] - other.robot_counts[happening.feature];
    return happens ? more > 0 : more < 0;
  };
  // Where chance has a part, a way on which it happens hardly less often would explain little.
  const auto is_clear = [&](const Contrast& other) {
    constexpr std::int64_t kOnceIn = 50;
    const auto robot = other.robot_counts[happening.feature];
    const auto there = other.alternative_counts[happening.feature];
    return admits(other) &&
           (happens ? there >= 2 * robot && kOnceIn * there >= domain_.count_scale() : 2 * there <= robot);
  };
  if (!domain_.is_exact() && !happening.action) {
    if (auto best = best_way(start_index, is_clear)) return best;
  }
  if (auto best = best_way(start_index, admits)) return best;
  if (!happening.action) {
    if (auto best = way_of_others(start_index, happening, happens)) return best;
  }
  return any_best_way(start_index, admits);
}

std::optional<double> Scene::chance_of(StartIndex start, const Happening& happening) const {
  constexpr std::size_t kMostStates = 20'000;
  constexpr std::size_t kMostSweeps = 10'000;
  constexpr double kAccuracy = 1e-9;
  const auto world = atlas_.id(start).mdp;
  const auto& mdp = domain_.mdp(world);
  // What the robot does in each state that it can reach.
  struct Visit {
    const Choice* choice = nullptr;
    double chance = 0.0;
  };
  std::map<StateIndex, Visit> visits;
  std::vector<StateIndex> open{atlas_.id(start).start};
  while (!open.empty()) {
    const auto s = open.back();
    open.pop_back();
    if (mdp.is_terminal(s) || visits.count(s) != 0) continue;
    if (visits.size() == kMostStates) return std::nullopt;
    const auto choices = mdp.choices(s);
    const auto choice = std::ranges::find(choices, atlas_.action(atlas_.index({world, s})), &Choice::action);
    visits[s].choice = &*choice;
    if (question_.is_about_a_step()) continue;
    for (const auto& outcome : mdp.outcomes(*choice)) open.push_back(outcome.next);
  }
  const auto happens_with = [&](const Choice& choice, const Outcome& outcome) {
    return happening.action ? *happening.action == choice.action : mdp.features(outcome)[happening.feature] != 0.0;
  };
  double change = 1.0;
  for (std::size_t sweep = 0; sweep < kMostSweeps && change > kAccuracy; ++sweep) {
    change = 0.0;
    for (auto& [s, visit] : visits) {
      double chance = 0.0;
      for (const auto& outcome : mdp.outcomes(*visit.choice)) {
        const auto next = visits.find(outcome.next);
        const double later = next == visits.end() ? 0.0 : next->second.chance;
        chance += outcome.probability * (happens_with(*visit.choice, outcome) ? 1.0 : later);
      }
      change = std::max(change, std::abs(chance - visit.chance));
      visit.chance = chance;
    }
  }
  return visits.at(atlas_.id(start).start).chance;
}

namespace {

// What a feature may be worth to others, ever farther from what it is worth to the robot: a cost that falls to
// nothing or a gain that grows, or the other way round, until it outweighs everything.
std::vector<double> other_weights(double own, bool more) {
  constexpr int kSteps = 10;
  std::vector<double> weights;
  for (int i = 1; i <= kSteps; ++i) {
    const double change = (more ? 0.125 : -0.125) * std::ldexp(1.0, i);
    weights.push_back(more && own < 0.0 ? own * (1.0 - static_cast<double>(i) / kSteps) : own + change);
  }
  return weights;
}

}  // namespace

std::optional<Contrast> Scene::way_of_others(StartIndex start, const Happening& happening, bool happens) const {
  if (atlas_.find_tables() || !domain_.is_exact()) return std::nullopt;
  const Behaviours behaviours{atlas_};
  const auto world = atlas_.id(start).mdp;
  const auto& mdp = domain_.mdp(world);
  const auto k = happening.feature;
  for (const double weight : other_weights(domain_.weights().unit[static_cast<Eigen::Index>(k)], happens)) {
    Direction weights = domain_.weights().unit;
    weights[static_cast<Eigen::Index>(k)] = weight;
    auto path = behaviours.trajectory(start, weights.normalized());
    if (!path || !mdp.is_terminal(path->states.back())) return std::nullopt;  // beyond here they would never end
    Contrast result;
    result.start = start;
    result.robot = atlas_.trajectory(start);
    result.robot_counts = atlas_.feature_counts(start);
    result.alternative_counts = IntegerVector(domain_.num_features());
    for (std::size_t t = 0; t < path->actions.size(); ++t) {
      result.alternative_counts += mdp.integer_features(*step_by(mdp, path->states[t], path->actions[t]));
    }
    const auto more = result.alternative_counts[k] - result.robot_counts[k];
    if (happens ? more <= 0 : more >= 0) continue;
    const auto parting = std::ranges::mismatch(result.robot.actions, path->actions).in1;
    result.decisive = static_cast<std::size_t>(parting - result.robot.actions.begin());
    result.alternative = *std::move(path);
    return result;
  }
  return std::nullopt;
}

std::string Scene::name_of(MdpIndex world) const { return world_text(domain_, world); }

std::string Scene::spot_text(MdpIndex world, StateIndex s) const {
  return map_ ? "at " + cell_text(*map_, map_->state(world, s).robot)
              : "in state '" + domain_.state_name(world, s) + "'";
}

std::string Scene::place_text(StartIndex start_index) const {
  const auto [world, start] = atlas_.id(start_index);
  return spot_text(world, start) + " in " + name_of(world);
}

void Scene::check_possible(StartIndex start_index, const Happening& happening) const {
  const auto [world, start] = atlas_.id(start_index);
  for (const auto& choice : domain_.mdp(world).choices(start)) {
    if (is_at(world, start, choice.action, happening)) return;
  }
  fail(text_, happening.place, "E1107", name_of(happening) + " is not possible " + place_text(start_index),
       "it would change nothing there, or is not allowed");
}

std::optional<Contrast> Scene::best_step(StartIndex start) const {
  auto best = best_deviation(atlas_, start, 0, 1, [&](const Contrast& other) { return !is_detour(domain_, other); });
  return best ? best : best_deviation(atlas_, start, 0, 1, [](const Contrast&) { return true; });
}

}  // namespace kith::detail
