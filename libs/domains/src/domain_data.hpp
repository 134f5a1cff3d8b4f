#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kith/domains/domain.hpp"
#include "state_layout.hpp"
#include "world.hpp"

namespace kith {

// One MDP of the family with the meaning of its states.
struct DomainMember {
  Mdp mdp;
  std::vector<detail::PackedState> states;  // shape [num_states + num_terminals]
  std::vector<std::uint32_t> by_state;      // indices into states, sorted by packed state
  std::vector<StateIndex> starts;           // of demonstrations and tests, ascending
  std::vector<bool> item_present;           // per item
  int num_toggled = 0;                      // optional cells that are there, stations apart
};

struct Domain::Data {
  std::string id;
  std::string title;
  std::vector<std::string> feature_names;
  std::vector<std::string> action_names;
  std::vector<std::string> feature_words;
  RewardWeights weights;
  std::vector<HalfSpace> prior;
  std::size_t max_steps = 0;

  detail::World world;
  detail::StateLayout layout;
  std::vector<std::string> item_names;
  std::vector<DomainMember> members;  // per MDP
  std::size_t num_starts = 0;         // of all members
  bool exact = true;                  // see Domain::is_exact()

  // Looks of the start states, one row per (MDP, start) in order; see complexity() and dissimilarity().
  std::vector<std::size_t> first_start;  // per MDP, row of its state 0; one more at the end
  std::size_t digits_per_start = 0;
  std::vector<std::int32_t> digits;  // shape [num_starts, digits_per_start], padded with zeros
  std::vector<std::uint16_t> num_digits;
  std::vector<std::uint16_t> num_stations;  // still there
  std::uint64_t non_station_groups = 0;     // as a mask of variants

  // Fills in what follows from the members: sums over them, and the looks of their states.
  void describe_members();

 private:
  void describe_start(const DomainMember& member, detail::PackedState s);
};

}  // namespace kith
