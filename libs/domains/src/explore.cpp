#include "explore.hpp"

#include <algorithm>

namespace kith::detail {
Explorer::Explorer(const FamilyMap& family_map, const Dynamics& dynamics, FeatureTable& features)
    : family_map_{family_map}, dynamics_{dynamics}, features_{features}, layout_{family_map} {
  for (std::size_t a = 0; a < all_action_names().size(); ++a) {
    action_atoms_.push_back(mask_of({Atom::Kind::kAnyAction, 0}) | mask_of({Atom::Kind::kAction, a}));
  }
  for (const Symbol& symbol : family_map.symbols) symbol_effects_.push_back(effect_of(symbol.content));
  carrying_atoms_.push_back(0);
  for (std::size_t i = 0; i < family_map.items.size(); ++i) {
    carrying_atoms_.push_back(mask_of({Atom::Kind::kCarrying, i}));
    deliver_atoms_.push_back(mask_of({Atom::Kind::kDeliver, i}));
  }
  for (const Station& station : family_map.stations) {
    station_leave_atoms_.push_back(atoms_of(Atom::Kind::kLeaveStation, family_map.station_names, station.name));
    station_enter_atoms_.push_back(atoms_of(Atom::Kind::kEnterStation, family_map.station_names, station.name));
  }
  for (const Raster& raster : family_map.rasters) {
    raster_atoms_.push_back({atoms_of(Atom::Kind::kLeaveTerrain, family_map.terrain_names, raster.name),
                             atoms_of(Atom::Kind::kEnterTerrain, family_map.terrain_names, raster.name)});
  }
  for (const Feature& feature : dynamics.features) {
    if (feature.times) counted_rasters_.push_back(*feature.times);
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
  cells_.assign(family_map_.num_cells(), {});
  station_present_.assign(family_map_.stations.size(), false);
  for (std::size_t cell = 0; cell < family_map_.num_cells(); ++cell) {
    if (family_map_.is_there(family_map_.group_of[cell], mdp)) put(cell, family_map_.symbol_of[cell]);
  }
  for (const MapThing& thing : family_map_.painted) {
    if (family_map_.is_there(thing.group, mdp)) put(thing.cell, thing.symbol);
  }
  item_present_.clear();
  item_counts_.clear();
  has_deliveries_ = false;
  for (const Item& item : family_map_.items) {
    item_present_.push_back(family_map_.find(item.homes, mdp).has_value());
    item_counts_.push_back(item_present_.back() && family_map_.find(item.destinations, mdp));
    has_deliveries_ = has_deliveries_ || item_counts_.back();
  }
  set_up_rasters(mdp);
}

// Adds what the symbol puts on the cell.
void Explorer::put(std::size_t cell, std::size_t symbol) {
  const CellEffect& effect = symbol_effects_[symbol];
  CellEffect& sum = cells_[cell];
  sum.leave |= effect.leave;
  sum.enter |= effect.enter;
  sum.wall = sum.wall || effect.wall;
  sum.goal = sum.goal || effect.goal;
  if (effect.destination >= 0) sum.destination = effect.destination;
  if (!effect.has_station) return;
  const auto at = std::lower_bound(family_map_.stations.begin(), family_map_.stations.end(), cell,
                                   [](const Station& station, std::size_t c) { return station.cell < c; });
  sum.station = static_cast<std::int32_t>(at - family_map_.stations.begin());
  station_present_[static_cast<std::size_t>(sum.station)] = true;
}

void Explorer::set_up_rasters(std::size_t mdp) {
  for (std::size_t r = 0; r < family_map_.rasters.size(); ++r) {
    for (std::size_t cell = 0; cell < cells_.size(); ++cell) {
      if (family_map_.raster_value(r, cell, mdp) == 0) continue;
      cells_[cell].leave |= raster_atoms_[r].first;
      cells_[cell].enter |= raster_atoms_[r].second;
    }
  }
  if (counted_rasters_.empty()) return;
  std::vector<std::uint16_t> values(counted_rasters_.size());
  for (std::size_t cell = 0; cell < cells_.size(); ++cell) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      values[i] = family_map_.raster_value(counted_rasters_[i], cell, mdp);
    }
    cells_[cell].counts = features_.counts_of(values);
  }
}

Explorer::CellEffect Explorer::effect_of(const SymbolContent& content) const {
  CellEffect effect;
  effect.wall = content.wall;
  effect.goal = content.goal;
  effect.has_station = !content.station.empty();
  for (std::size_t i = 0; i < family_map_.items.size(); ++i) {
    if (family_map_.items[i].name == content.destination) effect.destination = static_cast<std::int32_t>(i);
  }
  effect.leave = atoms_of(Atom::Kind::kLeaveTerrain, family_map_.terrain_names, content.terrain);
  effect.enter = atoms_of(Atom::Kind::kEnterTerrain, family_map_.terrain_names, content.terrain) |
                 atoms_of(Atom::Kind::kGoal, family_map_.goal_names, content.goal_name);
  if (content.goal) effect.enter |= mask_of({Atom::Kind::kAnyGoal, 0});
  return effect;
}

PackedState Explorer::start_state(std::size_t mdp) const {
  PackedState s = layout_.with_robot(0, family_map_.start_in(mdp));
  for (std::size_t i = 0; i < family_map_.items.size(); ++i) {
    if (!item_present_[i]) continue;
    s = layout_.with_item(s, i, *family_map_.find(family_map_.items[i].homes, mdp));
    if (family_map_.items[i].carried) s = layout_.with_carried(s, i + 1);
  }
  std::uint64_t stations = 0;
  for (std::size_t i = 0; i < family_map_.stations.size(); ++i) {
    if (station_present_[i]) stations |= std::uint64_t{1} << i;
  }
  return layout_.with_stations(s, stations);
}

bool Explorer::is_delivered(PackedState s, std::size_t item) const {
  return layout_.carried(s) != item + 1 && cells_[layout_.item(s, item)].destination == static_cast<std::int32_t>(item);
}

bool Explorer::is_terminal(PackedState s) const {
  if (layout_.exited(s) || cells_[layout_.robot(s)].goal) return true;
  if (!has_deliveries_) return false;
  for (std::size_t i = 0; i < family_map_.items.size(); ++i) {
    if (item_counts_[i] && !is_delivered(s, i)) return false;
  }
  return true;
}

Explorer::Step Explorer::move(PackedState s, Action action) const {
  const std::size_t from = layout_.robot(s);
  const auto width = static_cast<std::size_t>(family_map_.width);
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
  for (std::size_t i = 0; i < family_map_.items.size(); ++i) {
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
      const std::uint32_t row = features_.row_of(step.atoms, cells_[layout_.robot(step.next)].counts);
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
