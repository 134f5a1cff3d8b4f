#include "scene.hpp"

#include <algorithm>

#include "kith/explain/words.hpp"
#include "walk.hpp"

namespace kith::detail {

std::string Scene::name_of(const Happening& happening) const {
  return happening.action ? "'" + action(*happening.action) + "'" : domain_.wording(happening.feature).one;
}

std::string Scene::context() const {
  std::string text;
  if (question_.cell) text += " at " + cell_text(domain_, *question_.cell);
  if (question_.carried) text += " carrying " + domain_.item_names()[*question_.carried];
  if (question_.world) text += " in world " + std::to_string(question_.world->value());
  return text;
}

std::optional<DemoIndex> Scene::start_in(MdpIndex world) const {
  const auto initial = domain_.initial_state(world);
  if (!question_.cell) return atlas_.index({world, initial});
  auto state = domain_.state(world, initial);
  state.robot = *question_.cell;
  if (question_.carried) {
    const auto items = domain_.items_in(world);
    const auto place = std::find(items.begin(), items.end(), *question_.carried);
    if (place == items.end()) return std::nullopt;
    const auto i = static_cast<std::size_t>(place - items.begin());
    state.items[i] = state.robot;
    state.carried[i] = true;
  }
  const auto& mdp = domain_.mdp(world);
  const auto found = domain_.find_state(world, state);
  if (found && !mdp.is_terminal(*found)) return atlas_.index({world, *found});
  const auto fits = [&](StateIndex s) {
    if (mdp.is_terminal(s)) return false;
    const auto there = domain_.state(world, s);
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

DemoIndex Scene::needed_start(MdpIndex world) const {
  const auto start = start_in(world);
  if (start) return *start;
  fail(text_, question_.cell_place, "E1104",
       "the robot is never " +
           (question_.carried ? "carrying " + domain_.item_names()[*question_.carried] + " " : std::string{}) + "at " +
           cell_text(domain_, *question_.cell) + " in world " + std::to_string(world.value()),
       "a wall may stand there, or the episode end there");
}

bool Scene::is_at(MdpIndex world, StateIndex s, ActionIndex a, const Happening& happening) const {
  if (happening.action) return *happening.action == a;
  const auto& mdp = domain_.mdp(world);
  const auto step = step_by(mdp, s, a);
  return step && mdp.integer_features(*step)[happening.feature] != 0;
}

std::optional<std::size_t> Scene::step_of(MdpIndex world, const Trajectory& path, const Happening& happening) const {
  const auto steps = question_.cell ? std::min<std::size_t>(1, path.actions.size()) : path.actions.size();
  for (std::size_t t = 0; t < steps; ++t) {
    if (is_at(world, path.states[t], path.actions[t], happening)) return t;
  }
  return std::nullopt;
}

std::optional<Contrast> Scene::deviation(DemoIndex demo, ActionIndex a) const {
  const auto [world, start] = atlas_.id(demo);
  const auto& mdp = domain_.mdp(world);
  const auto step = step_by(mdp, start, a);
  if (!step) return std::nullopt;
  Contrast contrast;
  contrast.demo = demo;
  contrast.robot = atlas_.trajectory(demo);
  contrast.robot_counts = atlas_.feature_counts(demo);
  contrast.alternative = {{start}, {a}};
  contrast.alternative_counts = mdp.integer_features(*step);
  if (mdp.is_terminal(step->next)) {
    contrast.alternative.states.push_back(step->next);
    return contrast;
  }
  const auto next = atlas_.index({world, step->next});
  const auto rest = atlas_.trajectory(next);
  contrast.alternative_counts += atlas_.feature_counts(next);
  contrast.alternative.states.insert(contrast.alternative.states.end(), rest.states.begin(), rest.states.end());
  contrast.alternative.actions.insert(contrast.alternative.actions.end(), rest.actions.begin(), rest.actions.end());
  return contrast;
}

std::optional<Contrast> Scene::contrast_to(DemoIndex demo, const Happening& happening, bool happens) const {
  const auto [world, start] = atlas_.id(demo);
  if (!question_.cell) {
    return best_contrast(atlas_, demo, [&](const Contrast& contrast) {
      return step_of(world, contrast.alternative, happening).has_value() == happens;
    });
  }
  std::optional<Contrast> best;
  const auto& weights = domain_.weights().integer;
  const auto own = atlas_.trajectory(demo).actions.front();
  for (const auto& choice : domain_.mdp(world).choices(start)) {
    if (choice.action == own || is_at(world, start, choice.action, happening) != happens) continue;
    auto other = deviation(demo, choice.action);
    const bool better = !best || dot(weights, other->alternative_counts) > dot(weights, best->alternative_counts);
    if (better) best = std::move(other);
  }
  return best;
}

std::string Scene::place_text(DemoIndex demo) const {
  return "at " + cell_text(domain_, domain_.state(atlas_.id(demo).mdp, atlas_.id(demo).start).robot) + " in world " +
         std::to_string(atlas_.id(demo).mdp.value());
}

void Scene::check_possible(DemoIndex demo, const Happening& happening) const {
  const auto [world, start] = atlas_.id(demo);
  for (const auto& choice : domain_.mdp(world).choices(start)) {
    if (is_at(world, start, choice.action, happening)) return;
  }
  fail(text_, happening.place, "E1107", name_of(happening) + " is not possible " + place_text(demo),
       "it would change nothing, or is forbidden");
}

std::optional<Contrast> Scene::best_deviation(DemoIndex demo) const {
  const auto [world, start] = atlas_.id(demo);
  const auto own = atlas_.trajectory(demo).actions.front();
  std::optional<Contrast> best;
  const auto& weights = domain_.weights().integer;
  for (const auto& choice : domain_.mdp(world).choices(start)) {
    if (choice.action == own) continue;
    auto other = deviation(demo, choice.action);
    if (!best || dot(weights, other->alternative_counts) > dot(weights, best->alternative_counts)) {
      best = std::move(other);
    }
  }
  return best;
}

}  // namespace kith::detail
