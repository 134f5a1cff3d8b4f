#include "explore.hpp"

#include <algorithm>
#include <array>

namespace kith::detail {
Explorer::Explorer(const World& world, const Dynamics& dynamics, FeatureTable& features)
    : world_{world}, dynamics_{dynamics}, features_{features}, layout_{world} {
  for (std::size_t a = 0; a < all_action_names().size(); ++a) {
    action_atoms_.push_back(mask_of({Atom::Kind::kAnyAction, 0}) | mask_of({Atom::Kind::kAction, a}));
  }
  for (const Symbol& symbol : world.symbols) symbol_effects_.push_back(effect_of(symbol.content));
  carrying_atoms_.push_back(0);
  for (std::size_t i = 0; i < world.items.size(); ++i) {
    carrying_atoms_.push_back(mask_of({Atom::Kind::kCarrying, i}));
    deliver_atoms_.push_back(mask_of({Atom::Kind::kDeliver, i}));
  }
  for (const Station& station : world.stations) {
    station_leave_atoms_.push_back(atoms_of(Atom::Kind::kLeaveStation, world.station_names, station.name));
    station_enter_atoms_.push_back(atoms_of(Atom::Kind::kEnterStation, world.station_names, station.name));
  }
  numbers_ = StateNumbers{layout_.num_bits()};
}

AtomMask Explorer::mask_of(Atom atom) const {
  const auto it = std::find(dynamics_.atoms.begin(), dynamics_.atoms.end(), atom);
  return it == dynamics_.atoms.end() ? 0 : AtomMask{1} << (it - dynamics_.atoms.begin());
}

AtomMask Explorer::atoms_of(Atom::Kind kind, const std::vector<std::string>& names, const std::string& name) const {
  const auto it = std::find(names.begin(), names.end(), name);
  return it == names.end() ? 0 : mask_of({kind, static_cast<std::size_t>(it - names.begin())});
}

void Explorer::set_up(std::size_t mdp) {
  cells_.assign(world_.num_cells(), {});
  for (std::size_t cell = 0; cell < world_.num_cells(); ++cell) {
    if (world_.is_present(cell, mdp)) cells_[cell] = symbol_effects_[world_.symbol_of[cell]];
  }
  for (std::size_t i = 0; i < world_.stations.size(); ++i) {
    const Station& station = world_.stations[i];
    if (world_.is_present(station.cell, mdp)) cells_[station.cell].station = static_cast<std::int32_t>(i);
  }
  item_present_.clear();
  has_deliveries_ = false;
  for (const Item& item : world_.items) {
    item_present_.push_back(item.home && world_.is_present(*item.home, mdp));
    has_deliveries_ = has_deliveries_ || (item_present_.back() && item.has_destination);
  }
}

Explorer::CellEffect Explorer::effect_of(const SymbolContent& content) const {
  CellEffect effect;
  effect.wall = content.wall;
  effect.goal = content.goal;
  effect.leave = atoms_of(Atom::Kind::kLeaveTerrain, world_.terrain_names, content.terrain);
  effect.enter = atoms_of(Atom::Kind::kEnterTerrain, world_.terrain_names, content.terrain) |
                 atoms_of(Atom::Kind::kGoal, world_.goal_names, content.goal_name);
  if (content.goal) effect.enter |= mask_of({Atom::Kind::kAnyGoal, 0});
  return effect;
}

PackedState Explorer::start_state(std::size_t mdp) const {
  PackedState s = layout_.with_robot(0, world_.start);
  for (std::size_t i = 0; i < world_.items.size(); ++i) {
    if (item_present_[i]) s = layout_.with_item(s, i, *world_.items[i].home);
  }
  std::uint64_t stations = 0;
  for (std::size_t i = 0; i < world_.stations.size(); ++i) {
    if (world_.is_present(world_.stations[i].cell, mdp)) stations |= std::uint64_t{1} << i;
  }
  return layout_.with_stations(s, stations);
}

bool Explorer::is_delivered(PackedState s, std::size_t item) const {
  return layout_.carried(s) != item + 1 && world_.content(layout_.item(s, item)).destination == world_.items[item].name;
}

bool Explorer::is_terminal(PackedState s) const {
  if (layout_.exited(s) || cells_[layout_.robot(s)].goal) return true;
  if (!has_deliveries_) return false;
  for (std::size_t i = 0; i < world_.items.size(); ++i) {
    if (item_present_[i] && world_.items[i].has_destination && !is_delivered(s, i)) return false;
  }
  return true;
}

Explorer::Step Explorer::move(PackedState s, Action action) const {
  const std::size_t from = layout_.robot(s);
  const auto width = static_cast<std::size_t>(world_.width);
  std::size_t to = from;
  if (action == Action::kUp && from >= width) to = from - width;
  if (action == Action::kDown && from + width < cells_.size()) to = from + width;
  if (action == Action::kLeft && from % width > 0) to = from - 1;
  if (action == Action::kRight && from % width + 1 < width) to = from + 1;
  if (to == from || cells_[to].wall) return {};

  Step step{layout_.with_robot(s, to), cells_[from].leave | cells_[to].enter, true};
  if (const std::size_t carried = layout_.carried(s)) step.next = layout_.with_item(step.next, carried - 1, to);
  if (const auto i = cells_[from].station; i >= 0 && layout_.has_station(s, static_cast<std::size_t>(i))) {
    const auto station = static_cast<std::size_t>(i);
    step.next = layout_.with_stations(step.next, layout_.stations(s) & ~(std::uint64_t{1} << station));
    step.atoms |= station_leave_atoms_[station];
  }
  if (const auto i = cells_[to].station; i >= 0 && layout_.has_station(s, static_cast<std::size_t>(i))) {
    step.atoms |= station_enter_atoms_[static_cast<std::size_t>(i)];
  }
  return step;
}

// Where several items lie on one cell, the first one declared is picked up.
Explorer::Step Explorer::pick_up(PackedState s) const {
  if (layout_.carried(s) != 0) return {};
  for (std::size_t i = 0; i < world_.items.size(); ++i) {
    if (item_present_[i] && layout_.item(s, i) == layout_.robot(s)) return {layout_.with_carried(s, i + 1), 0, true};
  }
  return {};
}

Explorer::Step Explorer::drop_off(PackedState s) const {
  const std::size_t carried = layout_.carried(s);
  if (carried == 0) return {};
  Step step{layout_.with_carried(s, 0), 0, true};
  if (is_delivered(step.next, carried - 1)) step.atoms |= deliver_atoms_[carried - 1];
  return step;
}

Explorer::Step Explorer::step(PackedState s, Action action) const {
  Step step;
  switch (action) {
    case Action::kPickup:
      step = pick_up(s);
      break;
    case Action::kDropoff:
      step = drop_off(s);
      break;
    case Action::kExit:
      step = {layout_.with_exit(s), 0, true};
      break;
    default:
      step = move(s, action);
  }
  step.atoms |= action_atoms_[static_cast<std::size_t>(action)] | carrying_atoms_[layout_.carried(s)];
  return step;
}

std::uint32_t Explorer::number_of(PackedState s, Exploration& found) {
  std::uint32_t& slot = numbers_.slot(s, found.states);
  if (slot != StateNumbers::kNone) return slot;
  const auto number = static_cast<std::uint32_t>(found.states.size());
  slot = number;
  found.states.push_back(s);
  found.terminal.push_back(is_terminal(s));
  return number;
}

Exploration Explorer::explore(std::size_t mdp, std::size_t max_states) {
  set_up(mdp);
  Exploration found;
  static_cast<void>(number_of(start_state(mdp), found));
  for (std::size_t i = 0; i < found.states.size() && found.complete; ++i) {
    found.first_edge.push_back(static_cast<std::uint32_t>(found.edges.size()));
    if (found.terminal[i]) continue;
    for (std::size_t a = 0; a < dynamics_.actions.size(); ++a) {
      const Step step = this->step(found.states[i], dynamics_.actions[a]);
      if (!step.possible) continue;
      const std::uint32_t row = features_.row_of(step.atoms);
      if (features_.row(row).forbidden) continue;
      found.edges.push_back({number_of(step.next, found), row, static_cast<std::uint8_t>(a)});
    }
    found.complete = found.states.size() <= max_states;
  }
  found.first_edge.push_back(static_cast<std::uint32_t>(found.edges.size()));
  numbers_.clear(found.states);
  return found;
}

}  // namespace kith::detail
