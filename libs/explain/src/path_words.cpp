// What a robot does on a path, and how likely that is.
#include <algorithm>
#include <cmath>
#include <optional>

#include "kith/explain/words.hpp"

namespace kith {

std::optional<double> chance_of_path(const Domain& domain, MdpIndex world, const Trajectory& path) {
  const auto& mdp = domain.mdp(world);
  double chance = 1.0;
  for (std::size_t t = 0; t < path.actions.size(); ++t) {
    const auto choices = mdp.choices(path.states[t]);
    const auto choice = std::ranges::find(choices, path.actions[t], &Choice::action);
    if (choice == choices.end()) return std::nullopt;
    double step = 0.0;
    for (const auto& outcome : mdp.outcomes(*choice)) {
      if (outcome.next == path.states[t + 1]) step += outcome.probability;
    }
    chance *= step;
  }
  constexpr double kCertain = 1.0 - 1e-9;
  if (chance > kCertain) return std::nullopt;
  return chance;
}

std::string chance_in_words(const Domain& domain, MdpIndex world, const Trajectory& path) {
  constexpr double kSmall = 0.01;
  const auto chance = chance_of_path(domain, world, path);
  if (!chance) return "";
  if (path.repeats_from) return "most likely path";  // nobody goes round for ever by chance
  return "most likely path, " +
         (*chance < kSmall ? "less than 1" : std::to_string(static_cast<int>(std::nearbyint(100.0 * *chance)))) +
         " % chance";
}

std::string world_text(const Domain& domain, MdpIndex m) {
  const auto name = domain.world_name(m);
  return "world " + std::to_string(m.value()) + (name.empty() ? "" : " (" + name + ")");
}

std::string actions_text(const Domain& domain, const std::vector<ActionIndex>& actions) {
  std::vector<std::string> runs;
  for (std::size_t i = 0, n = 1; i < actions.size(); i += n, n = 1) {
    while (i + n < actions.size() && actions[i + n] == actions[i]) ++n;
    runs.push_back(domain.action_names()[actions[i].value()] + (n > 1 ? " x" + std::to_string(n) : ""));
  }
  return joined(runs);
}

std::string actions_text(const Domain& domain, MdpIndex world, const Trajectory& path) {
  if (!path.repeats_from) return actions_text(domain, path.actions);
  const auto first = path.actions.begin() + static_cast<std::ptrdiff_t>(*path.repeats_from);  // of the cycle
  const auto way_in = actions_text(domain, {path.actions.begin(), first});
  return way_in + (way_in.empty() ? "" : ", ") + actions_text(domain, {first, path.actions.end()}) +
         ", and so on: " + never_in_words(domain, world, path);
}

namespace {

// What ends an episode, as something that the robot does: "delivers the parcel".
std::string end_in_words(const Domain& domain, MdpIndex world) {
  const auto map = domain.map();
  const auto& actions = domain.action_names();
  if (!map) return "arrives";
  std::vector<std::string> delivered, goals;
  const auto items = map->items_in(world);
  for (const auto& entry : map->legend()) {
    const auto& item = entry.content.destination_of;
    const auto is_there = [&](std::size_t i) { return map->item_names()[i] == item; };
    if (!item.empty() && std::ranges::any_of(items, is_there) && std::ranges::find(delivered, item) == delivered.end())
      delivered.push_back(item);
    if (entry.content.goal) goals.push_back(entry.goal_name.empty() ? "goal" : entry.goal_name + " goal");
  }
  std::vector<std::string> ends;
  if (delivered.size() == 1) ends.push_back("delivers the " + delivered.front());
  if (delivered.size() > 1) ends.emplace_back("delivers everything");
  if (!goals.empty()) ends.push_back("reaches " + (goals.size() == 1 ? "the " + goals.front() : std::string{"a goal"}));
  if (std::ranges::find(actions, "exit") != actions.end()) ends.emplace_back("leaves");
  return ends.size() == 1 ? ends.front() : "arrives";
}

}  // namespace

std::string job_in_words(const Domain& domain) {
  if (!domain.goal().empty()) return domain.goal();
  const auto map = domain.drawing();
  if (!map) return "";
  std::vector<std::string> items, goals;
  for (const auto& entry : map->legend()) {
    const auto& item = entry.content.destination_of;
    if (!item.empty() && std::ranges::find(items, item) == items.end()) items.push_back(item);
    if (entry.content.goal) goals.push_back(entry.goal_name.empty() ? "goal" : entry.goal_name + " goal");
  }
  const auto& actions = domain.action_names();
  const bool leaves = std::ranges::find(actions, "exit") != actions.end();
  if (items.size() == 1 && goals.empty()) {
    return "The robot fetches the " + items.front() + " and takes it to where it belongs.";
  }
  if (items.size() > 1 && goals.empty()) return "The robot takes everything to where it belongs.";
  if (goals.size() == 1 && items.empty()) {
    return "The robot is on its way to the " + goals.front() + (leaves ? ", unless it leaves first." : ".");
  }
  if (goals.size() > 1 && items.empty()) return "The robot is on its way to one of the goals.";
  return "";
}

std::string never_in_words(const Domain& domain, MdpIndex world, const Trajectory& path) {
  if (!path.repeats_from) return "";
  const auto drawing = domain.drawing();
  const auto moves = [&](std::size_t t) {
    return !drawing || drawing->state(world, path.states[t]).robot != drawing->state(world, path.states.back()).robot;
  };
  bool goes_anywhere = false;
  for (std::size_t t = *path.repeats_from; t < path.actions.size(); ++t) goes_anywhere = goes_anywhere || moves(t);
  return (goes_anywhere ? "it never " : "it stays where it is and never ") + end_in_words(domain, world);
}

std::string cell_text(const GridMap& map, const Cell& cell) {
  return "(" + std::to_string(cell.x) + "," + std::to_string(map.height() + 1 - cell.y) + ")";
}

std::string action_words(const std::string& action) {
  for (const char* move : {"up", "down", "left", "right"}) {
    if (action == move) return "goes " + action;
  }
  if (action == "pickup") return "picks it up";
  if (action == "dropoff") return "puts it down";
  if (action == "exit") return "leaves";
  if (action == "stay") return "stays where it is";
  return "does '" + action + "'";
}

std::string action_infinitive(const std::string& action) {
  for (const char* move : {"up", "down", "left", "right"}) {
    if (action == move) return "go " + action;
  }
  if (action == "pickup") return "pick it up";
  if (action == "dropoff") return "put it down";
  if (action == "exit") return "leave";
  if (action == "stay") return "stay where it is";
  return "do '" + action + "'";
}

}  // namespace kith
