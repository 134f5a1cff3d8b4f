#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "explicit_family.hpp"
#include "kith/domains/domain.hpp"
#include "kith/domains/family_map.hpp"
#include "state_layout.hpp"

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

// Gridworlds on one map.
struct GridFamily {
  detail::FamilyMap family_map;
  detail::StateLayout layout;
  std::vector<std::string> item_names;
  std::vector<DomainMember> members;  // per MDP

  // Looks of the states, one row per (MDP, non-terminal state) in order; see complexity() and dissimilarity().
  std::vector<std::size_t> first_state;  // per MDP, row of its state 0; one more at the end
  std::size_t digits_per_state = 0;
  std::vector<std::int32_t> digits;  // shape [rows, digits_per_state], padded with zeros
  std::vector<std::uint16_t> num_digits;
  std::vector<std::uint16_t> num_stations;  // still there
  std::uint64_t non_station_groups = 0;     // as a mask of worlds

  // Fills in the looks from the members.
  void describe_states();

 private:
  void describe_state(const DomainMember& member, detail::PackedState s);
};

struct Domain::Data {
  std::string id;
  std::string title;
  std::string goal{};
  std::vector<std::string> feature_names;
  std::vector<std::string> action_names;
  std::vector<Wording> wordings;
  std::vector<std::vector<FeatureThing>> feature_things{};  // per feature
  RewardWeights weights;
  std::optional<InferredWeights> inferred{};
  std::vector<HalfSpace> prior;
  std::size_t max_steps = 0;
  std::variant<GridFamily, ExplicitFamily> family;
  std::size_t num_starts = 0;  // of all MDPs
  bool exact = true;           // see Domain::is_exact()
  std::int64_t count_scale = 1;

  [[nodiscard]] bool has_map() const noexcept { return std::holds_alternative<GridFamily>(family); }
  [[nodiscard]] const GridFamily& grid() const { return std::get<GridFamily>(family); }
  [[nodiscard]] const ExplicitFamily& model() const { return std::get<ExplicitFamily>(family); }

  // Fills in the sums over the members.
  void sum_up();
};

}  // namespace kith
