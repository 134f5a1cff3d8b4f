#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "kith/domains/domain.hpp"
#include "kith/domains/domain_file.hpp"
#include "kith/domains/raw_model.hpp"
#include "model_drawing.hpp"

namespace kith {

// One MDP of an explicit model with the meaning of its states.
struct ExplicitMember {
  std::string name;
  Mdp mdp;
  std::vector<StateIndex> starts;  // of demonstrations and tests, ascending
  StateIndex initial;
  std::vector<std::string> names;   // shape [num_states + num_terminals]
  std::vector<std::uint32_t> keys;  // of the same shape: states of different MDPs that are called the same are equal
  std::vector<std::int32_t> variables;  // row-major, shape [num_states + num_terminals, variables]
};

// MDPs that were given state by state.
struct ExplicitFamily {
  std::vector<std::string> variables;  // integer variables that states have
  std::vector<std::string> keys;       // of all states, also of those that are left out
  std::vector<ExplicitMember> members;
  std::optional<ModelDrawing> drawing;
};

namespace detail {

// Checks what the files say, leaves out what can never matter, and makes the MDPs. The result is complete only without
// errors.
[[nodiscard]] ExplicitFamily build_explicit_family(RawModel&& model, std::size_t num_features, double discount,
                                                   const DomainLimits& limits, ModelReport& report);

}  // namespace detail
}  // namespace kith
