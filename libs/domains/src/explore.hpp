#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "dynamics.hpp"
#include "kith/domains/family_map.hpp"
#include "state_layout.hpp"
#include "state_numbers.hpp"

namespace kith::detail {

// What can happen in one MDP, as found by breadth-first search from the start.
struct Exploration {
  struct Edge {
    std::uint32_t to = 0;     // index into states
    std::uint32_t row = 0;    // of the feature table
    std::uint8_t action = 0;  // index into Dynamics::actions
  };
  std::vector<PackedState> states;        // in the order found; the start first
  std::vector<bool> terminal;             // per state
  std::vector<std::uint32_t> first_edge;  // shape [states + 1]; terminal states have no edges
  std::vector<Edge> edges;                // those of a state in action order
  bool complete = true;                   // false: there are more than max_states
};

// Finds the states of the MDPs of a family, one after the other.
class Explorer {
 public:
  Explorer(const FamilyMap& family_map, const Dynamics& dynamics, FeatureTable& features);

  [[nodiscard]] const StateLayout& layout() const { return layout_; }

  [[nodiscard]] Exploration explore(std::size_t mdp, std::size_t max_states);

 private:
  // What a cell of the MDP at hand does to a transition that leaves or enters it.
  struct CellEffect {
    AtomMask leave = 0;
    AtomMask enter = 0;
    bool wall = false;
    bool goal = false;
    bool has_station = false;
    std::int32_t station = -1;      // index into FamilyMap::stations, if it is there
    std::int32_t destination = -1;  // index into FamilyMap::items: the one that belongs here
    std::uint32_t counts = 0;       // of rasters that features count, see FeatureTable
  };
  struct Step {
    PackedState next = 0;
    AtomMask atoms = 0;
    bool possible = false;
  };

  void set_up(std::size_t mdp);
  void put(std::size_t cell, std::size_t symbol);
  void set_up_rasters(std::size_t mdp);
  [[nodiscard]] CellEffect effect_of(const SymbolContent& content) const;
  [[nodiscard]] AtomMask atoms_of(Atom::Kind kind, const std::vector<std::string>& names,
                                  const std::string& name) const;
  [[nodiscard]] AtomMask mask_of(Atom atom) const;
  [[nodiscard]] PackedState start_state(std::size_t mdp) const;
  [[nodiscard]] bool is_terminal(PackedState s) const;
  [[nodiscard]] bool is_delivered(PackedState s, std::size_t item) const;
  [[nodiscard]] Step step(PackedState s, Action action) const;
  [[nodiscard]] Step move(PackedState s, Action action) const;
  [[nodiscard]] Step pick_up(PackedState s) const;
  [[nodiscard]] Step drop_off(PackedState s) const;
  std::uint32_t number_of(PackedState s, Exploration& found);

  const FamilyMap& family_map_;
  const Dynamics& dynamics_;
  FeatureTable& features_;
  StateLayout layout_;
  std::vector<CellEffect> symbol_effects_;     // per symbol, without stations
  std::vector<AtomMask> action_atoms_;         // per Action: action, action:NAME
  std::vector<AtomMask> carrying_atoms_;       // per carried value: 0 none, i + 1
  std::vector<AtomMask> deliver_atoms_;        // per item
  std::vector<AtomMask> station_leave_atoms_;  // per station
  std::vector<AtomMask> station_enter_atoms_;
  std::vector<std::pair<AtomMask, AtomMask>> raster_atoms_;  // per raster: leave, enter
  std::vector<std::size_t> counted_rasters_;                 // per feature that counts one

  // Of the MDP at hand.
  std::vector<CellEffect> cells_;
  std::vector<bool> item_present_;
  std::vector<bool> item_counts_;  // it is there and has a destination
  std::vector<bool> station_present_;
  bool has_deliveries_ = false;

  StateNumbers numbers_;  // of the states found so far
};

}  // namespace kith::detail
