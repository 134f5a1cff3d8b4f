// What if the world were different?
#include "answerer.hpp"

#include <algorithm>
#include <set>
#include <vector>

#include "kith/explain/words.hpp"

namespace kith::detail {

void Answerer::what_if() {
  const bool removes = std::any_of(question_.conditions.begin(), question_.conditions.end(),
                                   [](const auto& condition) { return !condition.present; });
  auto base = question_.world ? *question_.world : world_to_change(removes);
  auto world = world_with(base);
  std::string elsewhere;
  if (!question_.world && !question_.is_about_a_step()) {
    const auto effects = worlds_it_matters_in(base, world);
    elsewhere = effects.matters == 0 ? "; nor does it in any other world" +
                                           std::string{domain_.inferred() ? " in which it was seen" : ""}
                                     : " (it changes the path in " + worlds_text(effects.matters, effects.tried) + ")";
    if (effects.matters > 0) {
      base = effects.base;
      world = effects.world;
    }
  }
  const auto changed = difference_in_words(domain_, world, toggled_groups(domain_, base, world));
  reply_.question = "What happens in " + scene_.name_of(base) + " " + changed + scene_.spot() + "?";
  const auto before = scene_.needed_start(base);
  const auto after = scene_.needed_start(world);
  const auto old_path = atlas_.trajectory(before);
  const auto new_path = atlas_.trajectory(after);
  const auto description = [&](MdpIndex m, const Trajectory& path) {
    return scene_.name_of(m) + ": " + actions_text(domain_, m, path);
  };
  if (!first_difference(old_path, new_path)) {
    reply_.text = first_upper(changed) + " nothing changes in " + scene_.name_of(base) + elsewhere + ".";
    show(before, description(base, old_path));
    show(after, description(world, new_path));
    return;
  }
  auto contrast =
      scene_.any_best_way(after, [&](const Contrast& c) { return !first_difference(c.alternative, old_path); });
  if (!contrast) contrast = scene_.best_way(after, [](const Contrast&) { return true; });
  if (!contrast) contrast = scene_.any_best_way(after, [](const Contrast&) { return true; });
  reply_.text = first_upper(changed) + " its path has " + counts_text(domain_, atlas_.feature_counts(after)) +
                " instead of " + counts_text(domain_, atlas_.feature_counts(before)) + elsewhere + "; there " +
                because(contrast, "it has no other choice") + ".";
  show(before, description(base, old_path));
  show(after, description(world, new_path), contrast);
}

Answerer::Effects Answerer::worlds_it_matters_in(MdpIndex base, MdpIndex world) const {
  std::map<std::vector<bool>, MdpIndex> numbers;
  for (MdpIndex m{0}; m.value() < domain_.num_mdps(); ++m) numbers.emplace(domain_.present_things(m), m);
  const auto asked = toggled_groups(domain_, base, world);
  const auto there = domain_.present_things(world);
  Effects effects{0, 0, base, world};
  std::optional<std::size_t> nearest;
  for (const auto& [variant, m] : numbers) {
    auto other = variant;
    for (const auto g : asked) other[g] = there[g];
    const auto found = numbers.find(other);
    if (other == variant || found == numbers.end()) continue;
    const auto start = [&](MdpIndex of) { return atlas_.index({of, domain_.initial_state(of)}); };
    if (!scene_.was_seen(start(m)) || !scene_.was_seen(start(found->second))) continue;
    ++effects.tried;
    const auto path = [&](MdpIndex of) { return atlas_.trajectory(start(of)); };
    if (!first_difference(path(m), path(found->second))) continue;
    ++effects.matters;
    const auto distance = toggled_groups(domain_, base, m).size();
    if (nearest && *nearest <= distance) continue;
    nearest = distance;
    effects.base = m;
    effects.world = found->second;
  }
  return effects;
}

MdpIndex Answerer::world_to_change(bool removes) const {
  const auto n = domain_.num_mdps();
  const auto groups = domain_.optional_groups();
  std::set<std::vector<bool>> family;
  for (MdpIndex m{0}; m.value() < n; ++m) family.insert(domain_.present_things(m));
  for (std::size_t i = 0; i < n; ++i) {
    const MdpIndex base{removes ? n - 1 - i : i};
    auto variant = domain_.present_things(base);
    bool changes_all = true;
    for (const auto& condition : question_.conditions) {
      bool changes = false;
      for (std::size_t g = 0; g < groups.size(); ++g) {
        const auto& cells = groups[g].cells;
        if (groups[g].name != condition.thing || variant[g] == condition.present) continue;
        if (condition.cell && std::find(cells.begin(), cells.end(), *condition.cell) == cells.end()) continue;
        variant[g] = condition.present;
        changes = true;
      }
      changes_all = changes_all && changes;
    }
    if (changes_all && family.contains(variant)) return base;
  }
  return removes ? MdpIndex{n - 1} : MdpIndex{0};
}

MdpIndex Answerer::world_with(MdpIndex base) const {
  const auto groups = domain_.optional_groups();
  auto variant = domain_.present_things(base);
  for (const auto& condition : question_.conditions) {
    bool found = false, changes = false;
    for (std::size_t g = 0; g < groups.size(); ++g) {
      const auto& cells = groups[g].cells;
      if (groups[g].name != condition.thing) continue;
      if (condition.cell && std::find(cells.begin(), cells.end(), *condition.cell) == cells.end()) continue;
      found = true;
      changes = changes || variant[g] != condition.present;
      variant[g] = condition.present;
    }
    const auto where = condition.cell ? " at " + cell_text(*map_, *condition.cell) : std::string{};
    if (!found) fail(text_, condition.place, "E1108", "no world has " + condition.thing + where, Remedy::kShowMap);
    if (!changes) {
      fail(text_, condition.place, "E1108",
           scene_.name_of(base) + (condition.present ? " already has " : " has no ") + condition.thing + where,
           "name another world: 'in world N'");
    }
  }
  for (MdpIndex m{0}; m.value() < domain_.num_mdps(); ++m) {
    if (domain_.present_things(m) == variant) return m;
  }
  fail(text_, question_.conditions.front().place, "E1108", "no world is like that",
       "its worlds are a sample: ask 'in world N' about another one");
}

}  // namespace kith::detail
